#pragma once

#include "solid.hpp"
#include "treacle/model/case.hpp"
#include "treacle/model/expression.hpp"
#include "treacle/model/shape.hpp"

#include <optional>
#include <vector>

namespace treacle {

/// A surface of which a part bounds a shape: a smooth one without end, or all that bounds a polygon or mesh.
template <int D>
struct Face {
  enum class Form { Plane, Round, Cone, Ring, Solid };

  Form form = Form::Plane;
  Vec<D> origin{};    // plane: a point of it; sphere, ring: the centre; mantle: a point of the axis [m]
  Vec<D> normal{};    // plane: outward, away from the shape
  Vec<D> axis{};      // mantle, ring: its direction
  double radius = 0;  // sphere, mantle, tube of a ring; cone: at its origin [m]
  double slope = 0;   // cone: of the radius along its axis
  double ring = 0;    // radius of the circle that a tube goes around [m]
  double side = 1;    // all but planes: -1 where the shape is hollow inside it
  const Solid<D>* solid = nullptr;
  int solidFace = 0;

  bool flat() const { return form == Form::Plane; }

  struct At {
    double height;  // of the point above the face, negative inside [m]
    Vec<D> normal;  // outward, of the face at its point nearest to this one
  };
  At at(const Vec<D>& x) const;
  /// Where a rod, ball or tube is thin: the point behind its axis or centre.
  struct Behind {
    double distance;  // [m]
    Vec<D> normal;    // outward there
  };
  std::optional<Behind> behind(const Vec<D>& x) const;

 private:
  /// Of a cone: away from its axis at x, how far x is from it, and the radius there.
  struct Across {
    Vec<D> outwards;
    double distance, radius;
  };
  Across across(const Vec<D>& x) const;
};

/// A wall body, or its image one period away: what the surface of walls is made of. The body must stay where it
/// is.
template <int D>
class WallPart {
 public:
  /// `where`: the body's condition, or null. `solid`: of a polygon or mesh, else null. `spacing` [m].
  WallPart(const Body& body, const Vec<D>& shift, const Expression* where, const Solid<D>* solid, double spacing);

  /// The surface belongs to the part, but for what `where` says of it.
  bool contains(const Vec<D>& x) const { return shapeContains(x) && whereHolds(x); }
  /// Whether a point is where the shape is, but its condition does not hold.
  bool cutAt(const Vec<D>& x) const { return where_ && shapeContains(x) && !whereHolds(x); }
  bool cut() const { return where_ != nullptr; }
  /// Whether its condition does not hold at a point, be it of the shape or not.
  bool excludes(const Vec<D>& x) const { return !whereHolds(x); }
  /// Whether all points between two of its points belong to it, too.
  bool convex() const { return convex_ && !where_; }
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
  void addFaces();
  bool shapeContains(const Vec<D>& x) const;
  bool whereHolds(const Vec<D>& x) const;

  Shape shape_;
  Similarity<D> similarity_;
  Vec<D> shift_;
  const Expression* where_;
  const Solid<D>* solid_;
  double slack_;  // [m]
  bool convex_;
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
