#pragma once

#include "treacle/core/vec.hpp"
#include "treacle/model/case/case.hpp"

#include <cstddef>
#include <vector>

namespace treacle {

struct NearestPoint {
  std::size_t index = 0;  // into the points given
  double distance2 = 0;   // [m2] to the nearest periodic image
};

/// For each place in `asked` the nearest of `points`, in O(log N) wherever they lie. All [m], finite; in two
/// dimensions their third components are zero. `points`: not empty. Of the domain only what is periodic counts.
std::vector<NearestPoint> nearestPoints(const std::vector<Vec<3>>& asked, const std::vector<Vec<3>>& points,
                                        const Domain& domain);

}  // namespace treacle
