#include "support/drop_case.hpp"
#include "support/isph_cases.hpp"
#include "support/loaded_walls.hpp"
#include "support/state_of.hpp"
#include "treacle/step/run/simulation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

namespace treacle::test {
namespace {

template <int D>
Vec<3> centreOf(const Particles<D>& p) {
  Vec<D> sum{};
  for (std::uint32_t i = 0; i < p.fluidCount; ++i) sum += (1.0 / p.fluidCount) * p.position[i];
  return resized<3>(sum);
}

/// A drop that nothing holds goes, seen from outside, as a stone does: from its start with its velocity there, and
/// with gravity. `velocity`: in the frame at the start.
template <int D>
void checkFall(Case c, const Vec<3>& velocity, double spinAtStart, double (*angle)(double)) {
  c.bodies[0].velocity = velocity;
  const Vec<3> axis = c.frame->direction(), middle = c.frame->center;
  Simulation<D> simulation(c, created<D>(c));
  const Vec<3> start = centreOf<D>(stateOf(simulation)) - middle,
               outside = velocity + spinAtStart * cross(axis, start);
  for (int k = 0; k < 500; ++k) simulation.advance();
  const double t = simulation.time(), turned = angle(t);
  const Vec<3> x = centreOf<D>(stateOf(simulation)) - middle;
  const Vec<3> seen =
      std::cos(turned) * x + std::sin(turned) * cross(axis, x) + ((1 - std::cos(turned)) * dot(axis, x)) * axis;
  const Vec<3> expected = start + t * outside + (0.5 * t * t) * c.gravity;
  // The first step has a whole one of acceleration: half a step's velocity is left.
  const double scale = norm(outside) * t + 0.5 * t * t * norm(c.gravity) + norm(start);
  EXPECT_LE(norm(seen - expected), 0.01 * scale) << D << " dimensions";
}

TEST(TurningFrame, WhatNothingHoldsFallsFreely) {
  for (const bool isph : {false, true}) {
    Case c = dropCase(2, {20e-3, 5e-3, 0}, isph);
    c.frame = Rotation{.center = {1e-3, 2e-3, 0}, .speed = 20};
    c.gravity = {0, -1, 0};
    checkFall<2>(c, {}, 20, [](double t) { return 20 * t; });
    // At rest outside.
    c.gravity = {};
    checkFall<2>(c, -20 * cross(Vec<3>{0, 0, 1}, Vec<3>{19e-3, 3e-3, 0}), 20, [](double t) { return 20 * t; });
    // Faster and faster, from rest.
    c.frame = Rotation{.center = {1e-3, 2e-3, 0}, .angle = TimeFunction{.expression = "100*t^2"}};
    checkFall<2>(c, {}, 0, [](double t) { return 100 * t * t; });
  }
  Case c = dropCase(3, {12e-3, 5e-3, 3e-3}, false);
  c.frame = Rotation{.center = {}, .axis = {1, 2, 2}, .speed = 20};
  c.gravity = {0, -1, 0.5};
  checkFall<3>(c, {0.1, 0, -0.1}, 20, [](double t) { return 20 * t; });
}

/// Fluid at rest in a full box that turns: the pressure rises by density omega^2 r^2 / 2 outwards.
TEST(TurningFrame, FluidAtRestIsPressedOutwards) {
  Case c = dropCase(2, {}, true);
  c.gravity = {};
  c.bodies[0].shape = Shape{};
  c.bodies[0].shape.kind = ShapeKind::Box;
  c.bodies[0].shape.min = {10e-3, -6e-3, 0}, c.bodies[0].shape.max = {30e-3, 6e-3, 0};
  const auto wall = [&](const char* name, const Vec<3>& min, const Vec<3>& max) {
    Body b;
    b.name = name, b.kind = BodyKind::Wall;
    b.shape.kind = ShapeKind::Box;
    b.shape.min = min, b.shape.max = max;
    c.bodies.push_back(b);
  };
  wall("outer", {30e-3, -10e-3, 0}, {34e-3, 10e-3, 0});
  wall("upper", {6e-3, 6e-3, 0}, {30e-3, 10e-3, 0});
  wall("lower", {6e-3, -10e-3, 0}, {30e-3, -6e-3, 0});
  c.frame = Rotation{.center = {}, .speed = 30};
  c.time.step = 1e-4;
  Simulation<2> simulation(c, created<2>(c));
  for (int k = 0; k < 20; ++k) simulation.advance();
  const Particles<2> p = stateOf(simulation);
  double most = 0;
  for (std::uint32_t i = 0; i < p.fluidCount; ++i) {
    const double x = p.position[i][0], y = p.position[i][1];
    // The surface is the circle through the corners that are nearest to the axis, nearly the line x = 10 mm.
    if (x < 15e-3) continue;
    const double expected = 0.5 * 1000 * 900 * (x * x - 1e-4);
    EXPECT_NEAR(p.pressure[i], expected, 0.12 * 0.5 * 1000 * 900 * 8e-4) << x << ", " << y;
    most = std::max(most, p.pressure[i]);
  }
  EXPECT_GT(most, 300);
}

/// What fluid in motion gains and loses in a step. The power of the frame is that at the places at its end, its
/// work that at those before.
TEST(TurningFrame, EnergyIsBalanced) {
  LoadedWalls<2> scene(WallsMove::Not);
  scene.c.frame = Rotation{.center = {0.01, 0.02, 0}, .speed = 15};
  Simulation<2> simulation = scene.simulation<Cpu>();
  simulation.advance();
  const Diagnostics before = simulation.diagnostics();
  const StepEnergy energy(before, simulation.advance());
  EXPECT_NEAR(energy.gained + energy.lost, energy.given, 1e-4 * energy.scale());
}

TEST(TurningFrame, ContinuesWithTheSameBits) {
  Case c = dropCase(2, {20e-3, 5e-3, 0}, false);
  c.frame = Rotation{.center = {}, .angle = TimeFunction{.expression = "sin(50*t)"}};
  c.gravity = {0, -10, 0};
  Simulation<2> whole(c, created<2>(c));
  for (int k = 0; k < 5; ++k) whole.advance();
  Simulation<2> rest(c, stateOf(whole), whole.step(), whole.time());
  for (int k = 0; k < 5; ++k) whole.advance(), rest.advance();
  EXPECT_TRUE(sameBits(stateOf(whole), stateOf(rest)));
}

}  // namespace
}  // namespace treacle::test
