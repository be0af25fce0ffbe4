#pragma once

#include "treacle/model/case/case.hpp"

#include <cmath>

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

/// The same case for ISPH, with a fluid of some viscosity [Pa s]: of 5 the viscous step is implicit.
inline Case withIsph(Case c, double viscosity) {
  c.method.kind = MethodKind::Isph;
  c.solver.preconditioner = PreconditionerKind::HatMultigrid;
  c.solver.firstGuess = FirstGuess::Last;
  for (Material& m : c.materials) m.dynamicViscosity = viscosity, m.bulkViscosity = 0, m.bulkModulus = 0;
  return c;
}

/// A block of wood that floats in water at rest with six tenths of its height below the surface, as it does; in
/// spacings of 1 cm, and of ISPH. The upper corners of the block are dry.
inline Case floatingBlockCase() {
  Case c = withIsph(blockCase(2, 600), 1e-3);
  c.spacing = 0.01;
  c.domain = {{-0.3, -0.1, 0}, {0.3, 0.4, 0}, {}};
  c.materials[0].density = 1000;
  c.gravity = {0, -10, 0};
  c.method.isph.alpha = 0.02;
  Body &pool = c.bodies[0], &block = c.bodies[1];
  pool.shape.min = {-0.2, 0, 0}, pool.shape.max = {0.2, 0.2, 0};
  pool.where = "abs(x) > 0.1 || y < 0.14";
  block.shape.min = {-0.1, 0.14, 0}, block.shape.max = {0.1, 0.24, 0};
  const auto add = [&](const char* name, const Vec<3>& min, const Vec<3>& max) {
    Body wall;
    wall.name = name;
    wall.kind = BodyKind::Wall;
    wall.shape.kind = ShapeKind::Box;
    wall.shape.min = min, wall.shape.max = max;
    c.bodies.push_back(wall);
  };
  add("floor", {-0.23, -0.03, 0}, {0.23, 0, 0});
  add("left", {-0.23, 0, 0}, {-0.2, 0.3, 0});
  add("right", {0.2, 0, 0}, {0.23, 0.3, 0});
  return c;
}

/// A block without fluid below it that falls onto a floor, between fluid at its sides that has about no weight in
/// this; in spacings of 1 mm.
inline Case fallingBlockCase(int dimensions, double angle) {
  Case c = blockCase(dimensions, 7000);
  c.gravity = {0, -10, 0};
  Body &blob = c.bodies[0], &block = c.bodies[1];
  const double deep = dimensions == 3 ? 6e-3 : 0;
  blob.where = dimensions == 3 ? "abs(x) > 5e-3 || abs(z) > 5e-3" : "abs(x) > 5e-3";
  block.shape.transform = Transform{};
  if (dimensions == 2)
    block.shape.transform->angle = angle;
  else
    block.shape.transform->angles = {0, 0, angle};
  block.velocity = {0, -0.6, 0};
  Body floor;
  floor.name = "floor";
  floor.kind = BodyKind::Wall;
  floor.shape.kind = ShapeKind::Box;
  floor.shape.min = {-12e-3, -13e-3, -2 * deep}, floor.shape.max = {12e-3, -8e-3, 2 * deep};
  c.bodies.push_back(floor);
  return c;
}

/// A case of these blocks with all fluid at an end of the domain.
inline Case withDistantFluid(Case c) {
  c.bodies[0].shape.min[0] = 24e-3, c.bodies[0].shape.max[0] = 28e-3;
  c.bodies[0].where.clear();
  return c;
}

/// A block that lies on a slope, of which gravity is tilted in its place: along x it goes down. Drops of fluid
/// stand on the slope at both ends of it, farther away than they act on it.
inline Case slopeCase(int dimensions, double slope, double friction) {
  Case c = fallingBlockCase(dimensions, 0);
  c.gravity = {10 * std::sin(slope), -10 * std::cos(slope), 0};
  Body &drops = c.bodies[0], &block = c.bodies[1], &floor = c.bodies[2];
  const double deep = dimensions == 3 ? 2e-3 : 0;
  drops.shape.min = {-9e-3, -8e-3, -deep / 2}, drops.shape.max = {9e-3, -6e-3, deep / 2};
  drops.where = "abs(x) > 7e-3";
  block.shape.min = {-3e-3, -8e-3, -deep}, block.shape.max = {3e-3, -4e-3, deep};
  block.shape.transform.reset();
  block.velocity = {};
  block.friction = floor.friction = friction;
  return c;
}

/// The same for ISPH. Drops press on nothing in the published scheme.
inline Case isphSlopeCase(double slope, double friction) {
  Case c = withIsph(slopeCase(2, slope, friction), 5);
  c.method.scheme = SchemeKind::Published;
  return c;
}

/// Two blocks of some densities that go toward each other, fluid above and below.
inline Case meetingBlocksCase(double first, double second) {
  Case c = blockCase(2, first);
  c.materials.push_back(c.materials[1]);
  c.materials[2].name = "other", c.materials[2].density = second;
  c.bodies[0].where = "abs(y) > 4e-3";
  Body left = c.bodies[1], right = left;
  left.shape.min = {-9e-3, -2e-3, 0}, left.shape.max = {-3e-3, 2e-3, 0};
  right.shape.min = {3e-3, -2e-3, 0}, right.shape.max = {9e-3, 2e-3, 0};
  left.velocity = {0.5, 0, 0}, right.velocity = {-0.25, 0, 0};
  right.name = "other", right.material = 2;
  c.bodies = {c.bodies[0], left, right};
  return c;
}

}  // namespace treacle::test
