#pragma once

#include "treacle/model/case.hpp"

#include <string>
#include <vector>

namespace treacle {

constexpr std::size_t maxParticles = std::size_t{1} << 27;

/// The lattice points of one body, x fastest. A box gets a whole number of points per axis, at least one,
/// starting half a spacing inside its corner `min`; a note says where its extent is not that number of spacings.
/// Errors: InputError for more than maxParticles points.
template <int D>
std::vector<Vec<D>> latticePoints(const Body& body, double spacing, std::vector<std::string>& notes);

}  // namespace treacle
