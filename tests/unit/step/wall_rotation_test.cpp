#include "support/isph_cases.hpp"
#include "support/state_of.hpp"
#include "treacle/core/pseudo_random.hpp"
#include "treacle/model/motion/wall_motion.hpp"

#include <gtest/gtest.h>
#include <omp.h>

namespace treacle::test {
namespace {

constexpr double pi = 3.14159265358979323846;

/// x turned by an angle about an axis through c, by quaternions.
Vec<3> turned(const Vec<3>& x, const Vec<3>& c, const Vec<3>& axis, double angle) {
  const double s = std::sin(angle / 2) / norm(axis);
  const Vec<3> v = s * axis, d = x - c;
  const auto cross = [](const Vec<3>& a, const Vec<3>& b) {
    return Vec<3>{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  };
  const Vec<3> t = 2.0 * cross(v, d);
  return c + d + std::cos(angle / 2) * t + cross(v, t);
}

Body rotor(const Vec<3>& center, const Vec<3>& axis, double speed) {
  Body body;
  body.kind = BodyKind::Wall;
  body.rotation = Rotation{center, axis, speed};
  return body;
}

const Domain open{{-10, -10, -10}, {10, 10, 10}, {}};

TEST(WallRotation, StaysOnItsCircleOverManySteps) {
  const Body body = rotor({0.3, -0.2, 0}, {0, 0, 1}, 2.5);
  const Vec<2> center{0.3, -0.2}, start{1.3, 0.7};
  Vec<2> x = start;
  const double dt = 4e-3;
  double farthest = 0;
  for (int k = 0; k < 100000; ++k) {
    x += dt * wallMotion<2>(open, body, k * dt, dt).chordAt(x);
    farthest = std::max(farthest, std::abs(norm(x - center) / norm(start - center) - 1));
  }
  EXPECT_LE(farthest, 2e-13);
  const Vec<3> end = turned(resized<3>(start), {0.3, -0.2, 0}, {0, 0, 1}, 1000);
  EXPECT_LE(norm(x - resized<2>(end)), 1e-11) << "after 159 turns";
}

TEST(WallRotation, IsCounterClockwiseInThePlane) {
  const WallMotion<2> m = wallMotion<2>(open, rotor({1, 1}, {0, 0, 1}, 3), 0, 0.1);
  EXPECT_EQ(m.velocityAt({2, 1}), (Vec<2>{0, 3}));
  EXPECT_EQ(m.velocityAt({1, 2}), (Vec<2>{-3, 0}));
  EXPECT_EQ(m.velocityAt({1, 1}), (Vec<2>{0, 0}));
}

/// A rotor that is carried along, about an axis askew, with steps of unequal length.
TEST(WallRotation, GoesAlongWithTranslationAndOscillation) {
  Body body = rotor({0.1, 0.2, -0.3}, {1, -2, 0.5}, -7);
  body.velocity = {0.3, 0, -0.1};
  body.oscillation = {{0.05, 0.2, 0}, 0.7, 0.4};
  const Oscillation& o = body.oscillation;
  const Vec<3> start{0.9, -0.4, 0.2};
  Vec<3> x = start;
  double t = 0;
  for (int k = 0; k < 1000; ++k) {
    const double dt = 0.01 * (1 + 0.5 * pseudoRandom(k));
    x += dt * wallMotion<3>(open, body, t, dt).chordAt(x);
    t += dt;
    const Vec<3> way =
        t * body.velocity + (std::sin(2 * pi * t / o.period + o.phase) - std::sin(o.phase)) * o.amplitude;
    ASSERT_LE(norm(x - turned(start, body.rotation->center, body.rotation->axis, -7 * t) - way), 1e-13);
  }
}

/// The fluid's velocity and acceleration at a particle of the wall are the derivatives of its way.
TEST(WallRotation, VelocityAndAccelerationAreThoseOfTheWay) {
  Body body = rotor({0.1, 0.2, -0.3}, {1, -2, 0.5}, -7);
  body.velocity = {0.3, 0, -0.1};
  body.oscillation = {{0.05, 0.2, 0}, 0.7, 0.4};
  const Vec<3> x{0.9, -0.4, 0.2};
  const double t = 0.4, e = 1e-4;
  const auto way = [&](double dt) { return dt * wallMotion<3>(open, body, t, dt).chordAt(x); };
  const WallMotion<3> m = wallMotion<3>(open, body, t, 0);
  EXPECT_LE(norm(m.velocityAt(x) - (1 / (2 * e)) * (way(e) - way(-e))), 2e-6);
  EXPECT_LE(norm(m.accelerationAt(x) - (1 / (e * e)) * (way(e) + way(-e))), 1e-5);
}

TEST(WallRotation, TurnsAboutTheNearestImageOfItsCentre) {
  Body body = rotor({0.9, 0.5}, {0, 0, 1}, 2);
  body.velocity = {0.5, 0, 0};
  const Domain periodic{{0, 0}, {1, 1}, {true, false, false}};
  // After 0.4 s the centre is at x = 1.1, which is 0.1.
  const WallMotion<2> m = wallMotion<2>(periodic, body, 0.4, 0.01);
  for (const Vec<2>& d : {Vec<2>{0.05, 0.3}, Vec<2>{-0.2, -0.1}}) {
    Vec<2> x = Vec<2>{0.1, 0.5} + d;
    x[0] -= std::floor(x[0]);
    EXPECT_LE(norm(m.velocityAt(x) - Vec<2>{0.5 - 2 * d[1], 2 * d[0]}), 1e-14);
  }
}

/// Fluid in a ring that rotates about its centre, all of them as one rigid body. Without gravity.
Case ringCase(MethodKind method, double hole) {
  constexpr double radius = 10, wall = 4, speed = 2;
  Case c = waterCase(2, Vec<3>::filled(40));
  const Vec<3> center{0.2, 0.2, 0};
  c.gravity = {};
  c.method.kind = method;
  if (method == MethodKind::MphI) {
    c.materials[0] = {"syrup", 1000, 10, 1e4, 1e5};
    c.solver = {};
  }
  Body fluid, ring = rotor(center, {0, 0, 1}, speed);
  fluid.name = "fluid", ring.name = "ring";
  for (Body* b : {&fluid, &ring}) b->shape.kind = ShapeKind::Sphere, b->shape.center = center;
  fluid.shape.radius = ring.shape.innerRadius = radius * c.spacing;
  fluid.shape.innerRadius = hole * c.spacing;
  ring.shape.radius = (radius + wall) * c.spacing;
  fluid.velocityExpression = {"-2*(y - 0.2)", "2*(x - 0.2)", ""};
  c.bodies = {fluid, ring};
  return c;
}

/// Largest |u - omega x (x - c)| of fluid and walls [m/s], where they were dt ago.
double awayFromRigid(const Particles<2>& p, double dt) {
  double most = 0;
  for (std::uint32_t i = 0; i < p.count; ++i) {
    const Vec<2> d = p.position[i] - dt * p.velocity[i] - Vec<2>{0.2, 0.2};
    most = std::max(most, norm(p.velocity[i] - Vec<2>{-2 * d[1], 2 * d[0]}));
  }
  return most;
}

TEST(WallRotation, ParticlesStartWithTheRigidMotion) {
  EXPECT_LE(awayFromRigid(created<2>(ringCase(MethodKind::MphI, 0)), 0), 1e-15);
}

TEST(WallRotation, SyrupInARotatingRingRotatesWithIt) {
  // What is not rigid comes of the fluid's straight steps, and is of first order in them.
  for (const double dt : {2e-3, 1e-3}) {
    Case c = ringCase(MethodKind::MphI, 0);
    c.time.step = dt;
    c.solver.tolerance = 1e-20;
    Simulation<2> simulation(c, created<2>(c));
    const double energy = simulation.diagnostics().kineticEnergy;
    while (simulation.time() < 0.04 - 1e-9) simulation.advance();
    // Velocities are those of the middle of the step.
    EXPECT_LE(awayFromRigid(simulation.particles(), 0.5 * dt), 0.25 * dt * 4 * 0.14)
        << "a quarter of omega^2 r dt";
    EXPECT_NEAR(simulation.diagnostics().kineticEnergy / energy, 1, 2e-4);
  }
}

/// Sum of the pressures of particles from `least` to `most` from the centre, over that of a spinning annulus,
/// rho omega^2 (r^2 - r0^2) / 2.
double pressureRatio(const Particles<2>& p, std::uint32_t begin, std::uint32_t end, double least, double most) {
  double found = 0, expected = 0;
  for (std::uint32_t i = begin; i < end; ++i) {
    const double r = norm(p.position[i] - Vec<2>{0.2, 0.2});
    if (r < least || r > most) continue;
    found += p.pressure[i];
    expected += 1000 * 4 * (r * r - 0.04 * 0.04) / 2;
  }
  return found / expected;
}

TEST(WallRotation, WaterInARotatingRingIsHeldByItsPressure) {
  Case c = ringCase(MethodKind::Isph, 4);
  c.time.step = 2e-3;
  Simulation<2> simulation(c, created<2>(c));
  const double energy = simulation.diagnostics().kineticEnergy;
  for (int k = 0; k < 50; ++k) simulation.advance();
  const Particles<2>& p = simulation.particles();
  // Measured: 0.0163, 0.0073 and 0.0011.
  EXPECT_NEAR(pressureRatio(p, 0, p.fluidCount, 0.07, 1), 1, 0.02);
  EXPECT_NEAR(pressureRatio(p, p.fluidCount, p.count, 0, 0.115), 1, 0.012) << "the ring's own acceleration counts";
  EXPECT_NEAR(simulation.diagnostics().kineticEnergy / energy, 1, 0.0015);
}

TEST(WallRotation, WallsOfASimulationStayOnTheirCircles) {
  for (const MethodKind method : {MethodKind::MphI, MethodKind::Isph}) {
    Case c = ringCase(method, 4);
    c.bodies[1].velocity = {0.05, -0.02, 0};
    c.time.courant = 0.3;
    Particles<2> p = created<2>(c);
    const Particles<2> start = copyOf(p);
    Simulation<2> simulation(c, std::move(p));
    for (int k = 0; k < 20; ++k) simulation.advance();
    const double t = simulation.time();
    const Particles<2>& now = simulation.particles();
    for (std::uint32_t i = now.fluidCount; i < now.count; ++i) {
      const Vec<3> x = turned(resized<3>(start.position[now.id[i]]), {0.2, 0.2, 0}, {0, 0, 1}, 2 * t);
      ASSERT_LE(norm(now.position[i] - resized<2>(x + t * c.bodies[1].velocity)), 1e-14);
    }
  }
}

TEST(WallRotation, ResultsDependNeitherOnThreadsNorOnInterruptions) {
  for (const MethodKind method : {MethodKind::MphI, MethodKind::Isph}) {
    Case c = ringCase(method, 4);
    c.bodies[1].oscillation = {{0.002, 0, 0}, 0.1, 0.3};
    const auto after = [&](int threads, int interruption) {
      omp_set_num_threads(threads);
      Simulation<2> first(c, created<2>(c));
      for (int k = 0; k < interruption; ++k) first.advance();
      Particles<2> state;
      first.copyParticles(state);
      Simulation<2> second(c, std::move(state), first.step(), first.time());
      for (int k = interruption; k < 6; ++k) second.advance();
      omp_set_num_threads(1);
      return stateOf(second);
    };
    const Particles<2> expected = after(1, 6);
    EXPECT_TRUE(sameBits(expected, after(1, 4)));
    EXPECT_TRUE(sameBits(expected, after(3, 6)));
  }
}

}  // namespace
}  // namespace treacle::test
