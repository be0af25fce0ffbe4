#include "arrangement_watch.hpp"

#include "command.hpp"
#include "treacle/io/files/run_directory.hpp"
#include "treacle/io/frames/vtp.hpp"
#include "treacle/model/case/case_keys.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace treacle::test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

TEST(ArrangementWatch, warnsOnceAndAgainWhenItIsTwiceAsBad) {
  Case c;
  c.method = defaultMethod(SchemeKind::Published);
  ArrangementWatch watch(c);
  EXPECT_THAT(watch.look({1, 1, 1.0}, 0), IsEmpty());
  EXPECT_THAT(watch.look({0.01, 0.25, 1.0199}, 0), IsEmpty());
  EXPECT_THAT(
      watch.look({0.1, 0.24, {}}, 0.125),
      ElementsAre(AllOf(StartsWith("t = 0.125 s: fluid particles clump: 1 % "), HasSubstr("within 0.24 "))));
  EXPECT_THAT(watch.look({0.01, 0.12, 1}, 0), IsEmpty());
  EXPECT_THAT(watch.look({0.01, 0.11, 1}, 0), ElementsAre(HasSubstr("within 0.11")));
  EXPECT_THAT(watch.look({0.01, 0.24, 1}, 0), IsEmpty());

  EXPECT_THAT(watch.look({1, 1, 0.97}, 0.5),
              ElementsAre(AllOf(StartsWith("t = 0.5 s: the density inside the fluid is 0.970 "),
                                HasSubstr("gained"), HasSubstr("accurate"))));
  EXPECT_THAT(watch.look({1, 1, 1.0599}, 0), IsEmpty());
  EXPECT_THAT(watch.look({1, 1, 1.07}, 0), ElementsAre(AllOf(HasSubstr("1.070"), HasSubstr("lost"))));
}

TEST(ArrangementWatch, aSinglePairDoesNoHarm) {
  const Case c;
  ArrangementWatch watch(c);
  EXPECT_THAT(watch.look({0.001, 0.38, 1}, 0), IsEmpty());
  EXPECT_THAT(watch.look({0.001, 0.2, 1}, 0), ElementsAre(HasSubstr("clump")));
}

TEST(ArrangementWatch, ofIsphTellsOfTheShareThatClumps) {
  Case c;
  c.method.kind = MethodKind::Isph;
  ArrangementWatch watch(c);
  EXPECT_THAT(watch.look({0.0005, 0.03, 1, 0.049}, 0), IsEmpty());
  EXPECT_THAT(watch.look({0.0005, 0.03, 1, 0.0625}, 0.5),
              ElementsAre(AllOf(StartsWith("t = 0.5 s: fluid particles clump: 6.25 % "),
                                HasSubstr("within 0.25 spacings (warned of beyond 5 %)"),
                                Not(HasSubstr("negative_pressure")))));
  EXPECT_THAT(watch.look({0.0005, 0.03, 1, 0.12}, 0), IsEmpty());
  EXPECT_THAT(watch.look({0.0005, 0.02, 1.03, 0.13}, 0), ElementsAre(HasSubstr("13 %"), HasSubstr("lost")));
  c.method.isph.negativePressure = true;
  EXPECT_THAT(ArrangementWatch(c).look({0, 0, 1, 0.3}, 0),
              ElementsAre(HasSubstr("negative_pressure = false helps")));
}

/// A drop of thin, soft fluid hits the floor in steps of half a spacing: its particles run into the wall's. Nobody
/// watches whether the run still means anything.
std::string collision() {
  std::string text = replaced(smallCase, "max = [6e-3, 6e-3]", "max = [6e-3, 6e-3]\nvelocity = [0, -2]");
  text = replaced(text, "dynamic_viscosity = 10\n", "dynamic_viscosity = 1e-3\n");
  text = replaced(text, "bulk_viscosity = 1e4\nbulk_modulus = 1e6\n", "bulk_viscosity = 1e-2\nbulk_modulus = 1\n");
  text = replaced(text, "step = 1e-3\nend = 2e-3", "step = 2.5e-4\nend = 1e-3");
  return text + "\n[watch]\nenergy = 0\ncourant = 0\ninside_walls = 0\ndensity = 0\n";
}

std::size_t countOf(const std::string& part, const std::string& text) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++count;
  return count;
}

TEST(ArrangementWatch, aRunInWhichParticlesClumpSaysSoOnce) {
  Workshop shop;
  shop.put("clump.toml", collision());
  const Outcome outcome = shop.call("run clump.toml --threads 1 --set output.interval=2.5e-4");
  ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
  const std::string log = shop.content("clump-run/run.log");
  EXPECT_EQ(countOf("warning: t = ", log), 1u) << log;
  EXPECT_EQ(countOf("fluid particles clump", log), 1u) << log;
  EXPECT_THAT(outcome.err, HasSubstr("fluid particles clump"));
  EXPECT_THAT(outcome.err, Not(HasSubstr("density")));

  const RunDirectory run = RunDirectory::open(shop / "clump-run");
  const Frame last = readVtp(run.fluidFrame(run.frameCount() - 1));
  ASSERT_EQ(last.nearestDistance.size(), last.position.size());
  EXPECT_TRUE(readVtp(run.wallsFrame(0)).nearestDistance.empty());
  const auto json = nlohmann::json::parse(shop.content("clump-run/summary.json"));
  const auto& distance = json["nearest_distance"];
  EXPECT_NEAR(distance["least"], *std::min_element(last.nearestDistance.begin(), last.nearestDistance.end()),
              1e-7);
  EXPECT_LE(distance["smallest_least"], distance["least"]);
  EXPECT_LE(distance["smallest_low"], distance["low"]);
  EXPECT_TRUE(json["density"]["inside"].is_null());
  EXPECT_EQ(shop.call("plot clump-run --field nearest_distance").exitCode, 0);
  EXPECT_EQ(shop.call("compare clump-run clump-run --quiet --bound 0 --field nearest_distance").exitCode, 0);
}

TEST(HangingWatch, saysThatAStiffDropRestsAboveTheFloor) {
  Workshop shop;
  shop.put("drop.toml", R"(dimensions = 2
spacing = 1e-3
domain = { min = [0, 0], max = [0.03, 0.03] }
gravity = { acceleration = [0, -9.81] }
time = { step = 1e-3, end = 0.14 }
output = { interval = 0.02 }
material = [{ name = "pitch", density = 1400, dynamic_viscosity = 1e6, bulk_viscosity = 1e8, bulk_modulus = 1e6 }]
body = [
  { name = "drop", type = "fluid", material = "pitch", shape = "sphere", center = [0.015, 0.012], radius = 0.004 },
  { name = "floor", type = "wall", material = "pitch", shape = "box", min = [0, 0], max = [0.03, 0.004] },
]
)");
  const auto warnings = [&](const std::string& settings) {
    const Outcome outcome = shop.call("run drop.toml -o run --force --threads 1" + settings);
    EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
    return countOf("touches no wall and yet rests", outcome.err);
  };
  EXPECT_EQ(warnings(""), 1u);
  EXPECT_EQ(warnings(" --set pitch.dynamic_viscosity=1 --set pitch.bulk_viscosity=1e3"), 0u);
  EXPECT_EQ(warnings(" --set drop.center=[0.015,0.008]"), 0u) << "it begins in contact";
}

/// A splash of water has single pairs that are closer than MPH-I may have any.
TEST(ArrangementWatch, theDamBreakOfWaterIsWithinTheBoundOfIsph) {
  Workshop shop;
  const Outcome outcome = shop.call("run " TREACLE_CASES
                                    "/isph-dam-break-2d.toml -o dam --quiet --end-time 0.12 --set resolution=0.5");
  ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
  EXPECT_THAT(shop.content("dam/run.log"), Not(HasSubstr("warning")));
  const auto json = nlohmann::json::parse(shop.content("dam/summary.json"));
  EXPECT_LT(json["nearest_distance"]["smallest_least"], 0.2);
}

TEST(ArrangementWatch, theDamBreakIsWithinAllBounds) {
  Workshop shop;
  const Outcome outcome = shop.call("run " TREACLE_CASES "/dam-break-2d.toml -o dam --quiet");
  ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
  const std::string log = shop.content("dam/run.log");
  EXPECT_THAT(log, Not(HasSubstr("warning")));
  EXPECT_EQ(countOf(", nearest distances from ", log), 21u);
  const auto json = nlohmann::json::parse(shop.content("dam/summary.json"));
  EXPECT_NEAR(json["nearest_distance"]["smallest_least"], 0.53, 0.02);
  EXPECT_NEAR(json["density"]["inside"], 0.9993, 1e-3);
}

}  // namespace
}  // namespace treacle::test
