#include "treacle/io/tables/convergence.hpp"

#include "support/temporary_directory.hpp"

#include <gtest/gtest.h>

namespace treacle::test {
namespace {

std::vector<ConvergenceCurve> curves() {
  return {{"cg, none, double", "iteration limit", {1, 0.5, 2e-3}, 0, 0.125},
          {"say \"cg\"", "converged", {0.1, 1e-7}, 0.25, 1e-3}};
}

TEST(Convergence, TablesHaveAFixedFormat) {
  TemporaryDirectory directory;
  writeConvergence(directory / "a.csv", curves());
  EXPECT_EQ(content(directory / "a.csv"),
            "solver,iteration,relative_residual\n"
            "\"cg, none, double\",0,1\n\"cg, none, double\",1,0.5\n\"cg, none, double\",2,0.002\n"
            "\"say \"\"cg\"\"\",0,0.1\n\"say \"\"cg\"\"\",1,1e-07\n");
  writeSolvers(directory / "b.csv", curves());
  EXPECT_EQ(
      content(directory / "b.csv"),
      "solver,outcome,iterations,relative_residual,setup_s,solve_s\n"
      "\"cg, none, double\",iteration limit,2,0.002,0,0.125\n\"say \"\"cg\"\"\",converged,1,1e-07,0.25,0.001\n");
}

}  // namespace
}  // namespace treacle::test
