#include "rigid_mass.hpp"

#include "support/isph_cases.hpp"
#include "support/rigid_cases.hpp"
#include "support/state_of.hpp"
#include "treacle/step/simulation.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace treacle::test {
namespace {

TEST(RigidBodies, HaveMassAndInertiaOfTheirShapes) {
  const Processes alone;
  const Case plane = blockCase(2, 700), space = blockCase(3, 700);
  const RigidBody a = rigidBodies<2>(plane, alone, created<2>(plane))[1];
  EXPECT_NEAR(a.mass, 700 * 6e-3 * 4e-3, 1e-12);
  EXPECT_LE(norm(a.center), 1e-12);
  EXPECT_NEAR(a.inertia[2], a.mass * (36e-6 + 16e-6) / 12, 1e-12);
  const RigidBody b = rigidBodies<3>(space, alone, created<3>(space))[1];
  EXPECT_NEAR(b.mass, 700 * 6e-3 * 4e-3 * 4e-3, 1e-12);
  EXPECT_NEAR(b.inertia[0], b.mass * (16e-6 + 16e-6) / 12, 1e-14);
  EXPECT_NEAR(b.inertia[1], b.mass * (36e-6 + 16e-6) / 12, 1e-14);
  for (const std::size_t k : {3u, 4u, 5u}) EXPECT_NEAR(b.inertia[k], 0, 1e-16);
  Case given = plane;
  given.bodies[1].rigid.mass = 0.5;
  EXPECT_EQ(rigidBodies<2>(given, alone, created<2>(given))[1].mass, 0.5);
}

TEST(RigidBodies, TurnAsTheirMotionsTurnTheirParticles) {
  RigidBody body;
  body.mass = 1;
  body.inertia = {1, 1, 1, 0, 0, 0};
  body.center = {1, 2, 3};
  body.velocity = {0.3, 0, -0.1};
  body.spin = {0.5, -1, 2};
  const Vec<3> start{1.5, 1.7, 3.2};
  Vec<3> x = start;
  for (int k = 0; k < 100; ++k) {
    x = x + 0.01 * rigidMotion<3>(body, 0.01).chordAt(x);
    body.advance(0.01);
    const Vec<3> expected = body.center + turnedBy(body.orientation, start - Vec<3>{1, 2, 3});
    ASSERT_LE(norm(x - expected), 1e-13);
    ASSERT_LE(norm(rigidMotion<3>(body, 0.01).turned({1, 0, 0}) - turnedBy(body.orientation, {1, 0, 0})), 1e-13);
  }
}

/// Momentum of fluid and bodies.
template <int D>
Vec<3> momentum(const Case& c, const Simulation<D>& simulation) {
  const Particles<D> p = stateOf(simulation);
  Vec<3> sum{};
  for (std::uint32_t i = 0; i < p.fluidCount; ++i)
    sum = sum + (c.materials[p.material[i]].density * std::pow(c.spacing, D)) * resized<3>(p.velocity[i]);
  for (const RigidBody& body : p.rigid.bodies) sum = sum + body.mass * body.velocity;
  return sum;
}

template <int D>
void checkMomentum(double density) {
  Case c = blockCase(D, density);
  c.bodies[1].velocity = {0.1, 0.05, 0};
  c.bodies[1].rigid.angularVelocity = {0, 0, 5};
  Simulation<D> simulation(c, created<D>(c));
  const Vec<3> before = momentum(c, simulation);
  for (int k = 0; k < 10; ++k) simulation.advance();
  const Vec<3> after = momentum(c, simulation);
  const double fluid = c.materials[0].density * std::pow(c.spacing, D) * simulation.particles().fluidCount;
  EXPECT_LE(norm(after - before), 2e-6 * (norm(before) + fluid * 0.11));
  const RigidBody& body = simulation.particles().rigid.bodies[1];
  EXPECT_LT(std::abs(body.spin[2]), 5);
  EXPECT_LT(norm(body.velocity), 0.1);
}

TEST(RigidBodies, ExchangeMomentumWithTheFluid) {
  for (const double density : {1.0, 1400.0, 2e4}) checkMomentum<2>(density);
  checkMomentum<3>(500);
}

/// Of the fluid's density a body falls with it, whatever the viscosity.
TEST(RigidBodies, FallFreelyWithTheFluid) {
  Case c = blockCase(2, 1400);
  c.gravity = {0, -10, 0};
  Simulation<2> simulation(c, created<2>(c));
  for (int k = 0; k < 20; ++k) simulation.advance();
  const RigidBody& body = simulation.particles().rigid.bodies[1];
  EXPECT_NEAR(body.velocity[1], -0.2, 1e-6);
  EXPECT_NEAR(body.velocity[0], 0, 1e-6);
  EXPECT_NEAR(body.center[1], -10 * 1e-6 * 210, 1e-8);
}

/// What the balance says that the fluid does to a body is what its velocity changes by.
TEST(RigidBodies, AreAcceleratedByTheForcesOfTheBalance) {
  Case c = blockCase(2, 300);
  c.gravity = {1, -10, 0};
  c.bodies[1].rigid.angularVelocity = {0, 0, 20};
  c.output.balance = true;
  Simulation<2> simulation(c, created<2>(c));
  for (int k = 0; k < 8; ++k) {
    const RigidBody before = simulation.particles().rigid.bodies[1];
    const StepReport report = simulation.advance();
    const RigidBody& after = report.rigid[1];
    const WallLoad& load = report.balance->walls[0];
    const Vec<3> force =
        (after.mass / report.timeStep) * (after.velocity - before.velocity) - after.mass * c.gravity;
    EXPECT_LE(norm(force - load.force), 2e-5 * (norm(load.force) + after.mass * 10));
    const double torque = after.inertia[2] * (after.spin[2] - before.spin[2]) / report.timeStep;
    EXPECT_NEAR(torque, load.torque[2], 2e-4 * (std::abs(load.torque[2]) + 1e-4));
  }
}

TEST(RigidBodies, KeepWhatIsLocked) {
  Case c = blockCase(2, 300);
  c.gravity = {3, -10, 0};
  c.bodies[1].velocity = {0, 0.02, 0};
  c.bodies[1].rigid.translates = {true, false, true};
  c.bodies[1].rigid.rotates[2] = false;
  Simulation<2> simulation(c, created<2>(c));
  for (int k = 0; k < 5; ++k) simulation.advance();
  const RigidBody& body = simulation.particles().rigid.bodies[1];
  EXPECT_EQ(body.velocity[1], 0.02);
  EXPECT_EQ(body.spin[2], 0);
  EXPECT_NE(body.velocity[0], 0);
}

template <int D>
void checkContinued(Case c) {
  c.gravity[1] = -10;
  c.bodies[1].rigid.angularVelocity = {0, 0, 3};
  Simulation<D> whole(c, created<D>(c));
  for (int k = 0; k < 6; ++k) whole.advance();
  Simulation<D> rest(c, stateOf(whole), whole.step(), whole.time());
  for (int k = 0; k < 6; ++k) {
    const StepReport a = whole.advance(), b = rest.advance();
    ASSERT_EQ(a.iterations, b.iterations);
    ASSERT_EQ(a.rigid, b.rigid);
  }
  EXPECT_TRUE(sameBits(stateOf(whole), stateOf(rest)));
  EXPECT_EQ(whole.particles().rigid, rest.particles().rigid);
}

TEST(RigidBodies, ContinueFromACopyWithTheSameBits) {
  checkContinued<2>(blockCase(2, 300));
  checkContinued<3>(blockCase(3, 3000));
}

/// Least height of the particles of the block above the floor's surface, less half a spacing.
template <int D>
double gapToFloor(const Case& c, const Simulation<D>& simulation) {
  const Particles<D> p = stateOf(simulation);
  double least = 1;
  for (std::uint32_t i = p.wallBegin(); i < p.count; ++i)
    if (p.body[i] == 1) least = std::min(least, p.position[i][1] + 8e-3 - c.spacing / 2);
  return least;
}

template <int D>
void checkFall(double angle, int steps, double tall) {
  const Case c = fallingBlockCase(D, angle);
  Simulation<D> simulation(c, created<D>(c));
  double least = 1;
  for (int k = 0; k < steps; ++k) {
    simulation.advance();
    least = std::min(least, gapToFloor(c, simulation));
  }
  EXPECT_GT(least, -0.1 * c.spacing);
  const RigidBody& body = simulation.particles().rigid.bodies[1];
  EXPECT_LT(norm(body.velocity), 2e-3) << body.velocity[0] << ' ' << body.velocity[1];
  EXPECT_LT(norm(body.spin), 1);
  EXPECT_NEAR(body.center[1], -8e-3 + tall / 2, 0.1 * c.spacing);
}

/// Flat, it stops; from a corner it falls onto its longer side.
TEST(RigidBodies, RestOnAFloorWithoutFluidBetween) {
  checkFall<2>(0, 16, 4e-3);
  checkFall<2>(30, 60, 4e-3);
  checkFall<3>(0, 16, 4e-3);
}

/// They go on together, and what one loses the other gets.
TEST(RigidBodies, DoNotGoThroughEachOther) {
  for (const double second : {7000.0, 500.0}) {
    const Case c = meetingBlocksCase(7000, second);
    Simulation<2> simulation(c, created<2>(c));
    const Vec<3> before = momentum(c, simulation);
    for (int k = 0; k < 30; ++k) simulation.advance();
    const std::vector<RigidBody>& bodies = simulation.particles().rigid.bodies;
    EXPECT_NEAR(bodies[2].center[0] - bodies[1].center[0], 6e-3, 0.05 * c.spacing);
    EXPECT_NEAR(bodies[2].velocity[0], bodies[1].velocity[0], 1e-3);
    EXPECT_LE(norm(momentum(c, simulation) - before), 1e-3 * norm(before));
  }
}

}  // namespace
}  // namespace treacle::test
