#include "support/deep_layer.hpp"
#include "support/same_bits.hpp"
#include "support/state_of.hpp"
#include "treacle/mph/pressure_stiffness.hpp"
#include "treacle/step/run/simulation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace treacle::test {
namespace {

using testing::ElementsAre, testing::HasSubstr, testing::IsEmpty;

/// The largest speed in steps 100 to 150 [m/s]; `density`: of the last of them.
template <int D>
double speedAtRest(const Case& c, double& density) {
  Simulation<D> s(c, created<D>(c));
  double most = 0;
  for (int step = 0; step < 150; ++step) {
    const StepReport report = s.advance();
    if (step >= 100) most = std::max(most, report.diagnostics.maxSpeed);
    density = report.diagnostics.meanDensityRatio;
  }
  return most;
}

template <int D>
void expectRest(const Case& c, double speed) {
  double density = 0;
  EXPECT_LT(speedAtRest<D>(c, density), speed);
  EXPECT_NEAR(density, 1, 0.01);
}

/// Without the stiffness these runs end, because particles leave their places and the density rises.
TEST(LongSteps, LeaveFluidAtRest) {
  expectRest<2>(deepLayer(2), 1e-4);
  expectRest<3>(deepLayer(3), 1e-4);
  Case c = deepLayer(2);
  c.time.step = 0.1;
  expectRest<2>(c, 1e-4);
}

TEST(LongSteps, LeaveFluidWithARheologyAtRest) {
  Case c = deepLayer(2);
  c.materials[0].rheology = {
      .model = RheologyModel::Cross, .flowIndex = 0.5, .zeroViscosity = 1, .timeConstant = 0.1};
  expectRest<2>(c, 1e-4);
}

TEST(LongSteps, LetAirCarrySyrup) { expectRest<2>(layerOnAir(2), 1e-3); }

TEST(LongSteps, LeaveFluidInAFullVesselAtRest) {
  Case c = fullVessel(2);
  c.method.backgroundPressure = 150;
  expectRest<2>(c, 1e-4);
}

/// A column that spreads is where it would be with short steps.
TEST(LongSteps, DoNotHoldFluidBackThatFlows) {
  const auto front = [](double step) {
    Case c = deepLayer(2);
    c.domain.min[0] = -0.04, c.domain.max[0] = 0.06;
    c.domain.periodic = {};
    c.bodies[1].shape.min[0] = -0.04, c.bodies[1].shape.max[0] = 0.06;
    c.materials[0].dynamicViscosity = 10;
    c.materials[0].bulkViscosity = 2e4;
    c.gravity[1] = -98.1;
    c.time.step = step;
    Simulation<2> s(c, created<2>(c));
    double x = 0;
    while (s.time() < 0.1 - step / 2) x = s.advance().diagnostics.frontX;
    return x - 0.02;
  };
  const double exact = front(5e-4);
  EXPECT_GT(exact, 5e-3);
  EXPECT_NEAR(front(5e-3), exact, 0.05 * exact);
}

/// A cylinder little heavier than the thin oil in which it settles.
Case settlingCylinder() {
  Case c;
  c.dimensions = 2;
  c.spacing = 2e-3;
  c.domain = {{-0.012, -0.012, 0}, {0.056, 0.13, 0}, {}};
  c.gravity = {0, -9.81, 0};
  c.materials = {
      {.name = "oil", .density = 960, .dynamicViscosity = 0.058, .bulkViscosity = 4e3, .bulkModulus = 2e5}};
  c.materials.push_back(c.materials[0]);
  c.materials[1].name = "nylon", c.materials[1].density = 1010;
  const auto box = [](const char* name, BodyKind kind, const Vec<3>& min, const Vec<3>& max) {
    Body body;
    body.name = name, body.kind = kind;
    body.shape.min = min, body.shape.max = max;
    return body;
  };
  c.bodies = {box("oil", BodyKind::Fluid, {}, {0.044, 0.11, 0}), box("cylinder", BodyKind::Rigid, {}, {}),
              box("floor", BodyKind::Wall, {-0.008, -0.008, 0}, {0.052, 0, 0}),
              box("left", BodyKind::Wall, {-0.008, 0, 0}, {0, 0.12, 0}),
              box("right", BodyKind::Wall, {0.044, 0, 0}, {0.052, 0.12, 0})};
  c.bodies[0].where = "(x - 0.02)^2 + (y - 0.06)^2 > 0.007501^2";
  c.bodies[1].material = 1;
  c.bodies[1].shape.kind = ShapeKind::Sphere;
  c.bodies[1].shape.center = {0.02, 0.06, 0}, c.bodies[1].shape.radius = 0.0075;
  c.time = {4e-3, 0.16};
  return c;
}

/// With what a step tries for the body in place of its last velocity it goes at 1.3 m/s after ten steps.
TEST(LongSteps, LeaveABodyThatSettlesStable) {
  const Case c = settlingCylinder();
  Simulation<2> s(c, created<2>(c));
  StepReport report;
  for (int k = 0; k < 40; ++k) report = s.advance();
  EXPECT_LT(report.diagnostics.maxSpeed, 0.02);
  EXPECT_LT(report.rigid[1].velocity[1], 0) << "it sinks";
}

/// Of the first 40 steps of a run to `end` [s].
std::vector<std::string> warningsOf(Case c, double end) {
  c.time.end = end;
  Simulation<2> s(c, created<2>(c));
  std::vector<std::string> all;
  for (int k = 0; k < 40; ++k)
    for (const std::string& text : s.advance().warnings) all.push_back(text);
  return all;
}

TEST(LongSteps, GiveAWarningWhereFluidFlows) {
  Case c = deepLayer(2);
  c.time.step = 0.04;
  c.gravity[0] = 0.1;
  EXPECT_THAT(warningsOf(c, 20), ElementsAre(HasSubstr("steps of 0.04 s are long for the pressure")));
  EXPECT_THAT(warningsOf(c, 2000), IsEmpty()) << "they are too small a part of the run";
  c.gravity[0] = 0;
  EXPECT_THAT(warningsOf(c, 20), IsEmpty()) << "it rests";
}

TEST(LongSteps, ContinueWithTheSameBits) {
  const Case c = deepLayer(2);
  Simulation<2> whole(c, created<2>(c));
  for (int k = 0; k < 7; ++k) whole.advance();
  Simulation<2> resumed(c, stateOf(whole), whole.step(), whole.time());
  for (int k = 0; k < 5; ++k) whole.advance(), resumed.advance();
  expectSameBits(stateOf(whole), stateOf(resumed));
}

/// The viscosity of a particle of 1000 kg/m3 and 1 Pa s under `pressure` [Pa] in a step of 1 ms.
double stiffnessUnder(double pressure, double viscosity = 1) {
  Case c = deepLayer(2);
  c.materials[0].dynamicViscosity = viscosity;
  Context<Cpu> context;
  const std::vector<std::uint8_t> material{0};
  std::vector<double> result(1);
  const StiffFluid fluid = setStiffness(context, StiffnessTerms{StiffMaterials::make(c),
                                                                {},
                                                                StiffnessLimits::of(2.5),
                                                                c.spacing,
                                                                1e-3,
                                                                material,
                                                                {},
                                                                {&pressure, 1},
                                                                result});
  EXPECT_EQ(fluid.particles, result[0] > 0 ? 1 : 0);
  EXPECT_EQ(fluid.way, PressedParticle({1000, viscosity, c.spacing, 1e-3}).way(std::max(pressure, 0.0)));
  return result[0];
}

TEST(LongSteps, StiffnessBeginsAtHalfOfWhatParticlesBear) {
  const double most = 0.4 * (1000 * 4e-6 / 1e-3 + 2.5) / 1e-3;  // [Pa]
  EXPECT_EQ(stiffnessUnder(-most), 0);
  EXPECT_EQ(stiffnessUnder(0.499 * most), 0);
  EXPECT_NEAR(stiffnessUnder(0.75 * most), 0.5 * 0.75 * most * 1e-3 / (2.5 * 0.15), 1e-9);
  EXPECT_NEAR(stiffnessUnder(2 * most), 2 * most * 1e-3 / (2.5 * 0.15), 1e-9);
  EXPECT_EQ(stiffnessUnder(2 * most, 0), 0) << "there is no viscosity to add to";
}

}  // namespace
}  // namespace treacle::test
