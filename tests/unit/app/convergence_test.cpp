#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

#include "command.hpp"
#include "treacle/core/timer.hpp"
#include "treacle/io/case/case_reader.hpp"
#include "treacle/model/particles/create.hpp"
#include "treacle/step/run/simulation.hpp"

namespace treacle::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

/// A row of solvers.csv, and its curve; the name stands in quotes.
struct Row {
  std::string solver, outcome;
  int iterations = 0;
  double residual = 0, setup = 0, solve = 0;
  std::vector<double> curve;
};

/// The lines after the first, as the name and the rest of each.
std::vector<std::pair<std::string, std::string>> namedLines(const std::string& text, const std::string& header) {
  std::istringstream lines(text);
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line, header);
  std::vector<std::pair<std::string, std::string>> named;
  while (std::getline(lines, line)) {
    const std::size_t quote = line.find('"', 1);
    named.emplace_back(line.substr(1, quote - 1), line.substr(quote + 2));
  }
  return named;
}

std::vector<Row> solversOf(const std::string& text) {
  std::vector<Row> rows;
  for (const auto& [name, values] :
       namedLines(text, "solver,outcome,iterations,relative_residual,setup_s,solve_s")) {
    Row row;
    row.solver = name;
    std::istringstream rest(values);
    std::getline(rest, row.outcome, ',');
    char comma = 0;
    rest >> row.iterations >> comma >> row.residual >> comma >> row.setup >> comma >> row.solve;
    EXPECT_TRUE(rest) << values;
    rows.push_back(row);
  }
  return rows;
}

/// The curves of convergence.csv, one after the other, each from iteration 0 on.
void readCurves(const std::string& text, std::vector<Row>& rows) {
  std::size_t next = 0;
  for (const auto& [name, values] : namedLines(text, "solver,iteration,relative_residual")) {
    const bool first = values.starts_with("0,");
    ASSERT_LT(next, rows.size() + !first);
    Row& row = rows[first ? next++ : next - 1];
    EXPECT_EQ(name, row.solver);
    EXPECT_EQ(std::stoul(values), row.curve.size());
    row.curve.push_back(std::stod(values.substr(values.find(',') + 1)));
  }
  EXPECT_EQ(next, rows.size());
}

/// Calls the command, and looks at its files: every curve goes from iteration 0 to the end that the table tells.
std::vector<Row> rowsOf(const Workshop& shop, const std::string& arguments, const std::string& directory) {
  Timer timer;
  const std::string noPicture = "export TREACLE_PYTHON=true;";
  const Outcome outcome = shop.call("convergence " + arguments + " --backend cpu --threads 1", noPicture);
  const double seconds = timer.lap();
  EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
  EXPECT_THAT(outcome.err, IsEmpty());
  EXPECT_THAT(outcome.out, HasSubstr("iterations  |r| / |b|  set-up [ms]  solve [ms]\n"));
  std::vector<Row> rows = solversOf(shop.content(directory + "/solvers.csv"));
  readCurves(shop.content(directory + "/convergence.csv"), rows);
  double inRows = 0;
  for (const Row& row : rows) {
    EXPECT_EQ(row.curve.size(), static_cast<std::size_t>(row.iterations) + 1);
    EXPECT_EQ(row.curve.back(), row.residual);
    EXPECT_THAT(outcome.out, testing::ContainsRegex("\n" + row.solver.substr(0, row.solver.find(" (")) + " "));
    EXPECT_THAT(outcome.out, HasSubstr(fmt::format("  {:10}  {:9.2e}  {:11.3f}  {:10.3f}", row.iterations,
                                                   row.residual, 1e3 * row.setup, 1e3 * row.solve)));
    inRows += row.setup + row.solve;
  }
  EXPECT_GT(inRows, 0);
  EXPECT_LT(inRows, seconds);
  return rows;
}

/// What the same solvers do with the system after so many steps of the small case, by the library.
void expectTrials(const Workshop& shop, const std::vector<Row>& rows, int steps,
                  const std::vector<std::vector<std::string>>& settings) {
  const Case c = readCase(shop / "small.toml", std::vector<std::string>{"solver.precision=double"});
  std::vector<SolverSettings> solvers;
  for (std::vector<std::string> own : settings) {
    own.insert(own.begin(), "solver.precision=double");
    solvers.push_back(readCase(shop / "small.toml", own).solver);
  }
  std::vector<std::string> notes;
  Simulation<2> simulation(c, createParticles<2>(c, notes));
  for (int k = 0; k < steps; ++k) simulation.advance();
  const std::vector<SolverTrial> trials = simulation.convergence(solvers);
  ASSERT_EQ(trials.size(), rows.size());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    SCOPED_TRACE(rows[k].solver);
    EXPECT_EQ(rows[k].iterations, trials[k].report.iterations);
    EXPECT_EQ(rows[k].residual, std::sqrt(trials[k].report.residual));
    EXPECT_EQ(rows[k].curve, trials[k].residuals);
  }
}

TEST(convergence, comparesTheSolversOfEachMethod) {
  Workshop shop;
  shop.put("small.toml", smallCase);
  shop.put("water.toml", smallIsphCase);
  for (const auto& [name, own] : {std::pair{"small", "projected-multigrid"}, {"water", "hat-multigrid"}}) {
    const std::string file = name;  // of shorter steps ISPH does not warn
    const std::vector<Row> rows = rowsOf(shop, file + ".toml --set time.step=1e-4", file + "-convergence");
    ASSERT_EQ(rows.size(), 5u);
    for (const Row& row : rows) {
      EXPECT_EQ(row.outcome, "converged") << row.solver;
      // It ends with the first residual below the tolerance.
      EXPECT_LE(row.residual, 1e-6);
      EXPECT_GT(row.curve.end()[-2], 1e-6);
      EXPECT_EQ(row.curve.front(), rows.front().curve.front()) << "another first guess";
    }
    EXPECT_THAT(rows.front().solver, HasSubstr("none"));
    EXPECT_THAT(rows.back().solver, HasSubstr(own));
    EXPECT_LT(rows.back().iterations, rows.front().iterations);
  }
}

TEST(convergence, takesSolversTimeAndCheckpoint) {
  Workshop shop;
  shop.put("small.toml", smallCase);
  const std::string solvers =
      " --solver 'krylov=cg preconditioner=block-jacobi tolerance=1e-8' --solver 'max_iterations=1' --solver ''"
      " --solver 'multigrid.finest_sweeps=1' -o out/a";
  const std::vector<Row> rows = rowsOf(shop, "small.toml --at 2e-3 --precision double" + solvers, "out/a");
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_EQ(rows[0].solver, "cg, block-jacobi, double");
  EXPECT_LE(rows[0].residual, 1e-4);
  EXPECT_EQ(rows[1].outcome, "iteration limit");
  EXPECT_EQ(rows[1].iterations, 1);
  EXPECT_EQ(rows[2].outcome, "converged");
  expectTrials(shop, rows, 2,
               {{"solver.krylov=cg", "solver.preconditioner=block-jacobi", "solver.tolerance=1e-8"},
                {"solver.max_iterations=1"},
                {},
                {"solver.multigrid.finest_sweeps=1"}});
  // Two that differ in what their name does not say, and one that has the same name.
  EXPECT_THAT(rows[1].solver, testing::EndsWith(" (1)"));
  EXPECT_THAT(rows[3].solver, testing::EndsWith(" (3)"));

  // A time that is nearer to the start than to the first step.
  const std::string plain = "small.toml --solver '' -o out/a";
  EXPECT_EQ(rowsOf(shop, plain + " --at 4e-4", "out/a")[0].residual, rowsOf(shop, plain, "out/a")[0].residual);

  // The same system from a checkpoint, without --at and with it.
  ASSERT_EQ(shop.call("run small.toml --quiet --threads 1 --precision double --backend cpu").exitCode, 0);
  const std::string resumed = "small.toml --resume small-run/checkpoint.h5 --precision double" + solvers;
  EXPECT_EQ(rowsOf(shop, resumed, "out/a")[0].residual, rows[0].residual);
  EXPECT_EQ(rowsOf(shop, resumed + " --at 2e-3", "out/a")[0].residual, rows[0].residual);
  EXPECT_NE(rowsOf(shop, resumed + " --at 3e-3", "out/a")[0].residual, rows[0].residual);
  const Outcome early = shop.call("convergence --at 1e-3 " + resumed);
  EXPECT_EQ(early.exitCode, 2);
  EXPECT_THAT(early.err, HasSubstr("--at: expected at least the checkpoint's time, 0.002 s, found 0.001"));
}

TEST(convergence, badSolversAreBadInput) {
  Workshop shop;
  shop.put("small.toml", smallCase);
  const auto expectRefused = [&](const std::string& arguments, const std::string& message) {
    const Outcome outcome = shop.call("convergence small.toml " + arguments);
    EXPECT_EQ(outcome.exitCode, 2) << arguments;
    EXPECT_THAT(outcome.err, HasSubstr(message));
    EXPECT_FALSE(std::filesystem::exists(shop / "small-convergence"));
  };
  expectRefused(
      "--solver krilov=cg",
      "treacle: error: --solver \"krilov=cg\": unknown key 'krilov' in [solver]; did you mean 'krylov'?");
  expectRefused(
      "--solver 'krylov=cg precision=half'",
      "--solver \"krylov=cg precision=half\": precision in [solver]: expected 'mixed' or 'double', found "
      "'half'");
  expectRefused("--solver cg", "--solver \"cg\": expected key=value");
  expectRefused("--solver cells.levels=1", "unknown key 'cells' in [solver]: it belongs to the method 'isph'");
  expectRefused("--solver first_guess=last", "first_guess: is the same for all solvers of a comparison");
  expectRefused("--solver neighbours=ranges", "change it in the case, --set solver.neighbours");
  expectRefused("--at=-1", "--at: expected a number not less than 0, found '-1'");
  expectRefused("--at 1e300", "--at: 1e+303 steps to it are too many");
  expectRefused("--resume none.h5", "none.h5");
  expectRefused("--output small.toml", "output directory small.toml: cannot be created");
}

TEST(convergence, aRunThatFailsOnTheWaySaysWhere) {
  Workshop shop;
  shop.put("small.toml", smallCase);
  const Outcome outcome = shop.call(
      "convergence small.toml --at 2e-3 --backend cpu --set solver.preconditioner=none --set "
      "solver.max_iterations=2");
  EXPECT_EQ(outcome.exitCode, 3);
  EXPECT_THAT(outcome.err,
              StartsWith("treacle: error: after step 0 (t = 0 s): the linear solver did not converge"));
}

}  // namespace
}  // namespace treacle::test
