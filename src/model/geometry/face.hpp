#pragma once

#include "solid.hpp"
#include "treacle/model/geometry/shape.hpp"

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
  /// A place x beside the axis of a cone: the direction away from the axis, the distance to it, and the radius
  /// there.
  struct Across {
    Vec<D> outwards;
    double distance, radius;
  };
  Across across(const Vec<D>& x) const;
};

/// The faces of a shape before its transform; of `solid` those of a polygon or mesh, null for all others.
template <int D>
std::vector<Face<D>> facesOf(const Shape& shape, const Solid<D>* solid);

extern template struct Face<2>;
extern template struct Face<3>;

}  // namespace treacle
