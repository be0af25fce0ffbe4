#pragma once

#include "treacle/model/case/case.hpp"
#include "treacle/model/case/case_keys.hpp"

#include <string>

namespace treacle::test {

/// Fluid that goes through an empty domain without gravity, from a nozzle to a plane where it leaves; lengths in
/// spacings of 1 mm.
inline Case jetCase(int dimensions, MethodKind method = MethodKind::MphI,
                    SchemeKind scheme = SchemeKind::Accurate) {
  Case c;
  c.dimensions = dimensions;
  c.spacing = 1e-3;
  c.method = defaultMethod(scheme);
  c.method.kind = method;
  c.solver = defaultSolver(method);
  c.domain = {{-0.02, -0.02, dimensions == 3 ? -0.02 : 0.0}, {0.04, 0.02, dimensions == 3 ? 0.02 : 0.0}, {}};
  c.materials.resize(1);
  c.materials[0].name = "honey";
  c.materials[0].density = 1400;
  c.materials[0].dynamicViscosity = 2;
  c.materials[0].bulkViscosity = method == MethodKind::MphI ? 2e3 : 0;
  c.materials[0].bulkModulus = method == MethodKind::MphI ? 2e5 : 0;
  Body jet;
  jet.name = "jet";
  jet.kind = BodyKind::Inflow;
  jet.inflow.nozzle.kind = NozzleKind::Rectangle;
  jet.inflow.nozzle.direction = {2, 0, 0};
  jet.inflow.nozzle.width = 6e-3;
  jet.inflow.nozzle.height = 4e-3;
  jet.inflow.speed = TimeFunction{0.3};
  c.bodies = {jet};
  c.outflows = {{.name = "end", .kind = OutflowKind::Plane, .point = {0.02, 0, 0}, .normal = {1, 0, 0}}};
  c.time.step = 1e-3;
  c.time.end = 0.1;
  return c;
}

/// Fluid between plates, 10 spacings apart, or in a square channel, between two openings 20 spacings apart of
/// which the first has a pressure.
inline Case channelCase(int dimensions, MethodKind method = MethodKind::MphI) {
  Case c = jetCase(dimensions, method);
  const double z = dimensions == 3 ? 1 : 0;
  c.domain = {{-0.012, -0.01, -0.01 * z}, {0.032, 0.01, 0.01 * z}, {}};
  Body fluid;
  fluid.name = "fluid";
  fluid.shape.min = {-0.007, -0.005, -0.005 * z};
  fluid.shape.max = {0.027, 0.005, 0.005 * z};
  c.bodies = {fluid};
  for (int axis = 1; axis < dimensions; ++axis)
    for (const double side : {-1.0, 1.0}) {
      Body wall;
      wall.name = std::string("wall ") + std::to_string(axis) + (side > 0 ? "+" : "-");
      wall.kind = BodyKind::Wall;
      wall.shape.min = {-0.012, -0.009, -0.009 * z};
      wall.shape.max = {0.032, 0.009, 0.009 * z};
      (side > 0 ? wall.shape.min : wall.shape.max)[axis] = side * 0.005;
      if (axis == 2) wall.shape.min[1] = -0.005, wall.shape.max[1] = 0.005;
      c.bodies.push_back(wall);
    }
  c.outflows.clear();
  c.openings.resize(2);
  c.openings[0].name = "inlet", c.openings[1].name = "outlet";
  c.openings[0].pressure = TimeFunction{200};
  for (Opening& o : c.openings) {
    o.face.kind = NozzleKind::Rectangle;
    o.face.width = o.face.height = 0.01;
    o.face.direction = {1, 0, 0};
  }
  c.openings[1].face.center = {0.02, 0, 0};
  c.openings[1].face.direction = {-1, 0, 0};
  return c;
}

}  // namespace treacle::test
