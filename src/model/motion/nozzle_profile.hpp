#pragma once

#include "treacle/core/vec.hpp"
#include "treacle/model/case/body.hpp"

#include <array>
#include <span>
#include <vector>

namespace treacle {

/// Speed of each column of a nozzle over the mean of all, so that their mean is 1; one number where all columns
/// have the same. `across`: places of the columns in the opening, from its centre, at the start [m]. `axes`:
/// axesAcross(). Errors: InputError for an expression that is negative or not finite somewhere, or zero
/// everywhere.
template <int D>
std::vector<double> nozzleProfile(const Body& body, std::span<const Vec<D>> across,
                                  const std::array<Vec<D>, D - 1>& axes);

}  // namespace treacle
