#pragma once

#include "body_points.hpp"

#include <functional>
#include <string>
#include <vector>

namespace treacle {

/// The points of particles that a file gives, in its order, after their transform. Those closer than half a
/// spacing to an earlier one are left out, and a note says how many. `keep`: called with each of the others; where
/// it is false the point is left out. Errors: what `keep` throws.
template <int D>
BodyPoints<D> givenPoints(const Case& c, const Body& body, std::vector<std::string>& notes,
                          const std::function<bool(const Vec<D>&)>& keep);

}  // namespace treacle
