#include "treacle/model/case/case_keys.hpp"
#include "treacle/model/case/checks.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sample_case.hpp"

namespace treacle::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// Nothing to warn of.
Case pool() {
  Case c = emptyCase(2);
  c.spacing = 1e-3;
  c.domain = {{-0.02, -0.02, 0}, {0.05, 0.05, 0}};
  c.gravity = {0, -10};
  c.bodies = {makeBody("column", BodyKind::Fluid, box({0, 0}, {20e-3, 20e-3})),
              makeBody("floor", BodyKind::Wall, box({0, -10e-3}, {40e-3, 0}))};
  return c;
}

Probe region(const char* name) {
  Probe p;
  p.name = name, p.kind = ProbeKind::Region;
  return p;
}

TEST(likelyMistakes, noneInASoundCase) {
  Case c = pool();
  c.gas.emplace().vents = {{"top", {0, 0.03, 0}, {0.01, 0.05, 0}}};
  c.heat.emplace();
  c.bodies[0].temperature = c.bodies[1].temperature = 300;
  c.probes = {region("all")};
  c.probes[0].material = "syrup", c.probes[0].interval = c.time.end;
  c.outflows.push_back({.name = "end", .kind = OutflowKind::Plane, .point = {0.04, 0, 0}, .normal = {1, 0, 0}});
  EXPECT_THAT(caseWarnings(c), IsEmpty());
}

TEST(likelyMistakes, unitsAreSi) {
  Case c = pool();
  c.heat.emplace().ambient = 20;
  c.bodies[0].temperature = c.bodies[1].temperature = 300;
  EXPECT_THAT(caseWarnings(c), ElementsAre("heat.ambient_temperature is 20 K. Are these degrees Celsius? Expected "
                                           "kelvin, 293.15"));
  c.heat.reset();
  c.gas.emplace().pressure = 101.325;
  EXPECT_THAT(caseWarnings(c), ElementsAre(HasSubstr("gas.pressure is 101.325 Pa, and that of the atmosphere")));
  c.gas.reset();
  c.gravity = {0, -981};
  c.materials[0].bulkModulus = 1e7, c.materials[0].bulkViscosity = 1e5, c.time.step = 1e-4;
  EXPECT_THAT(caseWarnings(c), testing::Contains(HasSubstr("gravity.acceleration is 981 m/s2, 100 times")));
}

TEST(likelyMistakes, placesAreInTheDomain) {
  Case c = pool();
  c.outflows.push_back({.name = "box", .min = {0, 0.05, 0}, .max = {0.01, 0.06, 0}});
  c.outflows.push_back(
      {.name = "plane", .kind = OutflowKind::Plane, .point = {0, -0.03, 0}, .normal = {0, -1, 0}});
  c.probes = {region("box")};
  c.probes[0].box.emplace();
  c.probes[0].box->min = {-1, 0, 0}, c.probes[0].box->max = {-0.5, 1, 0};
  c.gas.emplace().vents = {{"far", {1, 1, 0}, {2, 2, 0}}, {"in", {0, -9e-3, 0}, {0.04, -1e-3, 0}}};
  EXPECT_THAT(caseWarnings(c),
              ElementsAre(HasSubstr("outflow 'box' is without effect: all of it is outside the domain, "),
                          HasSubstr("outflow 'plane' is without effect"), HasSubstr("the box of probe 'box' is"),
                          HasSubstr("vent 'far' is without effect: all of it is outside"),
                          HasSubstr("vent 'in' is without effect: walls fill all of it")));
}

TEST(likelyMistakes, timesAreInTheRun) {
  Case c = pool();
  c.probes = {region("late")};
  c.probes[0].interval = 1;
  c.bodies.push_back(makeBody("block", BodyKind::Rigid, box({0, 30e-3}, {5e-3, 35e-3})));
  c.bodies[2].rigid.release = 0.2;
  EXPECT_THAT(caseWarnings(c),
              testing::IsSupersetOf({HasSubstr("probe 'late' reads the state at the start only: its "
                                               "interval of 1 s is longer than the run of 0.2 s"),
                                     HasSubstr("rigid body 'block' stands still: its release at 0.2 "
                                               "s is not before the end of the run, 0.2 s")}));
}

TEST(likelyMistakes, whatIsNotThere) {
  Case c = pool();
  c.materials.push_back({"steel", 7800, 10, 1e4, 1e6});
  c.probes = {region("steel")};
  c.probes[0].material = "steel";
  EXPECT_THAT(caseWarnings(c),
              ElementsAre("probe 'steel' finds nothing: no fluid is made of its material 'steel'"));
  c = pool();
  c.bodies.push_back(makeBody("drop", BodyKind::Fluid, sphere({0, 30e-3}, 0.2e-3)));
  EXPECT_THAT(caseWarnings(c),
              testing::Contains("body 'drop' is 0.4 mm large, less than half of the spacing 1 mm; it "
                                "becomes one particle, which has the size of the spacing"));
  c = pool();
  c.method = defaultMethod(SchemeKind::Published);
  const std::size_t before = caseWarnings(c).size();
  c.method.tensionLimit = 100;
  EXPECT_EQ(caseWarnings(c).size(), before + 1);
}

}  // namespace
}  // namespace treacle::test
