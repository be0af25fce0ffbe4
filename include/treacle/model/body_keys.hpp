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
  v({"speed", optional, "rad/s"}, r.speed);
  v({"angle", optional, "rad"}, r.angle);
  if (c.dimensions == 3) v({"axis", required, "any unit"}, r.axis);
}

void visit(auto& v, Like<Transform> auto& t, const Case& c) {
  v({"scale", optional, "", positive}, t.scale);
  if (c.dimensions == 3) v({"axis", optional, "any unit"}, t.axis);
  v({"angle", optional, "deg"}, t.angle);
  if (c.dimensions == 3) v({"angles", optional, "deg"}, t.angles);
  v({"center", optional, "m"}, t.center);
  v({"translate", optional, "m"}, t.translate);
}

/// The coordinates of a shape, which stand among the keys of its body.
void visit(auto& v, Like<Shape> auto& s, const Case& c) {
  const auto radii = [&] {
    v({"radius", required, "m", positive}, s.radius);
    v({"inner_radius", optional, "m", notNegative}, s.innerRadius);
  };
  const auto axis = [&] {
    v({"start", required, "m"}, s.start);
    v({"end", required, "m"}, s.end);
  };
  const auto content = [&] {
    v({"file", required}, s.file.path, keys::file);
    v({"checksum"}, s.file.checksum);
  };
  const auto filling = [&] {
    v({"fill"}, s.fill);
    v({"thickness", optional, "m", notNegative}, s.thickness);
  };
  switch (s.kind) {
    case ShapeKind::Box:
      v({"min", required, "m"}, s.min);
      v({"max", required, "m"}, s.max);
      break;
    case ShapeKind::Sphere:
      v({"center", required, "m"}, s.center);
      radii();
      break;
    case ShapeKind::Cylinder:
      axis();
      radii();
      break;
    case ShapeKind::Cone:
      axis();
      v({"start_radius", required, "m", notNegative}, s.startRadius);
      v({"end_radius", required, "m", notNegative}, s.endRadius);
      v({"inner_start_radius", optional, "m", notNegative}, s.innerStartRadius);
      v({"inner_end_radius", optional, "m", notNegative}, s.innerEndRadius);
      break;
    case ShapeKind::Torus:
      v({"center", required, "m"}, s.center);
      if (c.dimensions == 3) v({"axis", optional, "any unit"}, s.axis);
      v({"tube_radius", required, "m", positive}, s.tubeRadius);
      radii();
      break;
    case ShapeKind::Polygon:
      v({"points", required, "m"}, s.points);
      if (c.dimensions == 3) {
        v({"bottom", required, "m"}, s.bottom);
        v({"top", required, "m"}, s.top);
      }
      filling();
      break;
    case ShapeKind::Mesh:
      content();
      v({"flip"}, s.flip);
      filling();
      break;
    case ShapeKind::Particles:
      content();
      break;
  }
  v({"transform"}, s.transform);
}

void visit(auto& v, Like<Nozzle> auto& n, const Case& c) {
  v({"shape", required}, n.kind);
  v({"center", required, "m"}, n.center);
  v({"direction", required, "any unit"}, n.direction);
  if (n.kind == NozzleKind::Disc) {
    v({"radius", required, "m", positive}, n.radius);
    v({"inner_radius", optional, "m", notNegative}, n.innerRadius);
    return;
  }
  if (n.kind == NozzleKind::Rectangle) {
    v({"width", required, "m", positive}, n.width);
    if (c.dimensions == 3) v({"height", required, "m", positive}, n.height);
  } else {
    v({"points", required, "m"}, n.points);
  }
  if (c.dimensions == 3) v({"up", optional, "any unit"}, n.up);
}

/// What an inflow has in place of a shape, among the keys of its body.
void visit(auto& v, Like<Inflow> auto& i, const Case& c) {
  v({"nozzle", required}, i.nozzle);
  v({"speed", optional, "m/s", notNegative}, i.speed);
  v({"flow_rate", optional, c.dimensions == 2 ? "m2/s" : "m3/s", notNegative}, i.flowRate);
  v({"start", optional, "s", notNegative}, i.start);
  v({"end", optional, "s", notNegative}, i.end);
}

void visit(auto& v, Like<Outflow> auto& o, const Case&) {
  v({"name", required}, o.name);
  v({"shape", required}, o.kind);
  if (o.kind == OutflowKind::Box) {
    v({"min", required, "m"}, o.min);
    v({"max", required, "m"}, o.max);
    return;
  }
  v({"point", required, "m"}, o.point);
  v({"normal", required, "any unit"}, o.normal);
}

/// What a rigid body has among the keys of its body.
void visit(auto& v, Like<RigidSettings> auto& r, const Case& c) {
  v({"mass", optional, c.dimensions == 2 ? "kg/m" : "kg", notNegative}, r.mass);
  v({"translates"}, r.translates);
  if (c.dimensions == 2) {
    v({"angular_velocity", optional, "rad/s"}, r.angularVelocity[2]);
    v({"rotates"}, r.rotates[2]);
  } else {
    v({"angular_velocity", optional, "rad/s"}, r.angularVelocity);
    v({"rotates"}, r.rotates);
  }
}

void visit(auto& v, Like<Body> auto& b, const Case& c) {
  v({"name", required}, b.name);
  v({"type", required}, b.kind);
  v({"material", required}, b.material, material);
  if (b.kind == BodyKind::Inflow) {
    v({"velocity", optional, "m/s"}, b.velocity);
    v({"oscillation"}, b.oscillation);
    v({"displacement", optional, "m"}, b.displacement);
    if (c.heat) v({"temperature", required, "K", positive}, b.temperature);
    return visit(v, b.inflow, c);
  }
  v({"shape", required}, b.shape.kind);
  v({"where"}, b.where, expression);
  v({"velocity", optional, "m/s"}, b.velocity, b.velocityExpression);
  const bool ofFile = b.kind == BodyKind::Fluid && b.shape.kind == ShapeKind::Particles;
  if (ofFile) v({"file_velocities"}, b.fileVelocities);
  if (b.kind == BodyKind::Rigid) {
    visit(v, b.rigid, c);
  } else {
    v({"oscillation"}, b.oscillation);
    v({"displacement", optional, "m"}, b.displacement);
    v({"rotation"}, b.rotation);
  }
  if (c.heat) {
    const bool fluid = b.kind == BodyKind::Fluid;
    if (ofFile) v({"file_temperatures"}, b.fileTemperatures);
    if (!b.fileTemperatures)
      v({"temperature", fluid, "K", fluid ? positive : notNegative}, b.temperature, b.temperatureExpression);
    if (!fluid) v({"wall_conductance", optional, "W/(m2 K)", notNegative}, b.wallConductance);
  }
  visit(v, b.shape, c);
}

}  // namespace treacle::keys
