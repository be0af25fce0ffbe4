#pragma once

#include "body_region.hpp"
#include "face.hpp"
#include "treacle/model/case/case.hpp"

#include <vector>

namespace treacle {

/// A wall body, or its image one period away: what the surface of walls is made of. The body must stay where it
/// is.
template <int D>
class WallPart {
 public:
  /// `condition`: the body's, or null. `solid`: of a polygon or mesh, else null. `spacing` [m].
  WallPart(const Body& body, const Vec<D>& shift, const BodyCondition<D>* condition, const Solid<D>* solid,
           double spacing);

  /// The surface belongs to the part, but for what the condition says of it.
  /// A condition is asked before a polygon or mesh, which takes far longer.
  bool contains(const Vec<D>& x) const {
    return solid_ ? conditionHolds(x) && shapeContains(x) : shapeContains(x) && conditionHolds(x);
  }
  /// Whether a point is where the shape is, but its condition does not hold.
  bool cutAt(const Vec<D>& x) const {
    if (!condition_) return false;
    return solid_ ? !conditionHolds(x) && shapeContains(x) : shapeContains(x) && !conditionHolds(x);
  }
  bool cut() const { return condition_ != nullptr; }
  /// Whether it may be cut somewhere in a box.
  bool cutIn(const Vec<D>& min, const Vec<D>& max) const {
    return condition_ && condition_->mayFail(min - shift_, max - shift_);
  }
  /// Whether its condition does not hold at a point, be it of the shape or not.
  bool excludes(const Vec<D>& x) const { return !conditionHolds(x); }
  /// Whether all points between two of its points belong to it, too.
  bool convex() const { return convex_ && !condition_; }
  bool touches(const Vec<D>& min, const Vec<D>& max) const {
    for (int k = 0; k < D; ++k)
      if (max[k] < min_[k] || min[k] > max_[k]) return false;
    return true;
  }

  const std::vector<Face<D>>& faces() const { return faces_; }
  const Solid<D>* solid() const { return solid_; }
  const Vec<D>& shift() const { return shift_; }
  const Vec<D>& min() const { return min_; }
  const Vec<D>& max() const { return max_; }

 private:
  bool shapeContains(const Vec<D>& x) const;
  bool conditionHolds(const Vec<D>& x) const;

  Shape shape_;
  Similarity<D> similarity_;
  Vec<D> shift_;
  const BodyCondition<D>* condition_;
  const Solid<D>* solid_;
  double slack_;  // [m]
  bool convex_;
  Vec<D> min_, max_;
  std::vector<Face<D>> faces_;
};

extern template class WallPart<2>;
extern template class WallPart<3>;

/// Whether two walls never slide along each other: united they are one solid.
bool moveAlike(const Body& a, const Body& b);

}  // namespace treacle
