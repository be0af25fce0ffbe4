#pragma once

#include "treacle/model/case/case.hpp"

namespace treacle::test {

inline Body makeBody(std::string name, BodyKind kind, Shape shape) {
  Body body;
  body.name = std::move(name), body.kind = kind, body.shape = shape;
  return body;
}

inline Shape box(Vec<3> min, Vec<3> max) {
  Shape shape;
  shape.min = min, shape.max = max;
  return shape;
}

inline Shape sphere(Vec<3> center, double radius, double innerRadius = 0) {
  Shape shape;
  shape.kind = ShapeKind::Sphere;
  shape.center = center, shape.radius = radius, shape.innerRadius = innerRadius;
  return shape;
}

inline Shape cylinder(Vec<3> start, Vec<3> end, double radius, double innerRadius = 0) {
  Shape shape;
  shape.kind = ShapeKind::Cylinder;
  shape.start = start, shape.end = end, shape.radius = radius, shape.innerRadius = innerRadius;
  return shape;
}

/// Spacing 1 m, an open domain of 200 m around the origin, one material with dt kappa / lambda = 0.1; no bodies
/// yet.
inline Case emptyCase(int dimensions) {
  Case c;
  c.dimensions = dimensions;
  c.spacing = 1;
  for (int k = 0; k < dimensions; ++k) c.domain.min[k] = -100, c.domain.max[k] = 100;
  c.materials = {{"syrup", 1000, 10, 1e4, 1e6}};
  c.time = {1e-3, 0.2};
  return c;
}

}  // namespace treacle::test
