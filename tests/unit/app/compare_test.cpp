#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "command.hpp"

namespace treacle::test {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

/// A workshop with a run of the small case in run-b.
Workshop& withRunB(Workshop& shop) {
  shop.put("small.toml", smallCase);
  EXPECT_EQ(shop.call("run small.toml --quiet --threads 1 -o run-b").exitCode, 0);
  return shop;
}

void runAs(const Workshop& shop, const std::string& options) {
  ASSERT_EQ(shop.call("run small.toml --quiet --threads 1 -o run-a " + options).exitCode, 0);
}

TEST(compare, operatorsAgree) {
  Workshop shop;
  runAs(withRunB(shop), "--set solver.operator=assembled");
  const Outcome outcome = shop.call("compare run-a run-b --csv table.csv");
  EXPECT_EQ(outcome.exitCode, 0);
  EXPECT_THAT(outcome.err, IsEmpty());
  EXPECT_THAT(outcome.out, HasSubstr("position [m]"));
  EXPECT_THAT(outcome.out, HasSubstr("\n       0.002  "));
  EXPECT_THAT(outcome.out, HasSubstr("histories: 2 time steps in both\n"));
  EXPECT_THAT(outcome.out, HasSubstr("relative differences at t = 0.002 s: front_x "));
  EXPECT_THAT(outcome.out, EndsWith("\nagree within 1e-05 in 3 frames: position, velocity\n"));
  const std::string table = shop.content("table.csv");
  EXPECT_THAT(table, StartsWith("time,frame_a,frame_b,position_max,"));
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 4);
}

TEST(compare, aRunAgreesWithItselfToTheBit) {
  Workshop shop;
  const Outcome outcome = withRunB(shop).call(
      "compare run-b run-b --quiet --bound 0 --field pressure --field position --field number_density "
      "--field nearest_distance");
  EXPECT_EQ(outcome.exitCode, 0);
  EXPECT_EQ(outcome.out, "agree within 0 in 3 frames: pressure, position, number_density, nearest_distance\n");
}

TEST(compare, otherViscosityDiffersFromTheFirstStepOn) {
  Workshop shop;
  runAs(withRunB(shop), "--set syrup.dynamic_viscosity=20");
  const Outcome outcome = shop.call("compare run-a run-b --quiet");
  EXPECT_EQ(outcome.exitCode, 1);
  EXPECT_THAT(outcome.err, IsEmpty());
  EXPECT_THAT(outcome.out, StartsWith("differ: velocity by "));
  EXPECT_THAT(outcome.out, EndsWith(" at t = 0.001 s (frames 1 and 1), bound 1e-05\n"));
  EXPECT_EQ(shop.call("compare run-a run-b --quiet --bound 1e3").exitCode, 0);
}

TEST(compare, framesWithoutPartnerAreListed) {
  Workshop shop;
  runAs(withRunB(shop), "--end-time 3e-3");
  const Outcome outcome = shop.call("compare run-a run-b");
  EXPECT_EQ(outcome.exitCode, 0);
  EXPECT_THAT(outcome.out, HasSubstr("\nframes of run-a without a partner, t [s]: 0.003\n"));
}

TEST(compare, whatCannotBeComparedIsBadInput) {
  Workshop shop;
  runAs(withRunB(shop), "--set 'output.fields=[\"velocity\"]'");
  const auto expectRefused = [&](const std::string& arguments, const std::string& message) {
    const Outcome outcome = shop.call("compare " + arguments);
    EXPECT_EQ(outcome.exitCode, 2);
    EXPECT_THAT(outcome.out, IsEmpty());
    EXPECT_THAT(outcome.err, HasSubstr(message));
  };
  expectRefused("run-a run-b",
                "run-a/frames/fluid_000000.vtp and run-b/frames/fluid_000000.vtp cannot be compared: "
                "particles have no ids");
  expectRefused("run-b none", "none: not the directory of a run");
  expectRefused("run-b", "B is required");
  expectRefused("run-b run-b --bound=-1", "--bound: expected a number not less than 0, found '-1'");
  expectRefused("run-b run-b --field speed",
                "--field: expected position|velocity|pressure|number_density|nearest_distance, found 'speed'");
  runAs(shop, "--force --set 'output.fields=[\"id\", \"pressure\"]'");
  expectRefused("run-a run-b", "'velocity' cannot be compared, frame 0 or 0 (t = 0 s) does not hold it");
  EXPECT_EQ(shop.call("compare run-a run-b --field pressure --quiet").exitCode, 0);
}

}  // namespace
}  // namespace treacle::test
