#pragma once

#include "treacle/core/vec.hpp"
#include "treacle/model/case/case.hpp"

#include <cstddef>
#include <nanoflann.hpp>
#include <vector>

namespace treacle {

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
using PointTree =
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, PointSet>, PointSet, 3, std::size_t>;

/// From a place to itself, and to its images one period away along each periodic axis.
inline std::vector<Vec<3>> imageShifts(const Domain& domain) {
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

}  // namespace treacle
