#include "support/isph_cases.hpp"
#include "support/rigid_cases.hpp"
#include "support/ring_in_drum.hpp"
#include "treacle/model/case/case_keys.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace treacle::test {
namespace {

constexpr double turning = 10;  // [rad/s]

/// MPH-I with a fluid that is elastic for the most part.
Case elastic(Case c) {
  Material& m = c.materials[0];
  m.dynamicViscosity = 2;
  m.elastic = {{.name = "polymer", .model = ElasticModel::OldroydB, .viscosity = 8, .relaxationTime = 2e-3}};
  return c;
}

/// ISPH with an explicit or an implicit viscous step.
Case isph(Case c, bool implicit) {
  c = withIsph(std::move(c), 1);
  c.time.step = implicit ? 5e-4 : 1e-4;
  c.method.isph.viscosity = implicit ? ViscousStep::Implicit : ViscousStep::Explicit;
  return c;
}

/// A drum full of fluid, which turns with it.
Case fullDrum() {
  Case c = ringInDrum();
  c.bodies[0].shape.innerRadius = 0;
  c.bodies[0].velocityExpression = {"-10*y", "10*x", ""};
  c.bodies[1].rotation = Rotation{{}, {0, 0, 1}, turning};
  return c;
}

/// Angular momentum over that of a rigid body.
double meanTurning(const Particles<2>& p) {
  double momentum = 0, inertia = 0;
  for (std::uint32_t i = 0; i < p.fluidCount; ++i) {
    const Vec<2>& x = p.position[i];
    momentum += x[0] * p.velocity[i][1] - x[1] * p.velocity[i][0], inertia += norm2(x);
  }
  return momentum / (turning * inertia);
}

/// With the wall's velocity where its particles are, in place of its surface: 1.02 to 1.05.
void checkFullDrum(const Case& c, const char* what) {
  Simulation<2> simulation(c, created<2>(c));
  while (simulation.time() < 0.05) simulation.advance();
  EXPECT_NEAR(meanTurning(simulation.particles()), 1, 0.003) << what;
}

TEST(TurningWalls, CarryTheirFluidAlongAsFastAsTheyTurn) {
  checkFullDrum(elastic(fullDrum()), "elastic");
  checkFullDrum(isph(fullDrum(), true), "implicit");
  checkFullDrum(isph(fullDrum(), false), "explicit");
}

/// Between a cylinder that turns and a drum at rest, the torque of both is that of the exact flow.
void checkTorques(Case c, const char* what) {
  Body inner = c.bodies[1];
  inner.name = "cylinder", inner.shape.radius = c.bodies[0].shape.innerRadius = 0.01;
  inner.shape.innerRadius = 0, inner.rotation = Rotation{{}, {0, 0, 1}, turning};
  c.bodies.push_back(inner);
  for (const char* name : {"drum", "cylinder"}) {
    c.probes.emplace_back();
    c.probes.back().name = name, c.probes.back().body = name, c.probes.back().kind = ProbeKind::Load;
  }
  const double viscosity =
      c.materials[0].dynamicViscosity + (c.materials[0].elastic.empty() ? 0 : c.materials[0].elastic[0].viscosity);
  const double exact = 4 * std::numbers::pi * viscosity * turning * 4e-4 * 1e-4 / (4e-4 - 1e-4);
  Simulation<2> simulation(c, created<2>(c));
  double drum = 0, cylinder = 0, power = 0, steps = 0;
  while (simulation.time() < 0.08) {
    const StepReport report = simulation.advance();
    if (simulation.time() < 0.05) continue;
    drum += report.loads[0].torque[2], cylinder += report.loads[1].torque[2], power += report.loads[1].power;
    steps += 1;
  }
  EXPECT_NEAR(drum / steps / exact, 1, 0.08) << what << ", drum";
  EXPECT_NEAR(cylinder / steps / exact, -1, 0.08) << what << ", cylinder";
  EXPECT_NEAR(power / (cylinder * turning), 1, 0.01) << what;
}

/// Where friction acted at wall particles, without the stress that turning makes, the cylinder had 0.6 of its
/// torque by implicit steps of ISPH.
TEST(TurningWalls, BearTheTorqueOfTheFlow) {
  checkTorques(elastic(ringInDrum()), "elastic");
  checkTorques(isph(ringInDrum(), true), "implicit");
  checkTorques(isph(ringInDrum(), false), "explicit");
}

}  // namespace
}  // namespace treacle::test
