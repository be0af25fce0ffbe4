#include "treacle/model/case/bulk_constants.hpp"

#include "treacle/model/materials/material_table.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace treacle {
namespace {

/// A block of 40 x 20 mm, 10 mm above a floor, with a spacing of 1 mm.
Case blockOf(double viscosity) {
  Case c;
  c.dimensions = 2, c.spacing = 1e-3;
  c.time = {1e-3, 1};
  c.gravity = {0, -10, 0};
  Material fluid;
  fluid.name = "fluid", fluid.density = 1000, fluid.dynamicViscosity = viscosity;
  fluid.autoBulkViscosity = fluid.autoBulkModulus = true;
  Material wall = fluid;
  wall.name = "wall", wall.density = 8000, wall.dynamicViscosity = 0;
  c.materials = {fluid, wall};
  Body block;
  block.shape.min = {0, 0.01, 0}, block.shape.max = {0.04, 0.03, 0};
  Body floor;
  floor.kind = BodyKind::Wall, floor.material = 1;
  floor.shape.min = {-0.1, -0.005, 0}, floor.shape.max = {0.1, 0, 0};
  c.bodies = {block, floor};
  return c;
}

const Material& set(Case& c) {
  setBulkConstants(c);
  return c.materials[0];
}

TEST(BulkConstants, FollowTheWeightOfWhatCanStandOnTheFloor) {
  Case c = blockOf(10);
  const Material& m = set(c);
  EXPECT_DOUBLE_EQ(m.bulkModulus, 500 * 1000 * 10 * 0.03);
  EXPECT_DOUBLE_EQ(m.bulkViscosity, 1e4);
  EXPECT_EQ(c.materials[1].bulkViscosity, m.bulkViscosity);
  EXPECT_EQ(c.materials[1].bulkModulus, m.bulkModulus);
}

/// The case turned as a whole.
TEST(BulkConstants, DoNotDependOnTheAxes) {
  Case c = blockOf(10);
  c.gravity = {5, -5 * std::sqrt(3.0), 0};
  for (Body& body : c.bodies) body.shape.transform.emplace().angle = 30;
  EXPECT_DOUBLE_EQ(set(c).bulkModulus, 500 * 1000 * 10 * 0.03);
}

TEST(BulkConstants, ViscosityIsWhatTheStepNeeds) {
  Case c = blockOf(1e-3);
  c.spacing = 1e-6;
  const double kappa = 500 * 1000 * std::max(10 * 0.03, 2 * 10 * 0.02);  // it falls freely
  Case published = c;
  published.method.scheme = SchemeKind::Published;
  published.method.densityRadius = published.method.pressureRadius;
  Case automatic = c;
  automatic.time.automatic = true, automatic.time.step = 0;
  EXPECT_DOUBLE_EQ(set(c).bulkModulus, kappa);
  EXPECT_DOUBLE_EQ(set(c).bulkViscosity, 4e-3 * kappa);
  EXPECT_DOUBLE_EQ(set(published).bulkViscosity, 2e-3 * kappa);
  automatic.spacing = 1e-2, automatic.gravity = {}, automatic.bodies[0].velocity = {0.6, 0, 0};
  const double step = 0.5 * 1e-2 / 0.6, impact = 500 * 1000 * 0.6 * 0.6;
  EXPECT_NEAR(set(automatic).bulkViscosity, 4 * step * impact, 0.005 * 4 * step * impact);
}

/// However short the step is, density errors take longer to vanish than gravity to move particles by a spacing.
TEST(BulkConstants, LeaveParticlesTimeToSettle) {
  Case c = blockOf(1e-3);
  c.time.step = 1e-6;
  const Material& m = set(c);
  EXPECT_NEAR(m.bulkViscosity / m.bulkModulus, 2 * std::sqrt(1e-3 / 10), 0.01 * 0.02);
}

/// Fluid whose excess of density is the pressure's.
FluidDensity pressed(double excess) { return {excess, excess, 0}; }

TEST(BulkConstants, FollowTheDensityInTheRun) {
  Case c = blockOf(10);
  setBulkConstants(c);
  const double kappa = c.materials[0].bulkModulus, lambda = c.materials[0].bulkViscosity;
  EXPECT_NEAR(0.25 * lambda / (kappa * c.time.step), 16.7, 0.1) << "as far as the step lets kappa grow";
  BulkMemory memory;
  EXPECT_FALSE(adaptBulkConstants(c, pressed(0.004), 1e-3, false, memory));
  EXPECT_EQ(memory, BulkMemory{});
  EXPECT_TRUE(adaptBulkConstants(c, pressed(0.006), 1e-3, false, memory));
  EXPECT_EQ(memory.modulus, 4);
  EXPECT_EQ(memory.viscosity, 1);
  EXPECT_NEAR(memory.rest, 2 * lambda / (4 * kappa), 1e-12);
  EXPECT_FALSE(adaptBulkConstants(c, pressed(0.006), 1e-3, false, memory)) << "it has had no time to act";
  EXPECT_TRUE(adaptBulkConstants(c, pressed(0.008), 1e-3, false, memory))
      << "the fluid is pressed together faster";
  EXPECT_EQ(memory.modulus, 16);
  EXPECT_FALSE(adaptBulkConstants(c, pressed(0.008), 1.0, false, memory)) << "that did not help";
  EXPECT_TRUE(adaptBulkConstants(c, pressed(0.007), 1.0, false, memory)) << "it has helped";
  double excess = 0.01;
  for (int k = 0; k < 20; ++k) adaptBulkConstants(c, pressed(excess *= 1.21), 1.0, false, memory);
  EXPECT_EQ(memory.modulus, 256) << "both, then no more";
  EXPECT_EQ(memory.viscosity, 16);
  BulkMemory full;
  EXPECT_FALSE(adaptBulkConstants(c, pressed(0.014), 1e-3, true, full)) << "it holds too much from the start";
  EXPECT_FALSE(adaptBulkConstants(c, pressed(0.012), 1e-3, false, full));
  EXPECT_TRUE(adaptBulkConstants(c, pressed(0.018), 1e-3, false, full)) << "and is pressed together now";
  MaterialTable table = MaterialTable::make(c);
  table.raiseBulk(c, memory);
  EXPECT_DOUBLE_EQ(table.bulkViscosity[0], 16 * lambda);
  EXPECT_DOUBLE_EQ(table.bulkModulus[0], memory.modulus * kappa);
  c.materials[0].autoBulkModulus = c.materials[1].autoBulkModulus = false;
  memory = {};
  EXPECT_FALSE(adaptBulkConstants(c, pressed(0.1), 1e-3, false, memory)) << "the case gives one of them";
}

TEST(BulkConstants, DoNotFollowWhatNoPressureMakes) {
  Case c = blockOf(10);
  setBulkConstants(c);
  BulkMemory memory;
  EXPECT_FALSE(adaptBulkConstants(c, {0.02, 0.008, 0}, 1e-3, false, memory));
  EXPECT_EQ(memory, BulkMemory{});
  EXPECT_TRUE(adaptBulkConstants(c, {0.02, 0.012, 0}, 1e-3, false, memory));
}

TEST(BulkConstants, FollowFluidThatFolds) {
  Case c = blockOf(10);
  setBulkConstants(c);
  const double rate = c.materials[0].bulkModulus / c.materials[0].bulkViscosity;  // 15 1/s
  BulkMemory memory;
  EXPECT_FALSE(adaptBulkConstants(c, {0.004, 0, rate}, 1e-3, false, memory)) << "it is not too dense";
  EXPECT_FALSE(adaptBulkConstants(c, {0.02, 0, 0.12 * rate}, 1e-3, false, memory)) << "kappa is large enough";
  EXPECT_TRUE(adaptBulkConstants(c, {0.02, 0, 0.3 * rate}, 1e-3, false, memory));
  EXPECT_EQ(memory.turning, 4);
  EXPECT_EQ(memory.modulus, 1);
  EXPECT_TRUE(adaptBulkConstants(c, {0.02, 0, rate}, 1e-3, false, memory));
  EXPECT_EQ(memory.turning, 16) << "as far as the step lets it, 16.7";
  EXPECT_NEAR(memory.rest, 2 / (16 * rate), 1e-12);
  EXPECT_FALSE(adaptBulkConstants(c, {0.02, 0, 10 * rate}, 1e-3, false, memory));
  MaterialTable table = MaterialTable::make(c);
  table.raiseBulk(c, memory);
  EXPECT_DOUBLE_EQ(table.bulkModulus[0], 16 * c.materials[0].bulkModulus);
  EXPECT_DOUBLE_EQ(table.bulkViscosity[0], c.materials[0].bulkViscosity);
  EXPECT_FALSE(adaptBulkConstants(c, {0.004, 0, 0.6 * rate}, 1, false, memory)) << "it wavers";
  EXPECT_TRUE(adaptBulkConstants(c, {0.004, 0, 0.4 * rate}, 1, false, memory)) << "it flows more slowly";
  EXPECT_EQ(memory.turning, 4);
  EXPECT_FALSE(adaptBulkConstants(c, {0, 0, rate}, 1e-3, false, memory)) << "it has had no time to act";
  EXPECT_TRUE(adaptBulkConstants(c, {0, 0, rate}, 1, false, memory)) << "the excess is gone";
  EXPECT_EQ(memory.turning, 2);
  EXPECT_TRUE(adaptBulkConstants(c, {0.004, 0, 0}, 1, false, memory)) << "the fluid is at rest";
  EXPECT_EQ(memory.turning, 1);
}

TEST(BulkConstants, KeepWhatTheCaseSays) {
  Case modulus = blockOf(10);
  modulus.materials[0].bulkModulus = 1e7, modulus.materials[0].autoBulkModulus = false;
  EXPECT_EQ(set(modulus).bulkModulus, 1e7);
  EXPECT_DOUBLE_EQ(modulus.materials[0].bulkViscosity, 4e4);
  Case viscosity = blockOf(10);
  viscosity.materials[0].bulkViscosity = 100, viscosity.materials[0].autoBulkViscosity = false;
  EXPECT_EQ(set(viscosity).bulkViscosity, 100);
  EXPECT_DOUBLE_EQ(viscosity.materials[0].bulkModulus, 25000);  // half of what is stable
  Case water = blockOf(10);
  water.method.kind = MethodKind::Isph;
  setBulkConstants(water);
  EXPECT_EQ(water.materials[0].bulkModulus, 0);
}

TEST(BulkConstants, FollowNozzlesOpeningsSpeedsAndSurfaceTension) {
  Case c = blockOf(10);
  c.gravity = {};
  Case nozzle = c, opening = c, wall = c, drop = c;
  Body& feed = nozzle.bodies.emplace_back();
  feed.kind = BodyKind::Inflow;
  feed.inflow.nozzle.radius = 3e-3;
  feed.inflow.speed = TimeFunction{.value = 0.7};
  EXPECT_NEAR(set(nozzle).bulkModulus, 100 * 32 * 10 * 0.7 / 6e-3, 0.005 * 100 * 32 * 10 * 0.7 / 6e-3);
  Opening& gate = opening.openings.emplace_back();
  gate.face.kind = NozzleKind::Rectangle, gate.face.width = 0.02;
  gate.pressure = TimeFunction{.times = {0}, .values = {-500}};
  EXPECT_DOUBLE_EQ(set(opening).bulkModulus, 2.5e5);
  opening.time.automatic = true, opening.time.step = 0;
  EXPECT_LT(set(opening).bulkViscosity, 2e4) << "steps are as long as the pressure moves fluid by half a spacing";
  wall.bodies[1].velocity = {0.2, 0, 0};
  EXPECT_DOUBLE_EQ(set(wall).bulkModulus, 500 * 10 * 0.2 / 0.02);
  drop.materials[0].surfaceTension = 0.04;
  EXPECT_DOUBLE_EQ(set(drop).bulkModulus, 500 * 4 * 0.04 / 0.02);
  // Nothing says how large pressures are: what a step that is short bears.
  EXPECT_DOUBLE_EQ(set(c).bulkModulus, 0.1 * 0.25 * 1e4 / 1e-3);
}

}  // namespace
}  // namespace treacle
