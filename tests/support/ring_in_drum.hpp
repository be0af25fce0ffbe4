#pragma once

#include "treacle/model/case/case.hpp"
#include "treacle/model/case/case_keys.hpp"

namespace treacle::test {

/// A ring of honey in a drum at rest, without gravity, by the default formulas of a scheme.
inline Case ringInDrum(SchemeKind scheme = SchemeKind::Accurate) {
  Case c;
  c.dimensions = 2;
  c.spacing = 1e-3;
  c.domain.min = {-0.026, -0.026, 0}, c.domain.max = {0.026, 0.026, 0};
  c.time.step = 1e-3, c.time.end = 1;
  c.method = defaultMethod(scheme);
  c.watch.density = 0;
  Material honey;
  honey.name = "honey", honey.density = 1400, honey.dynamicViscosity = 10;
  honey.bulkViscosity = 1e4, honey.bulkModulus = 1e6;
  c.materials = {honey};
  Body fluid, drum;
  fluid.name = "fluid", fluid.kind = BodyKind::Fluid;
  fluid.shape.kind = drum.shape.kind = ShapeKind::Sphere;
  fluid.shape.radius = 0.02, fluid.shape.innerRadius = 0.01;
  drum.name = "drum", drum.kind = BodyKind::Wall;
  drum.shape.radius = 0.024, drum.shape.innerRadius = 0.02;
  c.bodies = {fluid, drum};
  return c;
}

}  // namespace treacle::test
