#pragma once

#include "treacle/model/case/case.hpp"
#include "treacle/model/case/case_keys.hpp"

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

}  // namespace treacle::test
