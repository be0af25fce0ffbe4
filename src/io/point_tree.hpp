#pragma once

#include "box.hpp"
#include "treacle/core/vec.hpp"
#include "treacle/model/case.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace treacle {

/// Points with the question "which is nearest?", answered in O(log N) wherever they lie and wherever is asked: a
/// k-d tree, in which a middle point parts the others, along one axis after the other. No grid of cells,
/// since the sets that are compared may be far from each other, where a search would pass through all empty cells.
class PointTree {
 public:
  struct Nearest {
    std::size_t index = 0;  // into the points given
    double distance2 = 0;   // [m2] to the nearest periodic image
  };

  /// `points` [m]: finite, not empty, fewer than 2^32. Of the domain only what is periodic counts.
  PointTree(const std::vector<Vec<3>>& points, int dimensions, const Domain& domain);

  Nearest nearest(const Vec<3>& x) const;

 private:
  struct Point {
    Vec<3> x;
    std::uint32_t index;
  };
  struct Range {
    std::size_t begin, end;  // among points_
    int axis;                // along which it is split
  };

  Vec<3> wrapped(Vec<3> x) const;
  void build(const Range& range);
  void searchImages(const Vec<3>& x, int axis, Nearest& best) const;
  void search(const Range& range, const Vec<3>& x, const Vec<3>& toRange, Nearest& best) const;

  int dimensions_;
  Domain domain_;
  std::vector<Point> points_;  // in the order of the tree
  Box bounds_;
};

}  // namespace treacle
