#pragma once

#include "treacle/model/case.hpp"
#include "treacle/model/expression.hpp"
#include "treacle/model/shape.hpp"

#include <vector>

namespace treacle {

/// A smooth surface without end, of which a part bounds a shape.
template <int D>
struct Face {
  Vec<D> origin{};    // plane: a point of it; sphere: the centre; mantle of a cylinder: a point of the axis [m]
  Vec<D> normal{};    // plane: outward, away from the shape
  Vec<D> axis{};      // mantle: its direction
  double radius = 0;  // sphere, mantle [m]; 0: plane
  double side = 1;    // sphere, mantle: -1 where the shape is hollow inside it

  bool flat() const { return radius == 0; }

  struct At {
    double height;  // of the point above the face, negative inside [m]
    Vec<D> normal;  // outward, of the face at its point nearest to this one
  };
  At at(const Vec<D>& x) const;
};

/// A wall body, or its image one period away: what the surface of walls is made of. The body must stay where it
/// is.
template <int D>
class WallPart {
 public:
  /// `where`: the body's condition, or null. `spacing` [m].
  WallPart(const Body& body, const Vec<D>& shift, const Expression* where, double spacing);

  /// The surface belongs to the part, but for what `where` says of it.
  bool contains(const Vec<D>& x) const { return shapeContains(x) && whereHolds(x); }
  /// Whether a point is where the shape is, but its condition does not hold.
  bool cutAt(const Vec<D>& x) const { return where_ && shapeContains(x) && !whereHolds(x); }
  bool cut() const { return where_ != nullptr; }
  /// Whether all points between two of its points belong to it, too.
  bool convex() const { return !where_ && shape_.innerRadius == 0; }
  bool touches(const Vec<D>& min, const Vec<D>& max) const {
    for (int k = 0; k < D; ++k)
      if (max[k] < min_[k] || min[k] > max_[k]) return false;
    return true;
  }

  const std::vector<Face<D>>& faces() const { return faces_; }
  const Vec<D>& min() const { return min_; }
  const Vec<D>& max() const { return max_; }

 private:
  bool shapeContains(const Vec<D>& x) const;
  bool whereHolds(const Vec<D>& x) const;

  Shape shape_;
  Vec<D> shift_;
  const Expression* where_;
  double slack_;  // [m]
  Vec<D> min_, max_;
  std::vector<Face<D>> faces_;
};

extern template struct Face<2>;
extern template struct Face<3>;
extern template class WallPart<2>;
extern template class WallPart<3>;

/// Whether two walls never slide along each other: united they are one solid.
bool moveAlike(const Body& a, const Body& b);

}  // namespace treacle
