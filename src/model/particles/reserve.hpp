#pragma once

#include "filled.hpp"
#include "overlap.hpp"

#include <string>
#include <vector>

namespace treacle {

/// Notes walls that stand in the reserves of openings. Errors: InputError where they take more than half of one.
template <int D>
void requireReserves(const Case& c, const Overlap<D>& overlap, std::vector<std::string>& notes);

/// Takes out fluid behind the reserves of openings, up to the first gap. Notes how much, as there is none but
/// where a direction is the wrong one, or a body is longer than its reserve.
template <int D>
void clearBehindReserves(const Case& c, std::vector<Filled<D>>& fluid, std::vector<std::string>& notes);

}  // namespace treacle
