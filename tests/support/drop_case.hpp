#pragma once

#include "treacle/model/case/case.hpp"

namespace treacle::test {

inline constexpr double dropSpacing = 1e-3;

/// A drop in an empty domain, whose centre is at `center`.
inline Case dropCase(int dimensions, const Vec<3>& center, bool isph) {
  Case c;
  c.dimensions = dimensions;
  c.spacing = dropSpacing;
  c.domain = {Vec<3>::filled(-60e-3), Vec<3>::filled(60e-3), {}};
  Material fluid;
  fluid.name = "fluid", fluid.density = 1000, fluid.dynamicViscosity = isph ? 1e-3 : 10;
  if (!isph) fluid.bulkViscosity = 1e3, fluid.bulkModulus = 1e5;
  c.materials = {fluid};
  Body drop;
  drop.name = "drop";
  drop.shape.kind = ShapeKind::Sphere;
  drop.shape.radius = 4 * dropSpacing;
  drop.shape.center = center;
  c.bodies = {drop};
  c.time.step = 2e-4, c.time.end = 1;
  c.method.kind = isph ? MethodKind::Isph : MethodKind::MphI;
  if (isph) c.solver.preconditioner = PreconditionerKind::HatMultigrid;
  return c;
}

}  // namespace treacle::test
