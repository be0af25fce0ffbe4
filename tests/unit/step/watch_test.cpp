#include "treacle/step/run/watch.hpp"
#include "support/isph_cases.hpp"
#include "support/scene.hpp"
#include "treacle/core/error.hpp"
#include "treacle/model/case/case_keys.hpp"
#include "treacle/model/particles/create.hpp"
#include "treacle/step/run/simulation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "unit/model/sample_case.hpp"

namespace treacle::test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

using Warnings = std::vector<std::string>;

/// Spacing 1 m, steps of 1 ms, gravity of 10 m/s2 down.
Case fallingCase(MethodKind method = MethodKind::MphI) {
  Case c = emptyCase(2);
  c.gravity[1] = -10;
  c.method = defaultMethod(SchemeKind::Published);
  c.method.kind = method;
  return c;
}

constexpr double mass = 2, particles = 200, dt = 1e-3;  // kg, -, s; settling: 20 J by height, 100 J by speed

/// After a step in which the fluid has fallen by so much.
Diagnostics energies(double kinetic, double fallen) {
  Diagnostics d;
  d.kineticEnergy = kinetic, d.gravityPower = fallen / dt;
  return d;
}

template <class F>
std::string failureOf(F&& f) {
  try {
    f();
  } catch (const RunError& error) {
    return error.what();
  }
  return "no failure";
}

TEST(Watch, NamesTheKeyThatBoundsTheSteps) {
  for (const bool automatic : {false, true}) {
    Case c = fallingCase();
    c.time.automatic = automatic;
    c.watch.courant = 1;
    const Watch watch(c, {}, mass, particles, false);
    EXPECT_THAT(failureOf([&] { watch.requireSlow(dt, 5e3); }),
                HasSubstr(automatic ? "take time.max_step <= 0.0001 or" : "take time.step <= 0.0001 or"));
  }
}

TEST(Watch, EnergyMayFallAndTurnIntoMotionButNotRise) {
  Watch watch(fallingCase(), {}, mass, particles, false);
  Warnings warnings;
  EXPECT_EQ(watch.look(dt, energies(3900, 4000), warnings).energy, 0);
  EXPECT_EQ(watch.look(dt, energies(0, 0), warnings).energy, 0) << "friction has taken it";
  EXPECT_NEAR(watch.look(dt, energies(41.2, 0), warnings).energy, 0.01, 1e-12) << "of 4000 + 120 J";
  EXPECT_NEAR(watch.look(dt, energies(0, -41.2), warnings).energy, 0.01, 1e-12) << "by rising";
  EXPECT_EQ(watch.look(dt, energies(0, 41.2), warnings).energy, 0);
  EXPECT_THAT(warnings, IsEmpty());
  watch.look(dt, energies(450, 0), warnings);
  EXPECT_THAT(warnings, ElementsAre(AllOf(HasSubstr("risen by 0.109 times"), HasSubstr("take time.step <= 0.0005"),
                                          HasSubstr("the run ends above watch.energy = 1"))));
  watch.look(dt, energies(890, 0), warnings);
  EXPECT_EQ(warnings.size(), 1u) << "not yet twice as much";
  watch.look(dt, energies(1000, 0), warnings);
  EXPECT_EQ(warnings.size(), 2u);
  EXPECT_THAT(failureOf([&] { watch.look(dt, energies(4200, 0), warnings); }),
              AllOf(HasSubstr("risen by 1.02 times"), HasSubstr("watch.energy = 1 is exceeded")));
}

TEST(Watch, WhatIsThereAtTheStartMayComeBack) {
  Diagnostics start = energies(300, 0);
  start.elasticEnergy = 580;  // and 120 J
  Watch watch(fallingCase(), start, mass, particles, false);
  Warnings warnings;
  watch.look(dt, energies(0, 0), warnings);
  EXPECT_NEAR(watch.look(dt, energies(90, 0), warnings).energy, 0.09, 1e-12);
  EXPECT_THAT(warnings, IsEmpty());
}

TEST(Watch, EnergyIsNotKnownWithMovingWalls) {
  Warnings warnings;
  EXPECT_EQ(Watch(fallingCase(), {}, mass, particles, true).look(dt, energies(1e9, 0), warnings).energy, 0);
  EXPECT_THAT(warnings, IsEmpty());
}

TEST(Watch, CourantNumberNamesTheStepThatWouldDo) {
  Diagnostics d;
  d.maxSpeed = 2600;
  Warnings warnings;
  Watch watch(fallingCase(), {}, mass, particles, true);
  EXPECT_DOUBLE_EQ(watch.look(dt, d, warnings).courant, 2.6);
  EXPECT_THAT(warnings, ElementsAre(AllOf(HasSubstr("2.6e+03 m/s, 2.6 spacings in a step of 0.001 s"),
                                          HasSubstr("time.step <= 0.00019 or time.courant = 0.5"))));
  d.maxSpeed = 10001;
  EXPECT_THAT(failureOf([&] { watch.look(dt, d, warnings); }), HasSubstr("watch.courant = 10 is exceeded"));
  warnings.clear();
  d.maxSpeed = 1001;
  watch.look(dt, d, warnings);
  EXPECT_THAT(warnings, IsEmpty());
  Watch(fallingCase(MethodKind::Isph), {}, mass, particles, true).look(dt, d, warnings);
  EXPECT_THAT(warnings, ElementsAre(HasSubstr("1 spacings")));
}

TEST(Watch, AnUnstableMaterialIsNamed) {
  Case c = fallingCase();
  c.materials[0].bulkModulus = 2e7;
  Diagnostics d;
  d.maxSpeed = 11000;
  Warnings warnings;
  EXPECT_THAT(
      failureOf([&] { Watch(c, {}, mass, particles, true).look(dt, d, warnings); }),
      HasSubstr("take bulk_modulus <= bulk_viscosity / step = 1e+07 for 'syrup', or time.step <= 0.0005 "));
  c.method = defaultMethod(SchemeKind::Accurate);
  EXPECT_THAT(
      failureOf([&] { Watch(c, {}, mass, particles, true).look(dt, d, warnings); }),
      HasSubstr("take bulk_modulus <= 0.5 bulk_viscosity / step = 5e+06 for 'syrup', or time.step <= 0.00025 "));
  c.materials[0].bulkViscosity = 0;
  EXPECT_THAT(failureOf([&] { Watch(c, {}, mass, particles, true).look(dt, d, warnings); }),
              HasSubstr("give 'syrup' a bulk_viscosity of at least bulk_modulus times the step = 2e+04"));
}

TEST(Watch, ParticlesInsideWallsAndDensitiesThatAreOff) {
  Diagnostics d;
  d.insideWalls = 2, d.excessDensity = 0.11;
  Warnings warnings;
  Watch watch(fallingCase(), {}, mass, particles, true);
  watch.look(dt, d, warnings);
  EXPECT_THAT(warnings, ElementsAre(HasSubstr("2 of 200 fluid particles are inside walls"),
                                    HasSubstr("density of the fluid is off by 11 %")));
  d.insideWalls = 11;
  EXPECT_THAT(failureOf([&] { watch.look(dt, d, warnings); }), HasSubstr("watch.inside_walls = 0.05 is exceeded"));
  // The volume tells nothing where few particles are inside.
  d.insideWalls = 0, d.excessDensity = 0, d.meanDensityError = 0.6, d.interiorParticles = 0.2 * particles;
  watch.look(dt, d, warnings);
  d.interiorParticles = 0.6 * particles;
  EXPECT_THAT(failureOf([&] { watch.look(dt, d, warnings); }), HasSubstr("watch.density = 0.25 is exceeded"));
}

TEST(Watch, ABoundHoldsSoonAfterAWarning) {
  Diagnostics d;
  d.excessDensity = 0.24;
  Warnings warnings;
  Watch watch(fallingCase(), {}, mass, particles, true);
  watch.look(dt, d, warnings);
  EXPECT_EQ(warnings.size(), 1u);
  d.excessDensity = 0.26;  // not twice as much
  EXPECT_THAT(failureOf([&] { watch.look(dt, d, warnings); }), HasSubstr("watch.density = 0.25 is exceeded"));
}

TEST(Watch, ABoundOfZeroIsNone) {
  Case c = fallingCase();
  c.watch = {0, 0, 0, 0};
  Diagnostics d = energies(1e9, 1e9);
  d.maxSpeed = 1e9, d.insideWalls = 100, d.excessDensity = 1e9;
  Warnings warnings;
  Watch(c, {}, mass, particles, false).look(dt, d, warnings);
  EXPECT_THAT(warnings, IsEmpty());
}

/// Fluid on a floor, and some that stands in the middle of the floor.
template <int D>
void checkInside(MethodKind method, SchemeKind scheme) {
  SCOPED_TRACE(testing::Message() << D << "D " << static_cast<int>(method) << ' ' << nameOf(scheme));
  Case c = emptyCase(D);
  c.method = method == MethodKind::Isph ? MethodSettings{} : defaultMethod(scheme);
  c.method.kind = method, c.solver = defaultSolver(method);
  c.time.step = 1e-6;
  Vec<3> high{8, 5}, low{-7, -7}, wide{15, 0}, inside{3.5, -3.5};
  if (D == 3) high = {6, 6, 5}, low = {-5, -5, -7}, wide = {11, 11, 0}, inside = {2.5, 2.5, -3.5};
  c.bodies = {makeBody("water", BodyKind::Fluid, box({}, high)),
              makeBody("floor", BodyKind::Wall, box(low, wide))};
  std::vector<std::string> notes;
  AnyParticles made = createParticles(c, notes);
  Particles<D> p = std::move(made.of<D>());
  Simulation<D> fine(c, [&] {
    std::vector<std::string> again;
    return std::move(createParticles(c, again).template of<D>());
  }());
  EXPECT_EQ(fine.advance().diagnostics.insideWalls, 0);
  p.position[0] = resized<D>(inside);
  Simulation<D> simulation(c, std::move(p));
  const StepReport report = simulation.advance();
  EXPECT_EQ(report.diagnostics.insideWalls, 1);
  EXPECT_DOUBLE_EQ(report.watched.insideWalls, 1.0 / simulation.particles().fluidCount);
}

TEST(Watch, CountsParticlesInsideWalls) {
  for (const SchemeKind scheme : bothSchemes) {
    checkInside<2>(MethodKind::MphI, scheme);
    checkInside<3>(MethodKind::MphI, scheme);
  }
  checkInside<2>(MethodKind::Isph, SchemeKind::Published);
  checkInside<3>(MethodKind::Isph, SchemeKind::Published);
}

TEST(Watch, TheStateBeforeTheStepIsKept) {
  Scene<2> s = makeScene<2>();
  for (std::uint32_t i = 0; i < s.particles.fluidCount; ++i)
    s.particles.velocity[i] = {20 * s.c.spacing / s.c.time.step, 0};
  std::vector<Vec<2>> before(s.particles.count);
  for (std::uint32_t i = 0; i < s.particles.count; ++i) before[s.particles.id[i]] = s.particles.position[i];
  Simulation<2> simulation(s.c, std::move(s.particles));
  EXPECT_THAT(failureOf([&] { simulation.advance(); }), HasSubstr("watch.courant"));
  EXPECT_EQ(simulation.step(), 0);
  EXPECT_EQ(simulation.time(), 0);
  const Particles<2>& p = simulation.particles();
  for (std::uint32_t i = 0; i < p.count; ++i) ASSERT_EQ(p.position[i], before[p.id[i]]);
}

}  // namespace
}  // namespace treacle::test
