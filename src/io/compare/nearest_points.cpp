#include "nearest_points.hpp"

#include "picture/box.hpp"
#include "point_tree.hpp"
#include "treacle/core/parallel.hpp"

#include <algorithm>
#include <cmath>

namespace treacle {
namespace {

/// Into the domain on periodic axes.
Vec<3> wrapped(Vec<3> x, const Domain& domain) {
  for (int k = 0; k < 3; ++k) {
    if (!domain.periodic[k]) continue;
    const double length = domain.max[k] - domain.min[k];
    x[k] -= length * std::floor((x[k] - domain.min[k]) / length);
  }
  return x;
}

std::vector<Vec<3>> wrapped(std::vector<Vec<3>> points, const Domain& domain) {
  for (Vec<3>& x : points) x = wrapped(x, domain);
  return points;
}

double distance2(const Vec<3>& x, const Box& box) {
  Vec<3> d{};
  for (int k = 0; k < 3; ++k) d[k] = x[k] - std::clamp(x[k], box.min[k], box.max[k]);
  return norm2(d);
}

}  // namespace

std::vector<NearestPoint> nearestPoints(const std::vector<Vec<3>>& asked, const std::vector<Vec<3>>& points,
                                        const Domain& domain) {
  const PointSet set{wrapped(points, domain)};
  const PointTree tree(3, set);
  const Box bounds = boundsOf(set.points, 0);
  const std::vector<Vec<3>> shifts = imageShifts(domain);
  std::vector<NearestPoint> nearest(asked.size());
  parallelFor(asked.size(), parallelGrain, [&](std::size_t k) {
    NearestPoint& best = nearest[k];
    nanoflann::KNNResultSet<double> result(1);
    result.init(&best.index, &best.distance2);
    const Vec<3> x = wrapped(asked[k], domain);
    for (const Vec<3>& shift : shifts)  // most images are farther away than what is found already
      if (distance2(x + shift, bounds) < best.distance2) tree.findNeighbors(result, (x + shift).v, {});
  });
  return nearest;
}

}  // namespace treacle
