#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

#include "command.hpp"
#include "treacle/io/case/case_reader.hpp"
#include "treacle/io/checkpoint/checkpoint.hpp"
#include "treacle/io/files/run_directory.hpp"
#include "treacle/io/frames/vtp.hpp"
#include "treacle/io/tables/history.hpp"

namespace treacle::test {
namespace {

using testing::AllOf;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

constexpr std::string_view pngSignature = "\x89PNG";

TEST(helpAndVersion, documentTheExitCodes) {
  Workshop shop;
  const Outcome help = shop.call("--help");
  EXPECT_EQ(help.exitCode, 0);
  EXPECT_THAT(help.out, HasSubstr("Exit codes: 0 done, 1 compared runs differ, 2 bad input, 3 the run failed."));
  const Outcome version = shop.call("--version");
  EXPECT_EQ(version.exitCode, 0);
  EXPECT_THAT(version.out, StartsWith("treacle "));
}

TEST(commandLine, namesUnknownWordsInTheirOrder) {
  Workshop shop;
  const Outcome outcome = shop.call("run small.toml --thread 1");
  EXPECT_EQ(outcome.exitCode, 2);
  EXPECT_THAT(outcome.err, HasSubstr("not expected: --thread 1; --help tells more"));
}

TEST(info, namesVersionAndThreads) {
  Workshop shop;
  const Outcome outcome = shop.call("info", "OMP_NUM_THREADS=1");
  EXPECT_EQ(outcome.exitCode, 0);
  EXPECT_THAT(outcome.out, HasSubstr("threads     1\n"));
  EXPECT_THAT(outcome.out, HasSubstr("CUDA "));
}

TEST(check, takesABackgroundPressure) {
  Workshop shop;
  const Outcome outcome = withSmallCase(shop).call("check small.toml --set method.background_pressure=55");
  EXPECT_EQ(outcome.exitCode, 0);
  EXPECT_THAT(outcome.out, HasSubstr("background_pressure = 55\n"));
}

TEST(check, saysWhichOutlineIsAThinSolid) {
  Workshop shop;
  withSmallCase(shop);
  shop.put("thin.toml", R"(base = "small.toml"
[[body]]
name = "blade"
type = "wall"
material = "syrup"
shape = "polygon"
fill = "thin-sheet"
points = [[0, 9e-3], [9e-3, 9e-3], [9e-3, 9.4e-3], [0, 9.4e-3]]
)");
  EXPECT_THAT(shop.call("check thin.toml").out, HasSubstr("a thin solid: 'blade' is the sheet in its middle\n"));
}

TEST(check, printsCountsNumbersAndCaseThatCanBeRunAgain) {
  Workshop shop;
  const Outcome outcome =
      withSmallCase(shop).call("check small.toml --set resolution=2 --set 'column.velocity=[1,0]'");
  EXPECT_EQ(outcome.exitCode, 0);
  EXPECT_THAT(outcome.err, IsEmpty());
  EXPECT_THAT(outcome.out, HasSubstr("# particles: 144 fluid, 256 wall\n"));
  EXPECT_THAT(outcome.out, HasSubstr("#   fluid 'column': 144\n"));
  EXPECT_THAT(outcome.out, HasSubstr("#   wall 'floor': 256\n"));
  EXPECT_THAT(outcome.out, HasSubstr("# steps: 4\n"));
  EXPECT_THAT(outcome.out,
              ContainsRegex("# solver: cg, projected-multigrid, mixed: pressure degree [0-9]+, grid degree "
                            "[0-9]+, velocity degree [0-9]+, deflation by up to 8 modes\n"));
  EXPECT_THAT(outcome.out, HasSubstr("# Courant number: 1\n"));
  EXPECT_THAT(outcome.out, HasSubstr("dt kappa / lambda = 0.05 (stable up to 0.5), diffusion numbers d_mu = 20, "
                                     "d_lambda = 2e+04\n"));
  EXPECT_THAT(outcome.out, HasSubstr("# memory: about "));
  EXPECT_THAT(outcome.out, HasSubstr("# device memory: about "));
  shop.put("again.toml", outcome.out);
  const std::string overrides[] = {"resolution=2", "column.velocity=[1,0]"};
  Case expected = readCase(shop / "small.toml", overrides);
  expected.resolution = 1;
  EXPECT_EQ(readCase(shop / "again.toml"), expected);
}

TEST(check, countsTheLeastStepsWhereTheyVary) {
  Workshop shop;
  const Outcome outcome =
      withSmallCase(shop).call("check small.toml --set time.courant=0.1 --set time.step=1.5e-3");
  EXPECT_EQ(outcome.exitCode, 0);
  EXPECT_THAT(outcome.err, IsEmpty());
  EXPECT_THAT(outcome.out, HasSubstr("# steps: 2 or more\n"));
  EXPECT_THAT(outcome.out, HasSubstr("# Courant number: 0.1\n"));
}

TEST(check, saysWhatAutomaticStepsMayBe) {
  Workshop shop;
  const Outcome outcome = withSmallCase(shop).call("check small.toml --set time.step=auto");
  EXPECT_EQ(outcome.exitCode, 0);
  EXPECT_THAT(outcome.err, IsEmpty());
  EXPECT_THAT(
      outcome.out,
      HasSubstr("# time step: chosen in each step for an error of 0.02, from 2e-07 to 0.002 s, Courant number "
                "at most 1; stable up to 0.005 s (dt kappa / lambda of 'syrup')\n"));
  EXPECT_THAT(outcome.out, HasSubstr("# steps: 1 or more\n"));
  EXPECT_THAT(outcome.out, HasSubstr("\nstep = \"auto\"\n"));
}

TEST(check, printsNumbersOfFluidsAndAdvice) {
  Workshop shop;
  const Outcome outcome = withSmallCase(shop).call("check small.toml");
  EXPECT_EQ(outcome.exitCode, 0);
  EXPECT_THAT(outcome.out,
              HasSubstr("# resolution: 6 particles across the shortest side of the fluid, 0.006 m; "));
  // U = rho g L^2/mu = 0.036 m/s, which is less than a fall over 6 mm; Re = rho U L/mu.
  EXPECT_THAT(outcome.out,
              HasSubstr("# fluid 'syrup': Reynolds number 0.0216 at 0.036 m/s, viscous time 0.0036 s, "
                        "lambda / mu = 1000, compressed by up to 0.006 %\n"));
  EXPECT_THAT(outcome.out, HasSubstr("bulk_modulus from 6e+03 (compressed by 1 %) to 5e+06 (stable with "
                                     "both)\n"));
  EXPECT_THAT(outcome.out, HasSubstr("# advice for the step: \"auto\", or at most 0.005 s (dt kappa / lambda of "
                                     "'syrup')\n"));
  // Of the bulk viscosity that stands beside it, whatever that of the case is.
  EXPECT_THAT(shop.call("check small.toml --set syrup.bulk_viscosity=1e6").out,
              HasSubstr("to 5e+06 (stable with both)\n"));
  shop.put("open.toml", replaced(smallCase, "bulk_viscosity = 1e4\nbulk_modulus = 1e6\n", ""));
  EXPECT_THAT(shop.call("check open.toml").out,
              AllOf(HasSubstr("# automatic constants of 'syrup'"), Not(HasSubstr("advice for 'syrup'"))));
  const Outcome tense = shop.call("check small.toml --set syrup.surface_tension=8");
  EXPECT_THAT(tense.out, HasSubstr("Bond number 0.045, capillary step 0.0025 s\n"));
  EXPECT_THAT(tense.out, HasSubstr("or at most 0.0025 s (surface tension of 'syrup')\n"));
}

TEST(check, estimatesTimeByRealSteps) {
  Workshop shop;
  const Outcome whole = withSmallCase(shop).call("check small.toml --estimate --backend cpu --threads 1");
  EXPECT_EQ(whole.exitCode, 0) << whole.err;
  EXPECT_THAT(whole.out, HasSubstr("s, without output; these are all 2 steps of the case\n"));
  const Outcome longer = shop.call("check small.toml --estimate --backend cpu --threads 1 --set time.end=1");
  EXPECT_EQ(longer.exitCode, 0) << longer.err;
  EXPECT_THAT(longer.out, HasSubstr("# timed: 50 steps of "));
  EXPECT_THAT(longer.out, ContainsRegex("# run time: about .* on 1 threads for 1000 steps, without output; "));
  EXPECT_FALSE(std::filesystem::exists(shop / "small-run"));
  const Outcome failed =
      shop.call("check small.toml --estimate --backend cpu --threads 1 --set solver.max_iterations=1");
  EXPECT_EQ(failed.exitCode, 3);
  EXPECT_THAT(failed.err, HasSubstr("after step 0"));
}

TEST(completion, offersCommandsOptionsAndWords) {
  Workshop shop;
  const auto offered = [&](const std::string& words, int place) {
    shop.put("ask.sh", "source <(\"$1\" completion bash)\nCOMP_WORDS=(" + words +
                           ")\nCOMP_CWORD=" + std::to_string(place) + "\n_treacle\necho \"${COMPREPLY[@]}\"\n");
    return shop.call("x 2>/dev/null; bash ask.sh '" TREACLE_BINARY "'").out;
  };
  EXPECT_EQ(offered("treacle conv", 1), "convergence\n");
  EXPECT_EQ(offered("treacle run --bac", 2), "--backend\n");
  EXPECT_EQ(offered("treacle run --backend cu", 3), "cuda\n");
  EXPECT_EQ(offered("treacle check ask", 2), "ask.sh\n");
  EXPECT_EQ(offered("treacle completion f", 2), "fish\n");
  EXPECT_THAT(shop.call("completion zsh").out, HasSubstr("'check:Check a case"));
  EXPECT_THAT(shop.call("completion fish").out,
              HasSubstr("__fish_seen_subcommand_from plot' -l field -xa 'speed "));
  EXPECT_EQ(shop.call("completion tcsh").exitCode, 2);
}

TEST(man, hasEveryCommandAndOption) {
  Workshop shop;
  const std::string page = shop.call("man").out;
  EXPECT_THAT(page, StartsWith(".TH TREACLE 1 "));
  for (const char* command : {"run", "check", "plot", "surface", "compare", "convergence", "import", "keys",
                              "schema", "completion", "man", "info"})
    EXPECT_THAT(page, HasSubstr(std::string(".SS treacle ") + command + '\n'));
  EXPECT_THAT(page, HasSubstr("\\fB\\-\\-resume\\fR \\fIFILE\\fR"));
}

TEST(run, automaticStepsMeetFramesAndEnd) {
  Workshop shop;
  const Outcome outcome = withSmallCase(shop).call(
      "run small.toml --threads 1 --set time.step=auto --set output.interval=3e-3 --end-time 1e-2");
  ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
  EXPECT_THAT(outcome.err, IsEmpty());
  EXPECT_THAT(outcome.out,
              HasSubstr("64 wall particles, steps of 2e-07 to 0.002 s, for errors of 0.02, to 0.01 s"));
  const RunDirectory run = RunDirectory::open(shop / "small-run");
  ASSERT_EQ(run.frameCount(), 5u);
  for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(run.frameTime(k), 3e-3 * static_cast<double>(k));
  EXPECT_EQ(run.frameTime(4), 1e-2);
  const auto rows = readHistory(run.history());
  double least = 1, longest = 0, time = 0;
  for (const HistoryRow& row : rows) {
    EXPECT_NEAR(row.time, time + row.timeStep, 1e-15);
    time = row.time;
    least = std::min(least, row.timeStep), longest = std::max(longest, row.timeStep);
  }
  EXPECT_LT(2 * rows[0].timeStep, longest) << "from rest";
  const auto summary = nlohmann::json::parse(shop.content("small-run/summary.json"));
  EXPECT_EQ(summary["time_step"]["least"], least);
  EXPECT_EQ(summary["time_step"]["longest"], longest);
  EXPECT_NEAR(summary["time_step"]["mean"], 1e-2 / static_cast<double>(rows.size()), 1e-12);
  const int rejected = summary["rejected_steps"];
  EXPECT_GT(rejected, 0);
  EXPECT_THAT(outcome.out, HasSubstr(fmt::format("done: {} steps ({} rejected) in ", rows.size(), rejected)));
}

TEST(run, leavesAllFiles) {
  Workshop shop;
  const Outcome outcome = withSmallCase(shop).call("run small.toml --threads 1 -o out/here --end-time 3e-3");
  EXPECT_EQ(outcome.exitCode, 0);
  EXPECT_THAT(outcome.err, IsEmpty());
  EXPECT_THAT(outcome.out,
              StartsWith("Small dam break: 36 fluid and 64 wall particles, 3 steps of 0.001 s, into "));
  EXPECT_THAT(outcome.out, HasSubstr("step 3/3  t = 0.003 s"));
  EXPECT_THAT(outcome.out, HasSubstr("picture: out/here/final.png\nParaView: out/here/fluid.pvd\n"));
  EXPECT_EQ(outcome.out.find('\r'), outcome.out.npos) << "no rewritten lines where stdout is no terminal";

  const RunDirectory run = RunDirectory::open(shop / "out/here");
  ASSERT_EQ(run.frameCount(), 4u);
  for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(run.frameTime(k), 1e-3 * static_cast<double>(k), 1e-12);
  const Frame first = readVtp(run.fluidFrame(0)), last = readVtp(run.fluidFrame(3));
  EXPECT_EQ(first.position.size(), 36u);
  EXPECT_EQ(readVtp(run.wallsFrame(3)).position.size(), 64u);
  EXPECT_NE(first.position, last.position);

  const auto rows = readHistory(run.history());
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[2].step, 3);
  EXPECT_GT(rows[0].iterations, 1);
  EXPECT_LE(rows[0].residual, 1e-12);
  EXPECT_EQ(readCase(run.caseFile()).time.end, 3e-3);
  EXPECT_THAT(shop.content("out/here/final.png"), StartsWith(std::string(pngSignature)));
  const std::string summary = shop.content("out/here/summary.json");
  EXPECT_THAT(summary, HasSubstr("\"status\": \"done\""));
  EXPECT_THAT(summary, HasSubstr("\"steps\": 3"));
  EXPECT_THAT(summary, HasSubstr("\"threads\": 1"));
  EXPECT_THAT(summary, HasSubstr("\"output_thread_seconds\": "));
  std::uintmax_t frames = 0;
  for (const auto& entry : std::filesystem::directory_iterator(run.path() / "frames")) frames += entry.file_size();
  EXPECT_THAT(summary, HasSubstr("\"count\": 4,\n    \"bytes\": " + std::to_string(frames) + ","));
  const std::string log = shop.content("out/here/run.log");
  EXPECT_THAT(log, HasSubstr("frame 0: step 0, t = 0 s, 0 iterations"));
  EXPECT_THAT(log, HasSubstr("frame 3: step 3, t = 0.003 s, "));
  EXPECT_THAT(log, HasSubstr("done: 3 steps"));
}

TEST(run, historyHasTheTimingsThatWereAskedFor) {
  Workshop shop;
  ASSERT_EQ(withSmallCase(shop).call("run small.toml --threads 1 --quiet --timings").exitCode, 0);
  const auto rows = readHistory(shop / "small-run/history.csv");
  ASSERT_EQ(rows.size(), 2u);
  for (const HistoryRow& row : rows) {
    const HistoryTimings& t = row.timings;
    for (const double seconds : {t.search, t.lists, t.coefficients, t.coarse, t.solve, t.update})
      EXPECT_GT(seconds, 0);
    EXPECT_NEAR(t.search + t.lists + t.coefficients + t.coarse + t.solve + t.update, row.seconds,
                1e-9 * row.seconds);
  }
  ASSERT_EQ(shop.call("run small.toml --threads 1 --quiet -o plain").exitCode, 0);
  EXPECT_EQ(shop.call("compare small-run plain --bound 0").exitCode, 0);
}

TEST(run, framesFollowSimulationTime) {
  Workshop shop;
  // Steps of 0.7 ms; the multiples of 1 ms fall to steps 1 (0.7), 3 (2.1), 4 (2.8); then the end, step 5.
  withSmallCase(shop).call("run small.toml --threads 1 --set time.step=7e-4 --end-time 3.5e-3");
  const RunDirectory run = RunDirectory::open(shop / "small-run");
  std::vector<int> steps;
  for (std::size_t k = 0; k < run.frameCount(); ++k)
    steps.push_back(static_cast<int>(std::lround(run.frameTime(k) / 7e-4)));
  EXPECT_THAT(steps, testing::ElementsAre(0, 1, 3, 4, 5));
  EXPECT_EQ(shop.call("run small.toml --threads 1 --force --set output.interval=0").exitCode, 0);
  EXPECT_EQ(RunDirectory::open(shop / "small-run").frameCount(), 2u);
}

TEST(run, stepsFollowTheCourantNumberAndMeetTheEnd) {
  Workshop shop;
  const Outcome outcome =
      withSmallCase(shop).call("run small.toml --threads 1 --set time.courant=0.002 --end-time 4e-3");
  ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
  EXPECT_THAT(outcome.err, IsEmpty());
  EXPECT_THAT(outcome.out,
              HasSubstr("64 wall particles, steps of at most 0.001 s and Courant number 0.002 to 0.004 s"));
  EXPECT_THAT(outcome.out, HasSubstr("  t = 0.004 s (100 %)  "));
  const RunDirectory run = RunDirectory::open(shop / "small-run");
  const auto rows = readHistory(run.history());
  ASSERT_GT(rows.size(), 4u);
  double time = 0, speed = 0;
  for (const HistoryRow& row : rows) {
    EXPECT_LE(row.timeStep, 1e-3);
    EXPECT_LE(row.timeStep * speed, 0.002 * 1e-3 * (1 + 1e-9));
    EXPECT_NEAR(row.time, time + row.timeStep, 1e-15);
    time = row.time, speed = row.maxSpeed;
  }
  EXPECT_EQ(rows[0].timeStep, 1e-3);
  EXPECT_NEAR(time, 4e-3, 1e-15);
  // The frame of a multiple of 1 ms is the first one that is not before it.
  ASSERT_EQ(run.frameCount(), 5u);
  for (std::size_t k = 1; k < 5; ++k) {
    EXPECT_GE(run.frameTime(k), 1e-3 * static_cast<double>(k) * (1 - 1e-9));
    EXPECT_LT(run.frameTime(k), 1e-3 * static_cast<double>(k) + 1e-3);
  }
}

TEST(run, quietPrintsNothing) {
  Workshop shop;
  const Outcome outcome = withSmallCase(shop).call("run small.toml --threads 1 --quiet");
  EXPECT_EQ(outcome.exitCode, 0);
  EXPECT_THAT(outcome.out, IsEmpty());
  EXPECT_THAT(outcome.err, IsEmpty());
}

TEST(run, resolvedCaseGivesTheSameRun) {
  Workshop shop;
  ASSERT_EQ(
      withSmallCase(shop).call("run small.toml --threads 1 --set resolution=2 --set syrup.density=1200").exitCode,
      0);
  ASSERT_EQ(shop.call("run small-run/case.toml --threads 1 -o again").exitCode, 0);
  for (const char* frame : {"fluid_000000.vtp", "fluid_000002.vtp", "walls_000002.vtp"})
    EXPECT_EQ(shop.content(std::string("small-run/frames/") + frame),
              shop.content(std::string("again/frames/") + frame));
}

TEST(run, withoutConvergenceFailsAndKeepsTheLastGoodState) {
  Workshop shop;
  const Outcome outcome = withSmallCase(shop).call("run small.toml --threads 1 --set solver.max_iterations=3");
  EXPECT_EQ(outcome.exitCode, 3);
  EXPECT_THAT(outcome.err, StartsWith("treacle: error: after step 0 (t = 0 s): "));
  EXPECT_THAT(outcome.err, HasSubstr("The last state written is frame 0 (t = 0 s) in small-run"));
  EXPECT_EQ(RunDirectory::open(shop / "small-run").frameCount(), 1u);
  const std::string summary = shop.content("small-run/summary.json");
  EXPECT_THAT(summary, HasSubstr("\"status\": \"failed\""));
  EXPECT_THAT(summary, HasSubstr("after step 0"));
  EXPECT_THAT(shop.content("small-run/run.log"), HasSubstr("error: after step 0"));
}

TEST(run, warnsOnceOfFallbacksAndCountsThem) {
  Workshop shop;
  const Outcome outcome =
      withSmallCase(shop).call("run small.toml --threads 1 --set solver.projected.iteration_bound=2 -o fallbacks");
  EXPECT_EQ(outcome.exitCode, 0);
  const std::string warning = "step 1: the linear solver had to fall back after cg, projected-multigrid, mixed";
  EXPECT_THAT(outcome.err, StartsWith("treacle: warning: " + warning));
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  const std::string log = shop.content("fallbacks/run.log");
  EXPECT_THAT(log, HasSubstr("info: solver: cg, projected-multigrid, mixed: pressure degree "));
  EXPECT_THAT(log, HasSubstr("warning: " + warning));
  for (const HistoryRow& row : readHistory(shop / "fallbacks/history.csv")) EXPECT_EQ(row.fallbacks, 2);
  EXPECT_THAT(shop.content("fallbacks/summary.json"), HasSubstr("\"fallbacks\": 4"));

  ASSERT_EQ(shop.call("run small.toml --threads 1 -o plain").exitCode, 0);
  for (const HistoryRow& row : readHistory(shop / "plain/history.csv")) EXPECT_EQ(row.fallbacks, 0);
  EXPECT_EQ(shop.call("compare fallbacks plain --quiet").exitCode, 0);
}

TEST(run, particleThatLeavesOpenDomainEndsTheRun) {
  Workshop shop;
  const Outcome outcome =
      withSmallCase(shop).call("run small.toml --threads 1 --end-time 0.02 --set 'column.velocity=[0,9]'");
  EXPECT_EQ(outcome.exitCode, 3);
  EXPECT_THAT(outcome.err, HasSubstr("domain"));
  const RunDirectory run = RunDirectory::open(shop / "small-run");
  const Frame last = readVtp(run.fluidFrame(run.frameCount() - 1));
  for (const Vec<3>& x : last.position) EXPECT_LE(x[1], 12e-3);
}

TEST(run, stopsOnSignalAfterTheStepWithLastFrameCheckpointAndSummary) {
  for (const char* signal : {"INT", "TERM", "HUP"}) {
    Workshop shop;
    const std::string script = std::string(
                                   "run small.toml --threads 1 --quiet --end-time 3 & run=$!; "
                                   "while [ ! -s small-run/history.csv ]; do sleep 0.05; done; sleep 0.3; "
                                   "kill -") +
                               signal + " $run; wait $run";
    const Outcome outcome = withSmallCase(shop).call(script);
    EXPECT_EQ(outcome.exitCode, 3);
    const std::string summary = shop.content("small-run/summary.json");
    EXPECT_THAT(summary, HasSubstr("\"status\": \"failed\""));
    EXPECT_THAT(summary, HasSubstr(std::string("stopped by SIG") + signal));
    const RunDirectory run = RunDirectory::open(shop / "small-run");
    const auto rows = readHistory(run.history());
    ASSERT_FALSE(rows.empty());
    EXPECT_EQ(run.frameTime(run.frameCount() - 1), rows.back().time);
    EXPECT_EQ(readCheckpoint<2>(run.checkpoint()).time, rows.back().time);
  }
}

TEST(run, goesOnWhereTheTerminalIsGoneAndHangUpsAreIgnored) {
  Workshop shop;
  const Outcome outcome = withSmallCase(shop).call(
      "run small.toml --threads 1 --quiet --end-time 30 & run=$!; "
      "while [ ! -s small-run/history.csv ]; do sleep 0.05; done; kill -HUP $run; sleep 0.3; kill -TERM $run; "
      "wait $run",
      "trap '' HUP;");
  EXPECT_EQ(outcome.exitCode, 3);
  EXPECT_THAT(shop.content("small-run/summary.json"), HasSubstr("stopped by SIGTERM"));
}

TEST(run, whoseHistoryIsRemovedFailsAndKeepsTheLastGoodState) {
  Workshop shop;
  const Outcome outcome = withSmallCase(shop).call(
      "run small.toml --threads 1 --quiet --end-time 30 & run=$!; "
      "while [ ! -s small-run/history.csv ]; do sleep 0.05; done; rm small-run/history.csv; wait $run");
  EXPECT_EQ(outcome.exitCode, 3);
  EXPECT_THAT(outcome.err, HasSubstr("cannot write small-run/history.csv: it was removed while the run went on"));
  EXPECT_GT(readCheckpoint<2>(shop / "small-run/checkpoint.h5").step, 0);
}

TEST(run, leavesTheDirectoryOfAnotherOneAlone) {
  Workshop shop;
  const Outcome outcome = withSmallCase(shop).call(
      "run small.toml --threads 1 --quiet --end-time 30 & run=$!; "
      "while [ ! -s small-run/history.csv ]; do sleep 0.05; done; "
      "'" TREACLE_BINARY "' run small.toml --threads 1 --force; echo code $?; kill -TERM $run; wait $run");
  EXPECT_THAT(outcome.out, HasSubstr("code 2\n"));
  EXPECT_THAT(outcome.err, HasSubstr("output directory small-run: another run is writing into it"));
  EXPECT_FALSE(readHistory(shop / "small-run/history.csv").empty());
  EXPECT_EQ(shop.call("run small.toml --threads 1 --force").exitCode, 0) << "the lock goes with the run";
}

TEST(run, needsThreadsThatTheMachineStarts) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the address sanitizer needs more address space than the limit of this test";
#endif
  Workshop shop;
  Outcome outcome = withSmallCase(shop).call("run small.toml --threads 300", "ulimit -s 8192; ulimit -v 1000000;");
  EXPECT_EQ(outcome.exitCode, 2);
  EXPECT_THAT(outcome.err, ContainsRegex("--threads 300: this machine starts no more than [0-9]+ threads"));
  for (const char* command : {"run small.toml", "check small.toml", "compare a b"}) {
    outcome = shop.call(command, "export OMP_NUM_THREADS=100000;");
    EXPECT_EQ(outcome.exitCode, 2) << command;
    EXPECT_THAT(outcome.err, HasSubstr("OMP_NUM_THREADS: expected at most 1024 threads, found 100000"));
  }
}

TEST(check, warnsWhereThisMachineHasNotTheMemory) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the address sanitizer needs more address space than the limit of this test";
#endif
  Workshop shop;
  const Outcome outcome =
      withSmallCase(shop).call("check small.toml --set domain.max=[30,30]", "ulimit -v 800000;");
  EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
  EXPECT_THAT(outcome.err, ContainsRegex("warning: 100 particles and 3.* search cells of the domain need about "));
}

TEST(run, caseThatDoesNotFitIntoMemoryIsRefused) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the address sanitizer needs more address space than the limit of this test";
#endif
  Workshop shop;
  // 3.8 million particles; the limit leaves room to create them, not to run them.
  const Outcome outcome = withSmallCase(shop).call("run small.toml --backend cpu --threads 1 --set resolution=200",
                                                   "ulimit -v 1500000;");
  EXPECT_EQ(outcome.exitCode, 3);
  EXPECT_THAT(outcome.err, HasSubstr("particles need about "));
  EXPECT_THAT(outcome.err, HasSubstr("available"));
  EXPECT_FALSE(std::filesystem::exists(shop / "small-run"));
}

TEST(plot, drawsFrames) {
  Workshop shop;
  ASSERT_EQ(withSmallCase(shop).call("run small.toml --threads 1 --quiet").exitCode, 0);
  EXPECT_EQ(shop.call("plot small-run --frame 1 --field pressure").out, "small-run/frames/fluid_000001.png\n");
  EXPECT_THAT(shop.content("small-run/frames/fluid_000001.png"), StartsWith(std::string(pngSignature)));
  for (const char* own : {"case.toml", "checkpoint.h5", "history.csv", "fluid.pvd", "frames/fluid_000001.vtp"}) {
    const std::string before = shop.content(std::string("small-run/") + own);
    const Outcome refused = shop.call(std::string("plot small-run -o small-run/") + own);
    EXPECT_EQ(refused.exitCode, 2) << own;
    EXPECT_THAT(refused.err, HasSubstr("a run has written this file; choose another name"));
    EXPECT_EQ(shop.call(std::string("compare small-run small-run --csv ./small-run/") + own).exitCode, 2) << own;
    EXPECT_EQ(shop.content(std::string("small-run/") + own), before);
  }
  const Outcome kind = shop.call("plot small-run -o picture.pdf");
  EXPECT_EQ(kind.exitCode, 2);
  EXPECT_THAT(kind.err, HasSubstr("--output picture.pdf: pictures of frames are PNG"));
  EXPECT_EQ(shop.call("plot small-run -o last.png").exitCode, 0);
  EXPECT_THAT(shop.content("last.png"), StartsWith(std::string(pngSignature)));
  Frame odd = readVtp(shop / "small-run/frames/fluid_000001.vtp");
  odd.position[7][1] = std::nan("");
  writeVtp(shop / "small-run/frames/fluid_000001.vtp", odd, {}, OutputPrecision::Single);
  EXPECT_EQ(shop.call("plot small-run --frame 1").err,
            "treacle: warning: frame 1: 1 particle without a position that can be drawn\n");
  const Outcome outcome = shop.call("plot small-run --frame 9");
  EXPECT_EQ(outcome.exitCode, 2);
  EXPECT_THAT(outcome.err, HasSubstr("--frame 9: expected 'last' or a number from 0 to 2"));
}

}  // namespace
}  // namespace treacle::test
