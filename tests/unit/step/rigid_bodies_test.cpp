#include "bodies/moving_bodies.hpp"
#include "bodies/rigid_mass.hpp"

#include "support/isph_cases.hpp"
#include "support/rigid_cases.hpp"
#include "support/state_of.hpp"
#include "treacle/step/run/simulation.hpp"

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

/// By what the velocity of a particle that goes along changes.
TEST(RigidBodies, AccelerateTheirParticles) {
  const double dt = 1e-6;
  RigidBody before;
  before.mass = 1;
  before.inertia = {1, 1, 1, 0, 0, 0};
  before.center = {1, 2, 3};
  before.velocity = {0.3, 0, -0.1};
  before.spin = {0.5, -1, 2};
  RigidBody after = before;
  after.advance(dt);
  after.velocity = before.velocity + dt * Vec<3>{3, -5, 1};
  after.spin = before.spin + dt * Vec<3>{-7, 2, 4};
  const Vec<3> x{1.5, 1.7, 3.2}, u = rigidMotion<3>(before, dt).velocityAt(x);
  const Vec<3> change = rigidMotion<3>(after, dt).velocityAt(x + dt * u) - u;
  EXPECT_LE(norm(rigidMotion<3>(before, after, dt).accelerationAt(x) - (1 / dt) * change), 1e-4);
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
void checkMomentum(Case c, double part = 2e-6) {
  c.bodies[1].velocity = {0.1, 0.05, 0};
  c.bodies[1].rigid.angularVelocity = {0, 0, 5};
  Simulation<D> simulation(c, created<D>(c));
  const Vec<3> before = momentum(c, simulation);
  for (int k = 0; k < 10; ++k) simulation.advance();
  const Vec<3> after = momentum(c, simulation);
  const double fluid = c.materials[0].density * std::pow(c.spacing, D) * simulation.particles().fluidCount;
  EXPECT_LE(norm(after - before), part * (norm(before) + fluid * 0.11));
  const RigidBody& body = simulation.particles().rigid.bodies[1];
  EXPECT_LT(std::abs(body.spin[2]), 5);
  EXPECT_LT(norm(body.velocity), norm(c.bodies[1].velocity));
}

TEST(RigidBodies, ExchangeMomentumWithTheFluid) {
  for (const double density : {1.0, 1400.0, 2e4}) checkMomentum<2>(blockCase(2, density));
  checkMomentum<3>(blockCase(3, 500));
}

/// Of either viscous step: that of 5 Pa s is implicit, in the accurate scheme with div(mu L^T) beside free
/// surfaces alone. Measured then: 2 %.
TEST(RigidBodies, ExchangeMomentumWithTheFluidOfIsph) {
  for (const SchemeKind scheme : {SchemeKind::Published, SchemeKind::Accurate})
    for (const double viscosity : {1e-3, 5.0}) {
      const double part = scheme == SchemeKind::Accurate && viscosity > 1 ? 0.03 : 2e-6;
      const auto isph = [&](Case c) {
        c = withIsph(std::move(c), viscosity);
        c.method.scheme = scheme;
        return c;
      };
      for (const double density : {1.0, 1400.0, 2e4}) checkMomentum<2>(isph(blockCase(2, density)), part);
      checkMomentum<3>(isph(blockCase(3, 500)), part);
    }
}

/// Of the fluid's density a body falls with it, whatever the viscosity.
void checkFreeFall(Case c, double tolerance) {
  c.gravity = {0, -10, 0};
  Simulation<2> simulation(c, created<2>(c));
  for (int k = 0; k < 20; ++k) simulation.advance();
  const RigidBody& body = simulation.particles().rigid.bodies[1];
  EXPECT_NEAR(body.velocity[1], -0.2, tolerance);
  EXPECT_NEAR(body.velocity[0], 0, tolerance);
  EXPECT_NEAR(body.center[1], -10 * 1e-6 * 210, 0.02 * tolerance);
}

TEST(RigidBodies, FallFreelyWithTheFluid) {
  checkFreeFall(blockCase(2, 1400), 1e-6);
  for (const double viscosity : {0.0, 5.0}) checkFreeFall(withIsph(blockCase(2, 1400), viscosity), 1e-6);
  // Fluid of the start of a step meets walls of its end: measured 1.1e-4.
  checkFreeFall(withIsph(blockCase(2, 1400), 1e-3), 1.2e-4);
}

/// What balance and probes say that the fluid does to a body is what its velocity changes by.
void checkForces(Case c) {
  c.gravity = {1, -10, 0};
  c.bodies[1].rigid.angularVelocity = {0, 0, 20};
  c.probes.resize(1);
  c.probes[0].name = "load", c.probes[0].kind = ProbeKind::Load, c.probes[0].body = "block";
  Simulation<2> simulation(c, created<2>(c));
  for (int k = 0; k < 8; ++k) {
    const RigidBody before = simulation.particles().rigid.bodies[1];
    const StepReport report = simulation.advance();
    const RigidBody& after = report.rigid[1];
    const WallLoad& load = report.loads[0];
    const Vec<3> force =
        (after.mass / report.timeStep) * (after.velocity - before.velocity) - after.mass * c.gravity;
    EXPECT_LE(norm(force - load.force), 1e-4 * (norm(load.force) + after.mass * 10));  // measured: 5e-5
    const double torque = after.inertia[2] * (after.spin[2] - before.spin[2]) / report.timeStep;
    EXPECT_NEAR(torque, load.torque[2], 2e-4 * (std::abs(load.torque[2]) + 1e-4));
  }
}

TEST(RigidBodies, AreAcceleratedByTheForcesOfTheBalance) {
  checkForces(blockCase(2, 300));
  for (const double viscosity : {1e-3, 5.0}) checkForces(withIsph(blockCase(2, 300), viscosity));
}

/// Accelerations before the fluid has gone anywhere: what pushes the fluid of a disc, less its weight, over its
/// mass and the fluid's that goes along, in a wide basin that of the disc. With a radius of ten spacings it
/// is 1.13 to 1.19 times that.
TEST(RigidBodies, TakeFluidAlongInIsph) {
  for (const double density : {1.0, 500.0, 2000.0, 2e4}) {
    Case c = withIsph(blockCase(2, density), 0);
    c.domain = {{-0.08, -0.08, 0}, {0.08, 0.08, 0}, {}};
    c.materials[0].density = 1000;
    c.gravity = {0, -10, 0};
    c.time.step = 1e-4;
    Body &tank = c.bodies[0], &disc = c.bodies[1];
    tank.shape.min = {-60.5e-3, -60.5e-3, 0}, tank.shape.max = {60.5e-3, 60.5e-3, 0};
    tank.where = "x^2 + y^2 > 0.01025^2";
    disc.shape.kind = ShapeKind::Sphere;
    disc.shape.radius = 0.01025;
    Body wall = tank;
    wall.name = "wall", wall.kind = BodyKind::Wall;
    wall.shape.min = {-64.5e-3, -64.5e-3, 0}, wall.shape.max = {64.5e-3, 60.5e-3, 0};
    wall.where = "abs(x) > 0.0605 || y < -0.0605";
    c.bodies.push_back(wall);
    Simulation<2> simulation(c, created<2>(c));
    const double found = simulation.advance().rigid[1].velocity[1] / c.time.step;
    const double along = ((1000 - density) * 10 / found - density) / 1000;
    EXPECT_NEAR(along, 1.16, 0.04) << density;
  }
}

/// Its weight is what the water that it takes the place of would weigh.
TEST(RigidBodies, FloatAsArchimedesSays) {
  Case c = floatingBlockCase();
  c.probes.resize(1);
  c.probes[0].name = "load", c.probes[0].kind = ProbeKind::Load, c.probes[0].body = "block";
  Simulation<2> simulation(c, created<2>(c));
  const double weight = 600 * 0.2 * 0.1 * 10;
  double force = 0, height = 0;
  for (int k = 0; k < 1000; ++k) {
    const StepReport report = simulation.advance();
    force += report.loads[0].force[1] / 1000, height += report.rigid[1].center[1] / 1000;
    ASSERT_LT(std::abs(report.rigid[1].center[1] - 0.19), 1.5 * c.spacing);
  }
  EXPECT_NEAR(force, weight, 0.01 * weight);
  EXPECT_NEAR(height, 0.19, 0.5 * c.spacing);
  EXPECT_LT(std::abs(simulation.particles().rigid.bodies[1].spin[2]), 0.1);
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
void checkContinuedBodies(Case c) {
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
  checkContinuedBodies<2>(blockCase(2, 300));
  checkContinuedBodies<3>(blockCase(3, 3000));
  checkContinuedBodies<2>(withIsph(blockCase(2, 300), 1e-3));
  checkContinuedBodies<2>(withIsph(blockCase(2, 300), 5));
  checkContinuedBodies<3>(withIsph(blockCase(3, 3000), 1e-3));
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
void checkFall(const Case& c, int steps, double tall) {
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
  checkFall<2>(fallingBlockCase(2, 0), 16, 4e-3);
  checkFall<2>(fallingBlockCase(2, 30), 60, 4e-3);
  checkFall<3>(fallingBlockCase(3, 0), 16, 4e-3);
}

TEST(RigidBodies, RestOnAFloorWithoutFluidBetweenInIsph) {
  checkFall<2>(withIsph(fallingBlockCase(2, 0), 5), 16, 4e-3);
  checkFall<2>(withIsph(fallingBlockCase(2, 30), 5), 60, 4e-3);
  checkFall<3>(withIsph(fallingBlockCase(3, 0), 5), 16, 4e-3);
}

TEST(RigidBodies, RestOnAFloorFarFromFluid) {
  checkFall<2>(withDistantFluid(fallingBlockCase(2, 0)), 16, 4e-3);
  checkFall<2>(withDistantFluid(fallingBlockCase(2, 30)), 60, 4e-3);
  checkFall<3>(withDistantFluid(fallingBlockCase(3, 0)), 16, 4e-3);
  checkFall<2>(withDistantFluid(withIsph(fallingBlockCase(2, 30), 5)), 60, 4e-3);
}

/// Automatic steps see the block come, and do not lead it through the floor.
TEST(RigidBodies, FallOntoAFloorInAutomaticSteps) {
  Case c = withDistantFluid(fallingBlockCase(2, 0));
  c.bodies[1].shape.transform.reset();
  c.bodies[1].shape.min[1] += 20e-3, c.bodies[1].shape.max[1] += 20e-3;
  c.time.automatic = true, c.time.tolerance = 0.02;
  c.time.step = 20e-3, c.time.least = 1e-6, c.time.end = 0.08;
  c.bodies[1].velocity = {0, -2, 0};
  c.gravity = {};  // the fluid rests and asks for no short steps
  Simulation<2> simulation(c, created<2>(c));
  double least = 1;
  while (!c.atEnd(simulation.step(), simulation.time())) {
    simulation.advance();
    least = std::min(least, gapToFloor(c, simulation));
  }
  EXPECT_GT(least, -0.02 * c.spacing);
  EXPECT_NEAR(simulation.particles().rigid.bodies[1].center[1], -6e-3, 0.05 * c.spacing);
}

/// A block that may go along the floor alone, which is turned by a rounding error. Friction has no hold there:
/// what presses the block onto the floor is what locks it.
TEST(RigidBodies, SlideAlongWallsThatStandAskewByRounding) {
  Case c = slopeCase(2, 0.1, 0.5);
  c.bodies[1].rigid.translates = {true, false, false};
  c.bodies[1].rigid.rotates = {false, false, false};
  c.bodies[2].shape.transform = Transform{};
  c.bodies[2].shape.transform->angle = 360;
  for (const Case& slide : {c, withIsph(c, 5)}) {
    Simulation<2> simulation(slide, created<2>(slide));
    for (int k = 0; k < 5; ++k) simulation.advance();
    EXPECT_NEAR(simulation.particles().rigid.bodies[1].velocity[0], 5e-3 * c.gravity[0], 1e-3 * 5e-3);
  }
}

/// What touches it there points at its axis, but for rounding. The fluid on both sides of it has the same weight.
TEST(RigidBodies, RestOnAHingeAboveAFloor) {
  Case c = blockCase(2, 1400);
  c.gravity = {0, -10, 0};
  Body &pool = c.bodies[0], &rotor = c.bodies[1];
  rotor.name = "rotor";
  rotor.shape = {};
  rotor.shape.kind = ShapeKind::Sphere;
  rotor.shape.center = {0, 10e-3, 0}, rotor.shape.radius = 10e-3;
  rotor.rigid.hinge.emplace().point = rotor.shape.center;
  pool.shape.min = {-20e-3, 0, 0}, pool.shape.max = {20e-3, 20e-3, 0};
  pool.where.clear(), pool.subtract = {"rotor"};
  Body floor;
  floor.name = "floor", floor.kind = BodyKind::Wall;
  floor.shape.kind = ShapeKind::Polygon;
  floor.shape.points = {{-20e-3, -4e-3}, {20e-3, -4e-3}, {20e-3, 0}, {-20e-3, 0}};
  c.bodies.push_back(floor);
  Simulation<2> simulation(c, created<2>(c));
  for (int k = 0; k < 5; ++k) simulation.advance();
  EXPECT_LT(std::abs(simulation.particles().rigid.bodies[1].spin[2]), 1e-3);
}

/// They go on together, and what one loses the other gets.
TEST(RigidBodies, DoNotGoThroughEachOther) {
  const Case heavy = meetingBlocksCase(7000, 7000), light = meetingBlocksCase(7000, 500);
  for (const Case& c : {heavy, light, withIsph(heavy, 5), withIsph(light, 1e-3), withDistantFluid(light)}) {
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
