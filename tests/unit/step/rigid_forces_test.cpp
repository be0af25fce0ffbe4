#include "support/rigid_cases.hpp"
#include "support/state_of.hpp"
#include "treacle/model/case/case_error.hpp"
#include "treacle/model/case/checks.hpp"
#include "treacle/step/run/simulation.hpp"
#include "unit/model/sample_case.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

namespace treacle::test {
namespace {

/// A block that touches nothing, far from a puddle that hardly moves.
template <int D>
Case freeBlock(double density = 2000) {
  Case c = emptyCase(D);
  c.spacing = 1e-3;
  c.domain = {{-0.1, -0.06, -0.1}, {0.1, 0.06, 0.1}, {false, false, false}};
  c.materials = {{"pitch", 1000, 1e3, 1e5, 1e6}, {"steel", density, 1e3, 1e5, 1e6}};
  c.time = {1e-3, 1};
  const auto at = [](double x, double y, double z) { return D == 2 ? Vec<3>{x, y, 0} : Vec<3>{x, y, z}; };
  c.bodies = {makeBody("puddle", BodyKind::Fluid, box(at(-0.09, -0.055, 0), at(-0.086, -0.053, 0.004))),
              makeBody("block", BodyKind::Rigid, box(at(-3e-3, -2e-3, -2e-3), at(3e-3, 2e-3, 2e-3))),
              makeBody("floor", BodyKind::Wall, box(at(-0.1, -0.059, -0.01), at(-0.07, -0.055, 0.014)))};
  c.bodies[1].material = 1;
  return c;
}

template <int D, class Look>
void run(const Case& c, int steps, Look&& look) {
  Simulation<D> simulation(c, created<D>(c));
  for (int k = 0; k < steps; ++k) {
    const StepReport report = simulation.advance();
    look(report.rigid[1], report.time);
  }
}

TEST(RigidForces, MoveTheirCentre) {
  Case c = freeBlock<2>();
  const double mass = 2000 * 24e-6;
  c.bodies[1].rigid.force[0] = TimeFunction{.value = 2 * mass};
  c.bodies[1].rigid.force[1] = TimeFunction{.expression = "0.1*cos(20*t)"};
  run<2>(c, 100, [&](const RigidBody& b, double t) {
    // The first step has a whole one of acceleration.
    EXPECT_NEAR(b.velocity[0], 2 * t, 1e-9);
    EXPECT_NEAR(b.center[0], t * (t + 1e-3), 1e-9);
    EXPECT_NEAR(b.center[1], 0.1 / mass * ((1 - std::cos(20 * t)) / 400 + 0.5e-3 * t), 1e-6);
    EXPECT_EQ(b.spin[2], 0);
  });
}

/// Where neither gravity nor the start tells how large the velocities are.
TEST(RigidForces, MoveBodiesInFluidWithoutGravity) {
  Case c = blockCase(3, 1100);
  c.spacing = 2e-3;
  c.domain = {{-0.02, -0.02, -0.02}, {0.02, 0.02, 0.02}, {}};
  for (Material& m : c.materials) m.dynamicViscosity = 0.4;
  const double inner = 10e-3, outer = 18e-3;
  c.bodies[0].shape.min = {-inner, -inner, -inner}, c.bodies[0].shape.max = {inner, inner, inner};
  c.bodies[0].where = "max(abs(x), abs(y), abs(z)) > 4e-3";
  c.bodies[1].shape.min = {-4e-3, -4e-3, -4e-3}, c.bodies[1].shape.max = {4e-3, 4e-3, 4e-3};
  c.bodies.push_back(makeBody("cup", BodyKind::Wall, box({-outer, -outer, -outer}, {outer, outer, outer})));
  c.bodies[2].where = "max(abs(x), abs(y), abs(z)) > 10e-3";
  c.gravity = {};
  c.bodies[1].rigid.force[2] = TimeFunction{.value = -1e-3};
  Simulation<3> simulation(c, created<3>(c));
  for (int k = 0; k < 3; ++k) EXPECT_LT(simulation.advance().rigid[1].velocity[2], -1e-4);
}

TEST(RigidForces, TurnThem) {
  Case c = freeBlock<2>();
  const double inertia = 2000 * 24e-6 * (36e-6 + 16e-6) / 12;
  c.bodies[1].rigid.torque[2] = TimeFunction{.value = 50 * inertia};
  c.bodies[1].rigid.angularDamping = 10 * inertia;  // 5 rad/s in the end
  run<2>(c, 400, [&](const RigidBody& b, double t) {
    EXPECT_NEAR(b.spin[2], 5 * (1 - std::exp(-10 * t)), 0.03);
    EXPECT_LE(norm(b.velocity), 1e-12);
  });
}

/// Stiff springs, too, keep their energy.
TEST(RigidForces, OfSpringsSwingForEver) {
  for (const double period : {0.1, 4e-3}) {
    Case c = freeBlock<2>();
    const double mass = 2000 * 24e-6, omega = 2 * std::numbers::pi / period, x0 = 1e-3;
    c.bodies[1].rigid.springs = {
        {.name = "spring", .anchor = {0.02 - x0, 0, 0}, .length = 0.02, .stiffness = mass * omega * omega}};
    double most = 0, least = 0, late = 0;
    int crossings = 0;
    double before = 1, firstCrossing = 0, lastCrossing = 0;
    run<2>(c, 600, [&](const RigidBody& b, double t) {
      const double x = b.center[0] + x0;  // from where the spring has no load
      most = std::max(most, x), least = std::min(least, x);
      if (t > 0.5) late = std::max(late, std::abs(x));
      if (before > 0 && x <= 0) {
        lastCrossing = t - 1e-3 * x / (x - before);
        if (crossings++ == 0) firstCrossing = lastCrossing;
      }
      before = x;
    });
    const double first = period > 0.05 ? 0.05 * x0 : 0.3 * x0;  // the first step goes a whole one
    EXPECT_NEAR(most, x0, first);
    EXPECT_NEAR(least, -x0, first);
    EXPECT_GT(late, 0.9 * x0);
    if (period > 0.05) {
      EXPECT_NEAR((lastCrossing - firstCrossing) / (crossings - 1), period, 1e-3 * period);
    }
  }
}

/// Two blocks, the second three times as heavy, on a spring that holds them off their centres by `off`.
Case springCase(double off) {
  Case c = freeBlock<2>();
  Body other = c.bodies[1];
  other.name = "other";
  other.shape.min[0] += 0.04, other.shape.max[0] += 0.04;
  other.rigid.mass = 3 * 2000 * 24e-6;
  c.bodies.push_back(other);
  const double omega = 2 * std::numbers::pi / 0.1;
  c.bodies[1].rigid.springs = {{.name = "spring",
                                .to = "other",
                                .anchor = {0, off, 0},
                                .arm = {0, -off, 0},
                                .length = 0.038,
                                .stiffness = 0.75 * 2000 * 24e-6 * omega * omega}};
  return c;
}

TEST(RigidForces, OfSpringsBetweenBodiesAreOppositeAndEqual) {
  const Case c = springCase(1e-3);
  Simulation<2> simulation(c, created<2>(c));
  double turned = 0;
  for (int k = 0; k < 200; ++k) {
    const StepReport report = simulation.advance();
    const RigidBody &a = report.rigid[1], &b = report.rigid[3];
    EXPECT_LE(norm(a.mass * a.velocity + b.mass * b.velocity), 1e-9 * a.mass);
    const Vec<3> parts = a.inertia[2] * a.spin + b.inertia[2] * b.spin,
                 ways = a.mass * cross(a.center, a.velocity) + b.mass * cross(b.center, b.velocity);
    EXPECT_NEAR(parts[2] + ways[2], 0, 0.02 * a.inertia[2]);  // by steps in time
    turned = std::max(turned, std::abs(a.spin[2]));
  }
  EXPECT_GT(turned, 0.5);
}

/// With the frequency of their reduced mass.
TEST(RigidForces, OfASpringBetweenBodiesSwings) {
  const Case c = springCase(0);
  Simulation<2> simulation(c, created<2>(c));
  double least = 1, most = -1, first = 0, last = 0, before = 1;
  int crossings = 0;
  for (int k = 0; k < 400; ++k) {
    const StepReport report = simulation.advance();
    const double apart = norm(report.rigid[3].center - report.rigid[1].center) - 0.038;
    least = std::min(least, apart), most = std::max(most, apart);
    if (before > 0 && apart <= 0) {
      last = report.time - 1e-3 * apart / (apart - before);
      if (crossings++ == 0) first = last;
    }
    before = apart;
  }
  ASSERT_GE(crossings, 3);
  EXPECT_NEAR((last - first) / (crossings - 1), 0.1, 1e-3 * 0.1);
  EXPECT_NEAR(most, 2e-3, 0.1e-3);
  EXPECT_NEAR(least, -2e-3, 0.1e-3);
}

TEST(RigidForces, SpringsGoToOtherRigidBodies) {
  Case c = freeBlock<3>();
  const auto message = [&](const char* to) {
    c.bodies[1].rigid.springs = {{.name = "spring", .to = to}};
    try {
      requireValid(c);
    } catch (const CaseError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_THAT(message("floor"), testing::HasSubstr("expected the name of a rigid body, found 'floor'"));
  EXPECT_THAT(message("block"), testing::HasSubstr("expected another body, found that of the spring"));
}

TEST(RigidForces, OfASpringOffTheCentreTurnThem) {
  Case c = freeBlock<2>();
  const double mass = 2000 * 24e-6;
  c.bodies[1].rigid.springs = {{.name = "spring",
                                .anchor = {3e-3, 0.03, 0},
                                .arm = {3e-3, 2e-3, 0},
                                .length = 0.028,
                                .stiffness = 1e3 * mass,
                                .damping = 20 * mass}};
  c.bodies[1].rigid.damping = 8 * mass, c.bodies[1].rigid.angularDamping = 2e-6;
  c.gravity = {0, -10, 0};
  Simulation<2> simulation(c, created<2>(c));
  for (int k = 0; k < 1500; ++k) simulation.advance();
  // It hangs below the anchor, its corner 10 mm lower than without a load, its centre below that.
  const RigidBody b = simulation.particles().rigid.bodies[1];
  const Vec<3> corner = b.center + turnedBy(b.orientation, {3e-3, 2e-3, 0});
  EXPECT_NEAR(norm(corner - Vec<3>{3e-3, 0.03, 0}), 0.038, 2e-4);
  EXPECT_NEAR(b.center[0], 3e-3, 1.5e-3);
  EXPECT_LT(b.center[1], corner[1]);
}

/// A pendulum keeps its energy and its distance from the hinge.
template <int D>
void checkPendulum() {
  Case c = freeBlock<D>();
  c.gravity = {0, -10, 0};
  Hinge& hinge = c.bodies[1].rigid.hinge.emplace();
  hinge.point = {-0.03, 0, 0}, hinge.axis = {0, 0, 3};
  double mass = 0, inertia = 0, highest = -1, fastest = 0;
  run<D>(c, D == 2 ? 800 : 260, [&](const RigidBody& b, double) {
    mass = b.mass, inertia = b.inertia[2];
    EXPECT_NEAR(norm(b.center - hinge.point), 0.03, 1e-12);
    EXPECT_NEAR(b.center[2], 0, 1e-15);
    highest = std::max(highest, b.center[0] < -0.03 ? b.center[1] : -1.0);
    fastest = std::max(fastest, std::abs(b.spin[2]));
  });
  const double about = inertia + mass * 9e-4;
  EXPECT_NEAR(fastest, std::sqrt(2 * mass * 10 * 0.03 / about), 0.01 * fastest);
  EXPECT_NEAR(highest, 0, 5e-4) << "as high on the other side";
}

TEST(RigidForces, LetAPendulumSwing) {
  checkPendulum<2>();
  checkPendulum<3>();
}

TEST(RigidForces, LetGoWhenTheCaseSays) {
  Case c = freeBlock<2>();
  c.gravity = {0, -10, 0};
  c.bodies[1].rigid.release = 0.05;
  run<2>(c, 100, [&](const RigidBody& b, double t) {
    const double fallen = std::max(0.0, t - 0.05);
    EXPECT_NEAR(b.center[1], -5 * fallen * fallen, 1e-2 * fallen + 1e-15);
  });
}

TEST(RigidForces, LockedBodiesStay) {
  Case c = freeBlock<2>();
  c.gravity = {0, -10, 0};
  c.bodies[1].rigid.translates = {false, false, false};
  c.bodies[1].rigid.rotates = {false, false, false};
  run<2>(c, 3, [](const RigidBody& b, double) { EXPECT_LE(norm(b.center), 1e-18); });
}

/// Of two blocks that meet, and of one that rests on a floor, which does not dance.
TEST(RigidForces, BounceByTheirRestitution) {
  for (const double e : {0.0, 0.5, 0.9}) {
    Case c = meetingBlocksCase(7000, 3500);
    c.bodies[1].restitution = 1, c.bodies[2].restitution = e * e;
    Simulation<2> simulation(c, created<2>(c));
    double before = 0, apart = -1;
    for (int k = 0; k < 30 && apart < 0; ++k) {
      const StepReport report = simulation.advance();
      apart = report.rigid[2].velocity[0] - report.rigid[1].velocity[0];
      if (apart < -0.1) before = apart;
    }
    EXPECT_NEAR(apart, -e * before, 0.02 * 0.75) << e;
    EXPECT_LT(before, -0.5);
  }
  Case c = slopeCase(2, 0, 0);
  c.bodies[1].restitution = c.bodies[2].restitution = 0.9;
  Simulation<2> simulation(c, created<2>(c));
  for (int k = 0; k < 30; ++k) EXPECT_LT(norm(simulation.advance().rigid[1].velocity), 1e-3);
}

/// Wherever a body goes, its particles are around its centre.
TEST(RigidForces, ParticlesStayAroundTheCentre) {
  Case c = freeBlock<2>();
  c.bodies[1].velocity = {0.1, 0, 0};
  c.bodies[1].rigid.angularVelocity = {0, 0, 10};
  Simulation<2> simulation(c, created<2>(c));
  for (int k = 0; k < 500; ++k) simulation.advance();
  const Particles<2> p = stateOf(simulation);
  Vec<2> sum{};
  int count = 0;
  for (std::uint32_t i = p.wallBegin(); i < p.count; ++i)
    if (p.body[i] == 1) sum += p.position[i], ++count;
  EXPECT_LE(norm(resized<3>(sum) * (1.0 / count) - p.rigid.bodies[1].center), 1e-12);
}

}  // namespace
}  // namespace treacle::test
