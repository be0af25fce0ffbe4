#include "treacle/core/error.hpp"
#include "treacle/io/case/case_reader.hpp"
#include "treacle/io/tables/history.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "support/probe_table.hpp"
#include "unit/app/command.hpp"
#include "unit/app/mistakes.hpp"

namespace treacle::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::string probes = R"(
[[probe]]
name = "corner"
type = "point"
point = [1e-3, 1e-3]

[[probe]]
name = "profile"
type = "line"
from = [0, 2e-3]
to = [8e-3, 2e-3]
interval = 1e-2

[[probe]]
name = "cut"
type = "plane"
corner = [0, 0]
along = [6e-3, 0]
up = [0, 6e-3]
columns = 4
interval = 2e-2

[[probe]]
name = "level"
type = "height"
from = [1e-3, 0]
to = [1e-3, 10e-3]

[[probe]]
name = "through"
type = "flow"
point = [5e-3, 0]
normal = [3, 0]

[[probe]]
name = "beyond"
type = "region"
point = [5e-3, 0]
normal = [-1, 0]

[[probe]]
name = "all"
type = "region"
material = "syrup"

[[probe]]
name = "floor-load"
type = "load"
body = "floor"
interval = 1e-2
)";

Case probeCaseWith(const std::vector<std::string>& overrides) {
  Workshop shop;
  shop.put("case.toml", smallCase + probes);
  return readCase(shop / "case.toml", overrides);
}

TEST(ProbeCase, IsReadAndWritten) {
  Workshop shop;
  const Case c = probeCaseWith({"through.box={min=[0,0],max=[1,1e-3]}"});
  ASSERT_EQ(c.probes.size(), 8u);
  EXPECT_TRUE(c.needsBalance());
  shop.put("written.toml", caseText(c));
  EXPECT_EQ(readCase(shop / "written.toml"), c) << caseText(c);
}

const Mistake probeMistakes[] = {
    {"corner.kind='point'", "unknown key 'kind' in [[probe]] 'corner' (point)"},
    {"corner.type='dot'",
     "expected 'point', 'line', 'plane', 'height', 'flow', 'region', 'load' or 'wall-pressure', found 'dot'"},
    {"corner.normal=[1,0]", "unknown key 'normal' in [[probe]] 'corner' (point)"},
    {"corner.point=[1e-3,20e-3]", "expected a point of the domain, -0.004 to 0.012 m along y, found 0.02"},
    {"corner.name='a/b'", "expected letters, digits and . _ - +"},
    {"corner.name='level'", "two [[probe]] are named 'level'"},
    {"corner.interval=-1", "expected a number not less than 0 [s], found -1"},
    {"profile.to=[0,2e-3]", "expected a point other than from"},
    {"profile.count=10000000", "expected a whole number from 0 to 1000000"},
    {"cut.up=[1e-3,1e-3]", "expected a vector at right angles to along"},
    {"cut.up=[0,1e6]", "expected at most 1e+07 places, found 4e+09"},
    {"through.normal=[0,0]", "expected a direction, found a vector of length 0"},
    {"beyond.box={min=[0,0],max=[1,0]}", "expected more than min on every axis"},
    {"all.material='honey'", "expected the name of a material, found 'honey'"},
    {"level.moves_with='roof'", "expected the name of a wall or rigid body, found 'roof'"},
    {"level.moves_with='column'", "'column' is fluid; expected the name of a wall or rigid body"},
    {"floor-load.moves_with='floor'", "unknown key 'moves_with' in [[probe]] 'floor-load' (load)"},
    {"floor-load.body='roof'", "expected the name of a wall or rigid body, found 'roof'"},
    {"floor-load.body='column'", "'column' is fluid; expected the name of a wall or rigid body"},
};

TEST(ProbeCase, MistakesAreExplained) { expectExplained(probeMistakes, probeCaseWith); }

TEST(ProbeCase, IsphReadsLoadsToo) {
  Workshop shop;
  const std::string elastic = "bulk_viscosity = 1e4\nbulk_modulus = 1e6\n";
  shop.put("case.toml", replaced(smallCase, elastic, "") + probes + "[method]\nname = \"isph\"\n");
  const Outcome outcome = shop.call("run case.toml -o run --backend cpu --threads 1 --quiet --set time.end=0.02");
  ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
  EXPECT_LT(readProbe(shop / "run/probes/floor-load.csv").column("force_y")->back(), -0.1);
}

/// All probes of one run, against what else is known of it.
TEST(ProbeCase, ProbesAreRead) {
  Workshop shop;
  shop.put("case.toml", smallCase + probes);
  const std::string settings = " --backend cpu --threads 1 --quiet --set output.balance=true --set time.end=0.04";
  const Outcome outcome = shop.call("run case.toml -o run" + settings);
  ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
  const auto read = [&](const char* name) {
    return readProbe(shop / "run/probes" / (std::string(name) + ".csv"));
  };
  const auto last = [](const ProbeTable& table, const char* name) { return table.column(name)->back(); };

  const ProbeTable corner = read("corner");
  EXPECT_THAT(corner.names, ElementsAre("time", "x", "y", "velocity_x", "velocity_y", "pressure"));
  EXPECT_EQ(corner.rows(), 41u);
  EXPECT_EQ(corner.column("time")->at(7), 7e-3);
  EXPECT_EQ(corner.column("pressure")->at(0), 0);
  EXPECT_GT(last(corner, "pressure"), 10);
  EXPECT_LT(last(corner, "velocity_y"), 0);

  const ProbeTable profile = read("profile");
  EXPECT_EQ(profile.rows(), 9u * 5);
  EXPECT_EQ(last(profile, "distance"), 8e-3);
  EXPECT_TRUE(std::isnan(profile.column("velocity_x")->at(8)));  // no fluid is there at the start
  EXPECT_EQ(read("cut").rows(), 4u * 7 * 3);

  const ProbeTable level = read("level");
  EXPECT_NEAR(level.column("height")->at(0), 6e-3, 0.05e-3);
  EXPECT_LT(last(level, "height"), 5.95e-3);
  EXPECT_EQ(last(level, "y"), last(level, "height"));

  // What has gone through the plane is beyond it.
  const ProbeTable through = read("through"), beyond = read("beyond"), all = read("all");
  double passed = 0;
  for (std::size_t k = 1; k < through.rows(); ++k) passed += 1e-3 * through.column("volume_flow_rate")->at(k);
  const double gained = last(beyond, "volume") - beyond.column("volume")->at(0);
  EXPECT_GT(passed, 1e-7);
  EXPECT_NEAR(passed, gained, 0.15 * gained);
  EXPECT_NEAR(last(through, "mass_flow_rate"), 1000 * last(through, "volume_flow_rate"), 1e-9);
  EXPECT_NEAR(last(all, "volume"), 36e-6, 1e-15);
  EXPECT_NEAR(last(all, "mass"), 0.036, 1e-12);
  EXPECT_NEAR(last(all, "dynamic_viscosity"), 10, 1e-9);
  const std::vector<HistoryRow> history = readHistory(shop / "run/history.csv");
  EXPECT_NEAR(10 * last(all, "mass") * last(all, "center_y"), history.back().potentialEnergy, 1e-12);

  const ProbeTable load = read("floor-load");
  EXPECT_EQ(load.rows(), 4u);
  const std::string balance = shop.content("run/balance.csv");
  EXPECT_THAT(balance, HasSubstr(fmt::format(",{},{},{}\n", last(load, "force_x"), last(load, "force_y"),
                                             last(load, "torque"))));

  const Outcome unknown = shop.call("plot run --probe levle");
  EXPECT_EQ(unknown.exitCode, 2);
  EXPECT_THAT(unknown.err, HasSubstr("found 'levle'"));

  // The rest of a run that is continued has the same rows, and --force leaves none of an older run.
  ASSERT_EQ(shop.call("run case.toml -o half" + settings + " --end-time 0.02").exitCode, 0);
  ASSERT_EQ(shop.call("run case.toml -o rest" + settings + " --resume half/checkpoint.h5").exitCode, 0);
  for (const char* name : {"corner", "level", "all", "floor-load"}) {
    const ProbeTable rest = readProbe(shop / "rest/probes" / (std::string(name) + ".csv")), whole = read(name);
    ASSERT_GT(rest.rows(), 1u);
    for (std::size_t k = 0; k < whole.names.size(); ++k)
      EXPECT_EQ(rest.columns[k].back(), whole.columns[k].back());
  }
  shop.put("plain.toml", smallCase);
  ASSERT_EQ(shop.call("run plain.toml -o run --force --backend cpu --threads 1 --quiet").exitCode, 0);
  EXPECT_FALSE(std::filesystem::exists(shop / "run/probes/corner.csv"));
  EXPECT_THAT(shop.call("plot run --probe corner").err, HasSubstr("the case has no probes"));
}

std::string wallPressure(const std::string& name, const std::string& place) {
  return fmt::format("\n[[probe]]\nname = \"{}\"\ntype = \"wall-pressure\"\nbody = \"floor\"\n{}\n", name, place);
}

/// Not -nan, which 0/0 is on some processors.
TEST(ProbeCase, ARegionWithoutFluidReadsNan) {
  Workshop shop;
  shop.put("case.toml", smallCase +
                            "\n[[probe]]\nname = \"empty\"\ntype = \"region\"\n"
                            "box = {min = [7e-3, 8e-3], max = [8e-3, 9e-3]}\n");
  const Outcome outcome = shop.call("run case.toml -o run --backend cpu --threads 1 --quiet --end-time 0.002");
  ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
  const ProbeTable empty = readProbe(shop / "run/probes/empty.csv");
  EXPECT_EQ(empty.column("volume")->back(), 0);
  for (const char* mean : {"center_x", "velocity_y", "pressure", "dynamic_viscosity"}) {
    EXPECT_TRUE(std::isnan(empty.column(mean)->back())) << mean;
    EXPECT_FALSE(std::signbit(empty.column(mean)->back())) << mean;
  }
}

/// Patches that make up a wall bear its load, each by its area, and readings at intervals are means over steps.
TEST(ProbeCase, PressuresOnPatches) {
  for (const bool isph : {false, true}) {
    Workshop shop;
    shop.put("case.toml", (isph ? smallIsphCase : smallCase) +
                              "\n[[probe]]\nname = \"load\"\ntype = \"load\"\nbody = \"floor\"\n" +
                              wallPressure("all", "corner = [-4e-3, 0]\nalong = [16e-3, 0]") +
                              wallPressure("left", "corner = [1.7e-3, 0]\nalong = [-6e-3, 0]") +
                              wallPressure("right", "corner = [1.7e-3, 0]\nalong = [12e-3, 0]") +
                              wallPressure("mean", "corner = [-4e-3, 0]\nalong = [16e-3, 0]\ninterval = 1e-2") +
                              wallPressure("nowhere", "corner = [0, 9e-3]\nalong = [1e-3, 0]"));
    ASSERT_EQ(shop.call("run case.toml -o run --backend cpu --threads 1 --quiet --end-time 0.02").exitCode, 0);
    EXPECT_THAT(shop.call("check case.toml").err,
                HasSubstr("probe 'nowhere': no particle of 'floor' is behind its patch"));
    const auto read = [&](const std::string& name, const char* column) {
      return *readProbe(shop / ("run/probes/" + name + ".csv")).column(column);
    };
    const auto load = read("load", "force_y"), all = read("all", "pressure"), left = read("left", "pressure"),
               right = read("right", "pressure"), mean = read("mean", "pressure");
    ASSERT_EQ(all.size(), 20u);
    double sum = 0, largest = -1e9;
    for (std::size_t k = 0; k < all.size(); ++k) {
      EXPECT_NEAR(16e-3 * all[k], -load[k], 1e-9 * std::abs(load[k]));
      EXPECT_NEAR(6e-3 * left[k] + 12e-3 * right[k], -load[k], 1e-9 * std::abs(load[k]));
      if (k >= 10) sum += all[k] / 10, largest = std::max(largest, all[k]);
    }
    EXPECT_GT(all.back(), 0);
    ASSERT_EQ(mean.size(), 2u);
    EXPECT_NEAR(mean[1], sum, 1e-9 * std::abs(sum));
    EXPECT_EQ(read("mean", "largest")[1], largest);
    EXPECT_EQ(read("nowhere", "pressure")[0], 0);
    EXPECT_EQ(read("nowhere", "largest")[0], 0);
  }
}

/// Fluid that a floor carries along, read where both go.
TEST(ProbeCase, MoveWithAWall) {
  Workshop shop;
  shop.put("case.toml", smallCase +
                            "\n[[probe]]\nname = \"there\"\ntype = \"point\"\npoint = [3e-3, 1e-3]\n"
                            "moves_with = \"floor\"\n");
  ASSERT_EQ(
      shop.call(
              "run case.toml -o run --backend cpu --threads 1 --quiet --end-time 0.01 "
              "--set 'floor.velocity=[0.1, 0]' --set 'column.velocity=[0.1, 0]' --set 'domain.max=[20e-3, 12e-3]'")
          .exitCode,
      0);
  const ProbeTable table = readProbe(shop / "run/probes/there.csv");
  ASSERT_EQ(table.rows(), 11u);
  for (std::size_t k = 0; k < table.rows(); ++k) {
    EXPECT_NEAR(table.column("x")->at(k), 3e-3 + 0.1 * table.column("time")->at(k), 1e-12);
    EXPECT_NEAR(table.column("velocity_x")->at(k), 0.1, 0.01);
  }
}

}  // namespace
}  // namespace treacle::test
