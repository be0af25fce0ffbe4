#include "treacle/model/case/checks.hpp"
#include "treacle/model/case/case_keys.hpp"
#include "treacle/model/case/flow_scales.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sample_case.hpp"
#include "support/sample_mesh.hpp"

#include <cmath>
#include <numbers>

namespace treacle::test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

Case damBreak() {
  Case c = emptyCase(2);
  c.spacing = 1e-3;
  c.gravity = {0, -10};
  c.bodies = {makeBody("column", BodyKind::Fluid, box({0, 0}, {20e-3, 20e-3})),
              makeBody("floor", BodyKind::Wall, box({0, -10e-3}, {40e-3, 0}))};
  return c;
}

TEST(courantNumber, seesNozzlesAndJumpsOfFormulas) {
  Case c = damBreak();
  Body& jet = c.bodies.emplace_back(makeBody("jet", BodyKind::Inflow, {}));
  jet.inflow.speed = TimeFunction{7};
  jet.inflow.nozzle.kind = NozzleKind::Rectangle;
  jet.inflow.nozzle.center = {10e-3, 50e-3}, jet.inflow.nozzle.direction = {0, -1}, jet.inflow.nozzle.width = 5e-3;
  EXPECT_NEAR(courantNumber(c), 7, 1e-12);
  EXPECT_THAT(caseWarnings(c), testing::Contains(HasSubstr("the Courant number of steps of 0.001 s is 7,")));
  c.bodies.pop_back();
  c.bodies[1].displacement[0] = TimeFunction{.expression = "t > 0.01234 ? 2e-3 : 0"};
  EXPECT_NEAR(courantNumber(c), 2, 1e-9);
  c.bodies[1].displacement[0] = TimeFunction{.expression = "1e-3*sin(100*t)"};
  EXPECT_LT(courantNumber(c), 1);
}

TEST(caseWarnings, tellOfSpringsWithoutEffect) {
  Case c = damBreak();
  c.bodies[1].kind = BodyKind::Rigid;
  c.bodies[1].rigid.springs = {{.name = "left", .damping = 1}, {.name = "right"}};
  EXPECT_THAT(caseWarnings(c),
              testing::Contains("spring 'right' of body 'floor' is without effect: its stiffness and "
                                "damping are 0"));
  EXPECT_THAT(caseWarnings(c), testing::Not(testing::Contains(HasSubstr("spring 'left'"))));
}

TEST(stabilityNumbers, areThoseOfThePaper) {  // [K23 Table 2], case x1
  const auto numbers = stabilityNumbers(damBreak());
  ASSERT_EQ(numbers.size(), 1u);
  EXPECT_EQ(numbers[0].material, "syrup");
  EXPECT_DOUBLE_EQ(numbers[0].compression, 0.1);
  EXPECT_DOUBLE_EQ(numbers[0].shearDiffusion, 10);
  EXPECT_DOUBLE_EQ(numbers[0].bulkDiffusion, 1e4);
}

TEST(courantNumber, takesTheFastestOfFallFluidAndWalls) {
  Case c = damBreak();
  EXPECT_NEAR(courantNumber(c), std::sqrt(2 * 10 * 20e-3), 1e-12);
  c.bodies[0].velocity = {3, 4};
  EXPECT_NEAR(courantNumber(c), 5, 1e-12);
  c.bodies[1].velocity = {0, -6};
  EXPECT_NEAR(courantNumber(c), 6, 1e-12);
  c = damBreak();
  c.gravity = {-10 * std::sqrt(0.5), -10 * std::sqrt(0.5)};  // along the diagonal of the column
  EXPECT_NEAR(courantNumber(c), std::sqrt(2 * 10 * 20e-3 * std::sqrt(2.0)), 1e-12);
}

TEST(courantNumber, takesTheFastestParticleWhereVelocitiesAreExpressions) {
  Case c = damBreak();
  c.bodies[0].velocityExpression = {"1e3*x*3", "1e3*x*4", ""};
  EXPECT_NEAR(courantNumber(c), 5 * 19.5, 1e-9);
  c.bodies[0].where = "x < 8e-3";
  EXPECT_NEAR(courantNumber(c), 5 * 7.5, 1e-9);
}

TEST(courantNumber, takesTheTopSpeedOfAnOscillation) {
  Case c = damBreak();
  c.bodies[1].oscillation = {{0.3, 0.4}, 2 * std::numbers::pi / 10, 1};
  EXPECT_NEAR(courantNumber(c), 5, 1e-12);
  c.bodies[1].velocity = {3, 0};
  EXPECT_NEAR(courantNumber(c), 8, 1e-12);
}

TEST(courantNumber, takesTheFastestPointOfARotatingWall) {
  Case c = damBreak();
  c.bodies[1].rotation = Rotation{{0, 0}, {0, 0, 1}, -1000};
  EXPECT_NEAR(courantNumber(c), std::hypot(39.5, 9.5), 1e-9);
  c.bodies[1].velocity = {3, 4};
  EXPECT_NEAR(courantNumber(c), 5 + std::hypot(39.5, 9.5), 1e-9);
  c.dimensions = 3;
  c.bodies[0].shape.max[2] = c.bodies[1].shape.max[2] = c.domain.max[2] = 2e-3;
  c.bodies[1].rotation->axis = {-2, 0, 0};
  EXPECT_NEAR(courantNumber(c), 5 + std::hypot(9.5, 1.5), 1e-9);
}

TEST(courantNumber, takesTheFastestPointOfARotatingNozzle) {
  Case c = damBreak();
  c.bodies.push_back(makeBody("jet", BodyKind::Inflow, {}));
  c.bodies[2].inflow.nozzle.center = {0, 30e-3, 0};
  c.bodies[2].inflow.nozzle.direction = {1, 0, 0};
  c.bodies[2].inflow.nozzle.radius = 2e-3;
  c.bodies[2].inflow.speed = TimeFunction{1};
  c.bodies[2].rotation = Rotation{.center = {}, .speed = 1000};
  EXPECT_NEAR(courantNumber(c), std::hypot(31.5, 3.5), 1e-9);
}

TEST(courantNumber, isBoundedWhereItLimitsTheSteps) {
  Case c = damBreak();
  c.bodies[0].velocity = {3, 4};
  c.time.courant = 0.2;
  EXPECT_EQ(courantNumber(c), 0.2);
  c.time.courant = 20;
  EXPECT_NEAR(courantNumber(c), 5, 1e-12);
}

/// ISPH knows neither bulk modulus nor bulk viscosity; what stands there counts for nothing.
Case isphDamBreak() {
  Case c = damBreak();
  c.method.kind = MethodKind::Isph;
  c.materials[0].bulkModulus = 1, c.materials[0].bulkViscosity = 0;
  c.time.step = 1e-4;
  return c;
}

TEST(stabilityNumbers, haveNoCompressionForIsph) {
  const auto numbers = stabilityNumbers(isphDamBreak());
  EXPECT_EQ(numbers[0].compression, 0);
  EXPECT_DOUBLE_EQ(numbers[0].shearDiffusion, 1);
}

TEST(caseWarnings, numbersThatNoMaterialHas) {
  Case c = damBreak();
  const std::size_t before = caseWarnings(c).size();
  c.materials[0].density = 1e-20;
  EXPECT_THAT(caseWarnings(c),
              testing::Contains(testing::HasSubstr("has density = 1e-20 kg/m3; fluids and solids have "
                                                   "0.01 to 30000: is it in SI units?")));
  c = damBreak();
  c.bodies.back().oscillation = {{1e-6, 0, 0}, 5 * c.time.step, 0};
  EXPECT_THAT(caseWarnings(c), testing::Contains(testing::HasSubstr(" s, 5 steps of ")));
  c.bodies.back().oscillation.period = 20 * c.time.step;
  EXPECT_EQ(caseWarnings(c).size(), before);
}

TEST(caseWarnings, temperaturesBeyondTheTableOfAViscosity) {
  Case c = damBreak();
  c.heat.emplace();
  ViscosityShift& shift = c.materials[0].viscosityShift.emplace();
  shift.model = ShiftModel::Table, shift.temperatures = {300, 350, 400}, shift.factors = {10, 3, 1};
  Body &fluid = c.bodies[0], &wall = c.bodies[1];
  fluid.temperature = 400, wall.temperature = 300;
  EXPECT_THAT(caseWarnings(c), IsEmpty());
  fluid.temperature = 60, wall.temperature = 450;
  const std::string given = "viscosity_shift of material 'syrup' is cut off: it is given from 300 to 400 K";
  EXPECT_THAT(caseWarnings(c), ElementsAre("body '" + fluid.name + "' has temperature = 60 K, where " + given +
                                               ". Are these degrees Celsius? Expected kelvin, 333.15",
                                           "body '" + wall.name + "' has temperature = 450 K, where " + given));
  // A law is cut off at walls where it is meant to be.
  shift.model = ShiftModel::Vft, shift.reference = 350, shift.slope = 1000, shift.divergence = 200;
  fluid.temperature = 350, wall.temperature = 100;
  EXPECT_THAT(caseWarnings(c), IsEmpty());
  fluid.temperature = 210;
  EXPECT_THAT(caseWarnings(c), ElementsAre(HasSubstr("it is given for factors from 1e-06 to 1e+06")));
}

TEST(caseWarnings, wallsThatTablesMoveTooFast) {
  Case c = damBreak();
  TimeFunction& x = c.bodies[1].displacement[0].emplace();
  const double spacings = c.spacing / c.time.step;  // one in a step [m/s]
  x.times = {0, 0.1, 0.11}, x.values = {0, 0, 0.5 * spacings * 0.01};
  c.time.end = 0.2;
  EXPECT_THAT(caseWarnings(c), IsEmpty());
  x.values.back() *= 8;
  EXPECT_THAT(caseWarnings(c), ElementsAre(HasSubstr("is 4, more than 1")));
  c.time.end = 0.1;
  EXPECT_THAT(caseWarnings(c), IsEmpty());
  c.bodies[1].displacement = {};
  Rotation& r = c.bodies[1].rotation.emplace();
  r.axis = {0, 0, 1};
  r.angle.emplace().expression = "5*t^2";
  const double before = flowScales(c).given;
  c.time.end = 0.2;
  EXPECT_NEAR(flowScales(c).given, 2 * before, 2e-3 * before);
}

TEST(caseWarnings, noneForTheIsphDamBreak) { EXPECT_THAT(caseWarnings(isphDamBreak()), IsEmpty()); }

TEST(caseWarnings, longStepsOfIsph) {
  Case c = isphDamBreak();
  c.bodies[0].velocity = {5.1, 0};
  EXPECT_THAT(caseWarnings(c), ElementsAre(HasSubstr("Courant number of steps of 0.0001 s is 0.51")));
  c.time.courant = 0.25;
  EXPECT_THAT(caseWarnings(c), IsEmpty());
  c.time.courant = 0;
  c.method.kind = MethodKind::MphI;
  c.materials[0].bulkViscosity = c.materials[0].dynamicViscosity = 1e12;  // carries anything
  EXPECT_THAT(caseWarnings(c), IsEmpty());
  c.bodies[0].velocity = {10.1, 0};
  EXPECT_THAT(caseWarnings(c), ElementsAre(AllOf(HasSubstr("is 1.01, more than 1: particles may pass each other"),
                                                 HasSubstr("steps of at most 9.9e-05 s, or let time.courant"))));
  c.bodies[0].velocity = {};
  c.bodies[1].velocity = {0, 20};
  EXPECT_THAT(caseWarnings(c), ElementsAre(HasSubstr("is 2, more than 1")));
  c.bodies[1].velocity = {};
  c.gravity[1] = -1e6;  // how fast a viscous fluid falls is not known
  EXPECT_THAT(caseWarnings(c), ElementsAre(HasSubstr("gravity.acceleration is 1e+06 m/s2")));
}

TEST(caseWarnings, wallsThinnerThanTheReachOfTheKernel) {
  Case c = isphDamBreak();
  c.bodies[1].shape = box({0, -2.4e-3}, {40e-3, 0});
  EXPECT_THAT(caseWarnings(c), IsEmpty());
  c.method.isph.smoothingRatio = 1.3;
  EXPECT_THAT(
      caseWarnings(c),
      ElementsAre("wall 'floor' is 2.4 mm thick along y, thinner than the reach 2 h of the kernel = 2.6 mm "
                  "(2.6 spacings): fluid next to it misses neighbours"));
  c = damBreak();
  c.method.pressureRadius = 11;
  EXPECT_THAT(caseWarnings(c), ElementsAre(HasSubstr("pressure radius h_p = 11 mm (11 spacings)")));
}

TEST(Case, radiiFollowFromTheMethod) {
  Case c = damBreak();
  EXPECT_DOUBLE_EQ(c.interactionRadius(), 3.5e-3);
  EXPECT_DOUBLE_EQ(c.searchEdge(), 5e-3);
  c.method.viscosityRadius = 2;
  EXPECT_DOUBLE_EQ(c.interactionRadius(), 3.5e-3);
  c.method.densityRadius = 5.5;
  EXPECT_DOUBLE_EQ(c.interactionRadius(), 5.5e-3);
  EXPECT_DOUBLE_EQ(c.searchEdge(), 5.5e-3);
  c.method = defaultMethod(SchemeKind::Published);
  EXPECT_DOUBLE_EQ(c.interactionRadius(), 3.5e-3);
  EXPECT_DOUBLE_EQ(c.searchEdge(), 3.5e-3);
  c.method.viscosityRadius = 1;
  EXPECT_DOUBLE_EQ(c.interactionRadius(), 1.75e-3);
  c.method.kind = MethodKind::Isph;
  EXPECT_DOUBLE_EQ(c.interactionRadius(), 2.4e-3);
  EXPECT_DOUBLE_EQ(c.searchEdge(), 2.4e-3);
}

TEST(Case, endsAfterItsStepsOrWhereTheyVaryAtItsTime) {
  Case c = damBreak();
  EXPECT_FALSE(c.atEnd(199, 1));
  EXPECT_TRUE(c.atEnd(200, 0));
  c.time.courant = 0.2;
  EXPECT_FALSE(c.atEnd(10000, 0.2 * (1 - 1e-8)));
  EXPECT_TRUE(c.atEnd(1, 0.2 * (1 - 1e-10)));
}

TEST(caseWarnings, noneForTheDamBreak) { EXPECT_THAT(caseWarnings(damBreak()), IsEmpty()); }

TEST(caseWarnings, unstableCompression) {
  Case c = damBreak();
  c.method = defaultMethod(SchemeKind::Published);
  c.materials[0].bulkModulus = 1e4 / 1e-3;  // exactly lambda / dt
  EXPECT_THAT(caseWarnings(c), IsEmpty());
  c.materials[0].bulkModulus *= 1.1;
  EXPECT_THAT(caseWarnings(c),
              ElementsAre(AllOf(
                  HasSubstr("material 'syrup': dt kappa / lambda = 1.1 is greater than 1"),
                  HasSubstr("take bulk_modulus <= bulk_viscosity / step, or a step of at most 0.000909 s"))));
  c.materials[0].bulkViscosity = 0;
  EXPECT_THAT(caseWarnings(c), ElementsAre(AllOf(HasSubstr("dt kappa / lambda = inf"),
                                                 HasSubstr("give it a bulk_viscosity of at least"))));
}

/// That of a handbook needs a bulk viscosity that holds back the flow.
TEST(caseWarnings, bulkModulusOfAHandbook) {
  Case c = damBreak();
  c.materials[0].autoBulkViscosity = true;
  c.materials[0].bulkModulus = 2.2e9, c.materials[0].bulkViscosity = 8.8e6;
  EXPECT_THAT(
      caseWarnings(c),
      ElementsAre(AllOf(HasSubstr("its bulk viscosity of 8.8e+06 Pa s is 8.8e+05 times its viscosity, which "
                                  "steps of 0.001 s need with bulk_modulus = 2.2e+09 Pa"),
                        HasSubstr("take bulk_modulus = 2e+05"))));
  c.materials[0].autoBulkViscosity = false;
  EXPECT_THAT(caseWarnings(c), ElementsAre(HasSubstr("take bulk_viscosity = 1e+04, 1000 times the viscosity")));
  c.materials[0].bulkModulus = 1e7, c.materials[0].bulkViscosity = 1e5;
  EXPECT_THAT(caseWarnings(c), IsEmpty());
}

TEST(caseWarnings, compressionWhereDensitiesReachFartherThanDivergences) {
  Case c = damBreak();
  c.materials[0].bulkModulus = 0.5 * 1e4 / 1e-3;
  EXPECT_THAT(caseWarnings(c), IsEmpty());
  c.materials[0].bulkModulus *= 1.6;
  EXPECT_THAT(
      caseWarnings(c),
      ElementsAre(AllOf(HasSubstr("dt kappa / lambda = 0.8 is greater than 0.5"),
                        HasSubstr("bulk_modulus <= 0.5 bulk_viscosity / step, or a step of at most 0.000625 s"))));
  c.method.pressureRadius = 3.5;
  EXPECT_THAT(caseWarnings(c), IsEmpty());
}

TEST(caseWarnings, stepsThatAreLongForASurfaceTension) {
  Case c = damBreak();
  Material& fluid = c.materials[0];
  fluid.surfaceTension = 2 * fluid.dynamicViscosity * c.spacing / c.time.step;
  EXPECT_THAT(caseWarnings(c), IsEmpty());
  fluid.surfaceTension *= 1.25;
  const std::string most = fmt::format("take time.step <= {:.2g}", 0.8 * c.time.step);
  EXPECT_THAT(caseWarnings(c), ElementsAre(AllOf(HasSubstr("long for its surface tension"), HasSubstr(most))));
  fluid.dynamicViscosity = 0;
  fluid.surfaceTension = fluid.density * std::pow(c.spacing, 3) / (c.time.step * c.time.step);
  EXPECT_THAT(caseWarnings(c), IsEmpty());
}

/// A fluid of 1 kg/m3 and 1e-3 Pa s that another one of 20 mm and 1000 kg/m3 lies on.
Case heavyOnLight() {
  Case c = damBreak();
  c.method = defaultMethod(SchemeKind::Published);
  c.materials.push_back({"gas", 1, 1e-3, 1e4, 1e6});
  c.bodies[0].name = "above";
  c.bodies[0].shape = box({0, 10e-3}, {20e-3, 30e-3});
  c.bodies.push_back(makeBody("below", BodyKind::Fluid, box({0, 0}, {20e-3, 10e-3})));
  c.bodies.back().material = 1;
  return c;
}

TEST(caseWarnings, keysOfFluidsOnWallsAndOfWallsOnFluids) {
  Case c = damBreak();
  c.materials.push_back(c.materials[0]);
  c.materials[1].name = "steel";
  c.bodies[1].material = 1;
  Material &fluid = c.materials[0], &wall = c.materials[1];
  fluid.surfaceTension = 0.07, wall.contactAngle = 60, wall.contactAngles = {{"syrup", 40}};
  EXPECT_THAT(caseWarnings(c), IsEmpty());
  fluid.surfaceTension = 0;
  EXPECT_THAT(caseWarnings(c), ElementsAre("material 'steel' has contact_angle without effect: no fluid has a "
                                           "surface_tension"));
  std::swap(fluid.contactAngle, wall.contactAngle), std::swap(fluid.contactAngles, wall.contactAngles);
  wall.surfaceTension = 0.07, wall.emissivity = 0.9;
  c.heat.emplace();
  EXPECT_THAT(caseWarnings(c),
              ElementsAre("material 'syrup' has contact_angle without effect: no wall is made of it",
                          "material 'syrup' has contact_angles without effect: no wall is made of it",
                          "material 'steel' has surface_tension without effect: no fluid is made of it",
                          "material 'steel' has emissivity without effect: no fluid is made of it"));
}

TEST(caseWarnings, lightFluidsUnderHeavyOnes) {
  Case c = heavyOnLight();
  EXPECT_THAT(caseWarnings(c), ElementsAre(AllOf(HasSubstr("fluid 'below' is too light and too thin for"),
                                                 HasSubstr("a pressure of 200 Pa can move its particles by 57.1"),
                                                 HasSubstr("take steps of at most 5.3e-05 s"),
                                                 HasSubstr("'gas' of at least 0.16 Pa s"))));
  c.time = {5.2e-5, 5.2e-2};
  EXPECT_THAT(caseWarnings(c), IsEmpty());
  c = heavyOnLight();
  c.materials[1].dynamicViscosity = 0.16;
  EXPECT_THAT(caseWarnings(c), IsEmpty());
  c = heavyOnLight();
  c.materials[1].density = 400;
  EXPECT_THAT(caseWarnings(c), IsEmpty());
  c = heavyOnLight();
  c.gravity = {0, 10};
  EXPECT_THAT(caseWarnings(c), IsEmpty()) << "the light one is above";
  c.gravity = {10, 0};
  EXPECT_THAT(caseWarnings(c), IsEmpty()) << "it stands beside";
  c.gravity = {};
  EXPECT_THAT(caseWarnings(c), IsEmpty());
  c = heavyOnLight();
  c.bodies[0].shape = box({20e-3, 10e-3}, {30e-3, 30e-3});
  EXPECT_THAT(caseWarnings(c), IsEmpty()) << "not over it";
  c = heavyOnLight();
  c.method.kind = MethodKind::Isph, c.time.step = 1e-4;
  EXPECT_THAT(caseWarnings(c), IsEmpty());
  c = heavyOnLight();
  c.method = defaultMethod(SchemeKind::Accurate);
  EXPECT_THAT(caseWarnings(c), IsEmpty()) << "its steps keep particles in their places";
  c.materials[1].dynamicViscosity = 0;
  EXPECT_THAT(caseWarnings(c), Contains(HasSubstr("is too light and too thin"))) << "by a viscosity";
}

TEST(longestStableStep, letsHeatSpreadWithAutomaticSteps) {
  Case c = damBreak();
  c.heat.emplace();
  c.materials[0].conductivity = 1000, c.materials[0].specificHeat = 100;
  EXPECT_DOUBLE_EQ(longestStableStep(c).length, 5e-3) << "steps that are given need not be told";
  c.time.automatic = true;
  const double length = flowScales(c).length;
  EXPECT_NEAR(longestStableStep(c).length, 0.003 * c.materials[0].density * 100 * length * length / 1000, 1e-12);
  EXPECT_EQ(longestStableStep(c).reason, "the conduction of heat in 'syrup'");
}

TEST(longestStableStep, isThatOfElasticPressuresAndOfLightFluids) {
  Case c = damBreak();
  EXPECT_DOUBLE_EQ(longestStableStep(c).length, 5e-3);
  EXPECT_EQ(longestStableStep(c).reason, "dt kappa / lambda of 'syrup'");
  c.method = defaultMethod(SchemeKind::Published);
  EXPECT_DOUBLE_EQ(longestStableStep(c).length, 1e-2);
  c.materials[0].bulkModulus = 0;
  EXPECT_TRUE(std::isinf(longestStableStep(c).length));
  c = heavyOnLight();
  EXPECT_EQ(longestStableStep(c).reason, "the heavier fluid on 'below'");
  const double length = longestStableStep(c).length;
  EXPECT_NEAR(length, 5.3e-5, 1e-6);
  c.time = {length, 1000 * length};
  EXPECT_THAT(caseWarnings(c), IsEmpty());
  c.time = {1.01 * length, 1010 * length};
  EXPECT_THAT(caseWarnings(c), ElementsAre(HasSubstr("is too light and too thin")));
}

TEST(setStepBounds, fillsInWhatTheCaseLeavesOpen) {
  Case c = damBreak();
  const TimeSettings fixed = c.time;
  setStepBounds(c);
  EXPECT_EQ(c.time, fixed) << "not automatic";
  c.time = {0, 0.2};
  c.time.automatic = true;
  Case open = c, shorter = c, given = c, stiff = c;
  setStepBounds(open);
  EXPECT_DOUBLE_EQ(open.time.step, 5e-3);
  EXPECT_DOUBLE_EQ(open.time.least, 5e-7);
  EXPECT_THAT(caseWarnings(open), IsEmpty());
  shorter.time.end = 1e-3;
  setStepBounds(shorter);
  EXPECT_EQ(shorter.time.step, 1e-3);
  given.time.step = 1e-2, given.time.least = 1e-3;
  setStepBounds(given);
  EXPECT_EQ(given.time.step, 1e-2);
  EXPECT_EQ(given.time.least, 1e-3);
  EXPECT_THAT(caseWarnings(given), ElementsAre(HasSubstr("dt kappa / lambda = 1 is greater than 0.5")));
  stiff.materials[0].bulkViscosity = 0;  // no step is stable: that is said in another place
  stiff.gravity = {};
  setStepBounds(stiff);
  EXPECT_EQ(stiff.time.step, 0.2);
  EXPECT_THAT(caseWarnings(stiff), ElementsAre(HasSubstr("give it a bulk_viscosity")));
}

TEST(courantNumber, isOneAtMostWithAutomaticSteps) {
  Case c = damBreak();
  c.time.automatic = true;
  c.bodies[0].velocity = {100, 0};
  EXPECT_EQ(courantNumber(c), 1);
  EXPECT_THAT(caseWarnings(c), IsEmpty());
  c.time.courant = 0.3;
  EXPECT_EQ(courantNumber(c), 0.3);
}

TEST(caseWarnings, fluidsTooSoftForTheirWeight) {
  Case c = damBreak();  // 200 Pa
  c.materials[0].bulkModulus = 2e3;
  EXPECT_THAT(caseWarnings(c), IsEmpty()) << "10 %";
  c.materials[0].bulkModulus = 1e3;
  EXPECT_THAT(caseWarnings(c), IsEmpty()) << "the bulk viscosity leaves it no time";
  c.materials[0].bulkViscosity = 100;
  EXPECT_THAT(
      caseWarnings(c),
      ElementsAre("fluid 'column' is too soft for the weight that it carries: 200 Pa may compress it by 20 "
                  "%; take a bulk_modulus of 'syrup' of at least 2e+03 Pa, and a bulk_viscosity of at "
                  "least 4 Pa s"));
  c.materials[0].bulkModulus = 0;
  EXPECT_THAT(caseWarnings(c), ElementsAre(HasSubstr("may compress it by 40 %")));
  c.materials[0].bulkViscosity = 1e4;
  EXPECT_THAT(caseWarnings(c), IsEmpty());
}

struct WallCase {
  Shape shape;
  const char* where;  // empty: thick enough
};

TEST(caseWarnings, wallsThinnerThanTheViscosityRadius) {  // h_v = 3.5
  for (const auto& [shape, where] :
       {WallCase{box({0, -3.5}, {40, 0}), ""}, WallCase{box({0, -3.4}, {40, 0}), "3.4 m thick along y"},
        WallCase{box({0, -9}, {3, 0}), "3 m thick along x"}, WallCase{sphere({0, 0}, 10, 6.5), ""},
        WallCase{sphere({0, 0}, 10, 7), "3 m thick between its radii"},
        WallCase{sphere({0, 0}, 1.5), "3 m thick across"},
        WallCase{cylinder({0, 0}, {2, 0}, 10), "2 m thick along its axis"}}) {
    Case c = emptyCase(2);
    c.bodies = {makeBody("wall", BodyKind::Wall, shape)};
    if (*where)
      EXPECT_THAT(caseWarnings(c), ElementsAre(AllOf(HasSubstr("wall 'wall' is "), HasSubstr(where),
                                                     HasSubstr("h_v = 3.5 m (3.5 spacings)"))));
    else
      EXPECT_THAT(caseWarnings(c), IsEmpty());
    c.bodies[0].kind = BodyKind::Fluid;
    EXPECT_THAT(caseWarnings(c), IsEmpty());
  }
}

TEST(caseWarnings, wallsThatLeaveTheDomain) {
  Case c = emptyCase(2);  // of 200 m
  c.time.end = 10;
  c.bodies = {makeBody("lid", BodyKind::Wall, box({-100, 0}, {90, 10}))};
  c.bodies[0].velocity = {1, 0, 0};
  EXPECT_THAT(caseWarnings(c), IsEmpty());
  c.bodies[0].velocity = {2, 0, 0};
  EXPECT_THAT(caseWarnings(c), ElementsAre(HasSubstr("wall 'lid' leaves the domain along x before t = 5.3 s")));
  c.domain.periodic[0] = true;
  EXPECT_THAT(caseWarnings(c), IsEmpty());
  c.bodies[0].velocity = {0, -20, 0};
  EXPECT_THAT(caseWarnings(c), ElementsAre(HasSubstr("leaves the domain along y before t = 5.05 s")));
}

TEST(caseWarnings, wallsThatTurnOutOfTheDomain) {
  Case c = emptyCase(2);  // of 200 m
  c.time.end = 10;
  c.bodies = {makeBody("door", BodyKind::Wall, box({-90, 0}, {90, 4}))};
  Rotation& rotation = c.bodies[0].rotation.emplace();
  rotation.center = {50, 0, 0}, rotation.speed = 0.01;
  EXPECT_THAT(caseWarnings(c), IsEmpty());
  rotation.speed = 0.1;
  const double t = std::asin(100 / std::hypot(139.5, 0.5)) + std::atan(0.5 / 139.5);
  EXPECT_THAT(caseWarnings(c),
              ElementsAre(HasSubstr(fmt::format("'door' leaves the domain along y before t = {:.3g} s",
                                                0.05 * std::ceil(t / 0.1 / 0.05)))));
  rotation.center = {0, 0, 0};
  EXPECT_THAT(caseWarnings(c), IsEmpty());
}

TEST(caseWarnings, meshesWithThinWalls) {
  const auto warnings = [](double thickness, FillKind fill, BodyKind kind) {  // of a pot without a lid
    Case c = emptyCase(3);
    const double t = thickness;
    c.bodies = {
        makeBody("pot", kind,
                 meshShape(turnedMesh({{0, 0}, {20 + t, 0}, {20 + t, 40}, {20, 40}, {20, t}, {0, t}}, 64), fill))};
    return caseWarnings(c);
  };
  EXPECT_THAT(warnings(3.6, FillKind::Inside, BodyKind::Wall), IsEmpty());
  EXPECT_THAT(
      warnings(0.2, FillKind::Inside, BodyKind::Wall),
      ElementsAre(AllOf(HasSubstr("wall 'pot': "),
                        HasSubstr("thinner than the viscosity radius h_v = 3.5 m, such as 199.759 mm at ("),
                        HasSubstr("spacing of at most 57.074 mm"))));
  EXPECT_THAT(warnings(0.2, FillKind::ThinSheet, BodyKind::Wall), IsEmpty());
  EXPECT_THAT(warnings(0.2, FillKind::Inside, BodyKind::Fluid), IsEmpty());
}

TEST(caseWarnings, frictionThatMeetsNone) {
  Case c = damBreak();
  c.bodies[1].friction = 0.3;
  EXPECT_THAT(caseWarnings(c),
              ElementsAre(HasSubstr("'floor' has friction = 0.3 without effect: no body is rigid")));
  c.bodies.push_back(makeBody("block", BodyKind::Rigid, box({25e-3, 0}, {35e-3, 10e-3})));
  EXPECT_THAT(caseWarnings(c),
              ElementsAre(HasSubstr("'floor' has friction = 0.3 without effect: no body that it can touch")));
  c.bodies[2].friction = 0.1;
  EXPECT_THAT(caseWarnings(c), IsEmpty());
}

TEST(caseWarnings, radiiThatAreShortForTheirScheme) {
  Case c = damBreak();
  c.method = defaultMethod(SchemeKind::Published);
  c.method.viscosityRadius = 1.5;
  EXPECT_THAT(caseWarnings(c), IsEmpty());
  c.method.pressureRadius = c.method.viscosityRadius = 1.4;  // without the neighbours on the diagonals
  EXPECT_THAT(caseWarnings(c),
              ElementsAre(HasSubstr("pressure_radius = 1.4 spacings is short for the scheme 'published'"),
                          HasSubstr("viscosity_radius = 1.4 spacings is short")));
  c.method = defaultMethod(SchemeKind::Accurate);
  c.method.viscosityRadius = 2;
  EXPECT_THAT(caseWarnings(c), IsEmpty());
  c.method.pressureRadius = 2.4;
  c.method.viscosityRadius = 1.9;
  EXPECT_THAT(caseWarnings(c),
              ElementsAre(HasSubstr("method.pressure_radius = 2.4 spacings is short for the scheme 'accurate'"),
                          "method.viscosity_radius = 1.9 spacings is short for the scheme 'accurate', expected at "
                          "least 2: sums over so few neighbours depend on where these stand"));
  c.method.viscosityRadius = 1.5;
  c.method.kind = MethodKind::Isph;  // has no such radii
  c.time.step = 1e-4;
  EXPECT_THAT(caseWarnings(c), IsEmpty());
}

TEST(caseWarnings, timesThatAreNotWholeNumbersOfSteps) {
  Case c = damBreak();
  c.time.end = 0.2004;
  c.output.interval = 1.5e-3;
  EXPECT_THAT(caseWarnings(c), ElementsAre(HasSubstr("makes 200 steps and ends at 0.2 s"),
                                           HasSubstr("output.interval = 0.0015 s")));
  c.time.courant = 0.2;  // steps vary: no time is a multiple of theirs
  EXPECT_THAT(caseWarnings(c), IsEmpty());
  c.time = {1e-3 / 64, 0.2};  // whole but for rounding
  c.output.interval = 0.01;
  EXPECT_THAT(caseWarnings(c), IsEmpty());
  EXPECT_EQ(c.steps(), 12800);
}

TEST(caseWarnings, longViscousStepsOfIsph) {
  Case c = isphDamBreak();
  const double least = c.materials[0].density * c.spacing * c.spacing / c.time.step;
  c.materials[0].dynamicViscosity = least;
  EXPECT_THAT(caseWarnings(c), IsEmpty());
  c.materials[0].dynamicViscosity = 2 * least;
  EXPECT_THAT(caseWarnings(c), ElementsAre(AllOf(HasSubstr("are 2 rho l^2/mu of '" + c.materials[0].name + "'"),
                                                 HasSubstr("or time.step <= 5e-05"))));
  c.bodies.erase(c.bodies.begin());  // its walls may be of that material
  EXPECT_THAT(caseWarnings(c), IsEmpty());
}

}  // namespace
}  // namespace treacle::test
