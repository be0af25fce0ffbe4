#include "nearest_points.hpp"

#include "box.hpp"
#include "treacle/core/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <nanoflann.hpp>

namespace treacle {
namespace {

/// The members that nanoflann asks a set of points for.
struct PointSet {
  std::vector<Vec<3>> points;

  std::size_t kdtree_get_point_count() const { return points.size(); }
  double kdtree_get_pt(std::size_t k, std::size_t axis) const { return points[k][static_cast<int>(axis)]; }
  template <class Bounds>
  bool kdtree_get_bbox(Bounds&) const {
    return false;  // nanoflann is to find it
  }
};

/// No grid of cells, since the sets that are compared may be far from each other, where a search would pass
/// through all empty cells.
using Tree =
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, PointSet>, PointSet, 3, std::size_t>;

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

/// From a place to itself, and to its images one period away along each periodic axis.
std::vector<Vec<3>> imageShifts(const Domain& domain) {
  std::vector<Vec<3>> shifts{{}};
  for (int k = 0; k < 3; ++k) {
    if (!domain.periodic[k]) continue;
    Vec<3> period{};
    period[k] = domain.max[k] - domain.min[k];
    for (std::size_t n = shifts.size(), s = 0; s < n; ++s)
      shifts.insert(shifts.end(), {shifts[s] + period, shifts[s] - period});
  }
  return shifts;
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
  const Tree tree(3, set);
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
