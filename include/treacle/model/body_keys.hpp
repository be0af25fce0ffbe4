#pragma once

#include "treacle/model/case.hpp"
#include "treacle/model/key.hpp"

namespace treacle::keys {

void visit(auto& v, Like<Oscillation> auto& o, const Case&) {
  v({"amplitude", required, "m"}, o.amplitude);
  v({"period", required, "s", positive}, o.period);
  v({"phase", optional, "rad"}, o.phase);
}

void visit(auto& v, Like<Rotation> auto& r, const Case& c) {
  v({"center", required, "m"}, r.center);
  v({"speed", required, "rad/s"}, r.speed);
  if (c.dimensions == 3) v({"axis", required, "any unit"}, r.axis);
}

/// The coordinates of a shape, which stand among the keys of its body.
void visit(auto& v, Like<Shape> auto& s, const Case&) {
  switch (s.kind) {
    case ShapeKind::Box:
      v({"min", required, "m"}, s.min);
      v({"max", required, "m"}, s.max);
      return;
    case ShapeKind::Sphere:
      v({"center", required, "m"}, s.center);
      break;
    case ShapeKind::Cylinder:
      v({"start", required, "m"}, s.start);
      v({"end", required, "m"}, s.end);
      break;
  }
  v({"radius", required, "m", positive}, s.radius);
  v({"inner_radius", optional, "m", notNegative}, s.innerRadius);
}

void visit(auto& v, Like<Body> auto& b, const Case& c) {
  v({"name", required}, b.name);
  v({"type", required}, b.kind);
  v({"material", required}, b.material, material);
  v({"shape", required}, b.shape.kind);
  v({"where"}, b.where, expression);
  v({"velocity", optional, "m/s"}, b.velocity, b.velocityExpression);
  v({"oscillation"}, b.oscillation);
  v({"rotation"}, b.rotation);
  if (c.heat) {
    const bool fluid = b.kind == BodyKind::Fluid;
    v({"temperature", fluid, "K", fluid ? positive : notNegative}, b.temperature, b.temperatureExpression);
    if (!fluid) v({"wall_conductance", optional, "W/(m2 K)", notNegative}, b.wallConductance);
  }
  visit(v, b.shape, c);
}

}  // namespace treacle::keys
