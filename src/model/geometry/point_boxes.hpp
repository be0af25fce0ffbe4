#pragma once

#include "treacle/model/case/case.hpp"

#include <algorithm>
#include <span>
#include <vector>

namespace treacle {

/// Boxes around the points of bodies and around their periodic images. The points of one body stand on a lattice,
/// none nearer to another than the radius: a point has such neighbours at most where it is in a box of another
/// body or in one of an image, and these are few.
template <int D>
class PointBoxes {
 public:
  PointBoxes(const Domain& domain, double radius) : domain_(domain), margin_(1.01 * radius) {}

  void add(const Body* body, std::span<const Vec<D>> points) {
    if (points.empty()) return;
    Vec<D> min = points.front(), max = min;
    for (const Vec<D>& x : points)
      for (int k = 0; k < D; ++k) min[k] = std::min(min[k], x[k]), max[k] = std::max(max[k], x[k]);
    addImages({body, false, min - Vec<D>::filled(margin_), max + Vec<D>::filled(margin_)}, 0);
  }

  class Near;
  /// The boxes that matter to one body.
  Near near(const Body* body) const {
    Near near;
    for (const Box& own : boxes_)
      if (own.body == body && !own.image)
        for (const Box& other : boxes_)
          if ((other.body != body || other.image) && other.touches(own)) near.boxes_.push_back(other);
    return near;
  }

 private:
  struct Box {
    const Body* body;
    bool image;
    Vec<D> min, max;  // [m]

    bool contains(const Vec<D>& x) const { return touches({nullptr, false, x, x}); }
    bool touches(const Box& o) const {
      for (int k = 0; k < D; ++k)
        if (o.max[k] < min[k] || o.min[k] > max[k]) return false;
      return true;
    }
  };

  void addImages(const Box& box, int axis) {
    if (axis == D) return boxes_.push_back(box);
    addImages(box, axis + 1);
    if (!domain_.periodic[static_cast<std::size_t>(axis)]) return;
    const double length = domain_.max[axis] - domain_.min[axis];
    for (const double shift : {-length, length}) {
      Box image = box;
      image.image = true, image.min[axis] += shift, image.max[axis] += shift;
      addImages(image, axis + 1);
    }
  }

  Domain domain_;
  double margin_;  // [m]
  std::vector<Box> boxes_;
};

template <int D>
class PointBoxes<D>::Near {
 public:
  bool empty() const { return boxes_.empty(); }
  /// Whether one of them contains x [m].
  bool contain(const Vec<D>& x) const {
    return std::ranges::any_of(boxes_, [&](const Box& box) { return box.contains(x); });
  }

 private:
  friend PointBoxes;
  std::vector<Box> boxes_;
};

}  // namespace treacle
