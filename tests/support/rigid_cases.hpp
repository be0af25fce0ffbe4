#pragma once

#include "treacle/model/case.hpp"

namespace treacle::test {

/// A block of some density in the middle of a blob of fluid, without walls; in spacings of 1 mm.
inline Case blockCase(int dimensions, double density) {
  Case c;
  c.dimensions = dimensions;
  c.spacing = 1e-3;
  c.domain = {{-0.03, -0.03, dimensions == 3 ? -0.03 : 0.0}, {0.03, 0.03, dimensions == 3 ? 0.03 : 0.0}, {}};
  c.materials.resize(2);
  c.materials[0].name = "honey";
  c.materials[0].density = 1400;
  c.materials[0].dynamicViscosity = 5;
  c.materials[0].bulkViscosity = 5e3;
  c.materials[0].bulkModulus = 5e5;
  c.materials[1] = c.materials[0];
  c.materials[1].name = "block";
  c.materials[1].density = density;
  Body blob, block;
  blob.name = "blob";
  blob.kind = BodyKind::Fluid;
  blob.shape.kind = ShapeKind::Box;
  const double deep = dimensions == 3 ? 6e-3 : 0;
  blob.shape.min = {-10e-3, -8e-3, -deep}, blob.shape.max = {10e-3, 8e-3, deep};
  blob.where =
      dimensions == 3 ? "abs(x) > 3e-3 || abs(y) > 2e-3 || abs(z) > 2e-3" : "abs(x) > 3e-3 || abs(y) > 2e-3";
  block.name = "block";
  block.kind = BodyKind::Rigid;
  block.material = 1;
  block.shape.kind = ShapeKind::Box;
  block.shape.min = {-3e-3, -2e-3, dimensions == 3 ? -2e-3 : 0.0};
  block.shape.max = {3e-3, 2e-3, dimensions == 3 ? 2e-3 : 0.0};
  c.bodies = {blob, block};
  c.time.step = 1e-3;
  c.time.end = 1;
  return c;
}

}  // namespace treacle::test
