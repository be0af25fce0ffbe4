#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "command.hpp"
#include "treacle/io/case/case_reader.hpp"
#include "treacle/io/checkpoint/checkpoint.hpp"
#include "treacle/io/files/run_directory.hpp"
#include "treacle/io/frames/vtp.hpp"
#include "treacle/io/tables/history.hpp"

namespace treacle::test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

/// The small case of ISPH, large enough for an interior, in two or three dimensions, with a floor that swings.
std::string isphCase(int dimensions) {
  std::string text = replaced(smallIsphCase, "max = [6e-3, 6e-3]", "max = [8e-3, 8e-3]");
  text = replaced(text, "dynamic_viscosity = 10\n", "dynamic_viscosity = 1e-3\n");
  text = replaced(text, "max = [12e-3, 0]\n",
                  "max = [12e-3, 0]\noscillation = { amplitude = [1e-4, 0], period = 0.02 }\n");
  text = replaced(text, "step = 1e-3\nend = 2e-3", "step = 5e-4\nend = 3e-3");
  if (dimensions == 2) return text;
  for (const auto& [from, to] :
       {std::pair{"dimensions = 2", "dimensions = 3"},
        {"acceleration = [0, -10]", "acceleration = [0, 0, -10]"},
        {"[domain]\nmin = [-4e-3, -4e-3]\nmax = [12e-3, 12e-3]",
         "[domain]\nmin = [-4e-3, -4e-3, -4e-3]\nmax = [12e-3, 10e-3, 12e-3]"},
        {"min = [0, 0]\nmax = [8e-3, 8e-3]", "min = [0, 0, 0]\nmax = [8e-3, 6e-3, 7e-3]"},
        {"min = [-4e-3, -4e-3]\nmax = [12e-3, 0]", "min = [-4e-3, -4e-3, -4e-3]\nmax = [12e-3, 10e-3, 0]"},
        {"amplitude = [1e-4, 0]", "amplitude = [1e-4, 0, 0]"}})
    text = replaced(text, from, to);
  return text;
}

void checkRun(int dimensions, std::size_t fluid) {
  SCOPED_TRACE(dimensions);
  Workshop shop;
  shop.put("water.toml", isphCase(dimensions));
  const Outcome outcome = shop.call("run water.toml --threads 1 --timings");
  ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
  EXPECT_THAT(outcome.err, IsEmpty());
  EXPECT_THAT(outcome.out, HasSubstr("step 6/6  t = 0.003 s"));

  const RunDirectory run = RunDirectory::open(shop / "water-run");
  ASSERT_EQ(run.frameCount(), 4u);
  const Frame first = readVtp(run.fluidFrame(0)), last = readVtp(run.fluidFrame(3));
  const Frame walls = readVtp(run.wallsFrame(3));
  ASSERT_EQ(first.position.size(), fluid);
  // Densities are there from the first frame on, pressures from the first step, also on walls.
  for (const Frame& frame : {first, last})
    for (double density : frame.numberDensity) {
      EXPECT_GT(density, 0.3);
      EXPECT_LT(density, 1.2);
    }
  EXPECT_EQ(*std::max_element(first.pressure.begin(), first.pressure.end()), 0);
  EXPECT_GT(*std::max_element(last.pressure.begin(), last.pressure.end()), 10);
  EXPECT_EQ(*std::min_element(last.pressure.begin(), last.pressure.end()), 0) << "negative pressures are cut";
  EXPECT_GT(*std::max_element(walls.pressure.begin(), walls.pressure.end()), 10);
  const Frame wallsAtStart = readVtp(run.wallsFrame(0));
  for (std::size_t i = 0; i < walls.position.size(); ++i)
    ASSERT_NEAR(walls.position[i][0] - wallsAtStart.position[i][0], 1e-4 * std::sin(0.3 * M_PI), 1e-8);

  const auto rows = readHistory(run.history());
  ASSERT_EQ(rows.size(), 6u);
  for (const HistoryRow& row : rows) {
    EXPECT_EQ(row.timeStep, 5e-4);
    EXPECT_GE(row.iterations, 1);
    EXPECT_LE(row.iterations, 12);
    EXPECT_LE(row.residual, 1e-12);
    EXPECT_EQ(row.fallbacks, 0);
    EXPECT_GT(row.meanDensity, 0.7);
    EXPECT_LT(row.meanDensity, 1);
    EXPECT_GT(row.densityError, 0);
    EXPECT_LT(row.densityError, 0.02);
    EXPECT_GT(row.timings.solve, 0);
  }
  EXPECT_THAT(shop.content("water-run/run.log"),
              HasSubstr("info: solver: cg, hat-multigrid, mixed: grid degree 1"));
  EXPECT_THAT(shop.content("water-run/summary.json"), HasSubstr("\"status\": \"done\""));
  EXPECT_THAT(shop.content("water-run/final.png"), StartsWith("\x89PNG"));

  // The resolved case gives the same run, and a run in two parts the same bits.
  ASSERT_EQ(shop.call("run water-run/case.toml --threads 1 --quiet -o again").exitCode, 0);
  EXPECT_EQ(shop.call("compare water-run again --quiet --bound 0").exitCode, 0);
  ASSERT_EQ(shop.call("run water.toml --threads 1 --quiet -o parts --end-time 1.5e-3").exitCode, 0);
  const Outcome resumed = shop.call("run water.toml --resume parts/checkpoint.h5 --threads 1 --quiet -o rest");
  ASSERT_EQ(resumed.exitCode, 0) << resumed.err;
  const Frame end = readVtp(RunDirectory::open(shop / "rest").fluidFrame(2));
  EXPECT_EQ(end.position, last.position);
  EXPECT_EQ(end.pressure, last.pressure);
}

TEST(runIsph, leavesAllFilesInTwoDimensions) { checkRun(2, 64); }
TEST(runIsph, leavesAllFilesInThreeDimensions) { checkRun(3, 8 * 6 * 7); }

TEST(runIsph, everyPreconditionerAndKernelSolvesTheSameCase) {
  Workshop shop;
  shop.put("water.toml", isphCase(2));
  const std::string run =
      "run water.toml --threads 1 --quiet --set solver.tolerance=1e-20 --set output.precision=double ";
  ASSERT_EQ(shop.call(run).exitCode, 0);
  for (const char* name : {"none", "jacobi", "cell-multigrid"}) {
    ASSERT_EQ(shop.call(run + "-o other --force --set solver.preconditioner=" + name).exitCode, 0) << name;
    const Outcome outcome = shop.call("compare water-run other --bound 1e-7");
    EXPECT_EQ(outcome.exitCode, 0) << name << outcome.out;
  }
  EXPECT_EQ(shop.call("run water.toml --threads 1 --quiet -o w --set method.kernel=wendland-c2 --set "
                      "method.smoothing_ratio=1.5 --set method.shifting=0.1 --set method.walls=free-slip")
                .exitCode,
            0);
}

TEST(runIsph, withoutConvergenceNamesTheEquation) {
  Workshop shop;
  shop.put("water.toml", isphCase(2));
  const Outcome outcome = shop.call("run water.toml --threads 1 --set solver.max_iterations=1");
  EXPECT_EQ(outcome.exitCode, 3);
  EXPECT_THAT(outcome.err, StartsWith("treacle: error: after step 0 (t = 0 s): pressure: "));
  EXPECT_EQ(RunDirectory::open(shop / "water-run").frameCount(), 1u);
}

TEST(runIsph, stepsFollowTheCourantNumber) {
  Workshop shop;
  shop.put("water.toml", isphCase(2));
  ASSERT_EQ(shop.call("run water.toml --threads 1 --quiet --set time.courant=0.01 --end-time 4e-3").exitCode, 0);
  const auto rows = readHistory(shop / "water-run/history.csv");
  ASSERT_GT(rows.size(), 8u);
  double speed = 0;
  for (const HistoryRow& row : rows) {
    EXPECT_LE(row.timeStep * speed, 0.01 * 1e-3 * (1 + 1e-9));
    speed = row.maxSpeed;
  }
  EXPECT_NEAR(rows.back().time, 4e-3, 1e-15);
}

/// Pressures go with 1/dt: a last step that is short for no reason would end the run with noise.
TEST(runIsph, theLastTwoStepsShareWhatIsLeft) {
  Workshop shop;
  shop.put("water.toml", isphCase(2));
  const char* command =
      "run water.toml --threads 1 --quiet --set time.step=5e-4 --set time.courant=1 --end-time 1.02e-3";
  ASSERT_EQ(shop.call(command).exitCode, 0);
  const auto rows = readHistory(shop / "water-run/history.csv");
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_NEAR(rows[0].timeStep, 5e-4, 1e-12);
  EXPECT_NEAR(rows[1].timeStep, 2.6e-4, 1e-12);
  EXPECT_NEAR(rows[2].timeStep, 2.6e-4, 1e-12);
}

}  // namespace
}  // namespace treacle::test
