#include "support/isph_cases.hpp"
#include "treacle/core/error.hpp"
#include "treacle/core/pseudo_random.hpp"
#include "treacle/step/method/solve_stages.hpp"

#include <gtest/gtest.h>

namespace treacle::test {
namespace {

TEST(IsphStages, OfTheHatMultigridAreExactAndThenPlain) {
  Case c = tankCase(2, 10, 8);
  c.solver.hats.iterationBound = 50;
  c.solver.maxIterations = 700;
  std::vector<SolverSettings> stages = solveStages(c);
  ASSERT_EQ(stages.size(), 3u);
  EXPECT_EQ(solverText(stages[0]), "cg, hat-multigrid, mixed: grid degree 1");
  EXPECT_EQ(solverText(stages[1]), "cg, hat-multigrid, double: grid degree 2");
  EXPECT_EQ(solverText(stages[2]), "cg, jacobi, double");
  EXPECT_EQ(stages[0].maxIterations, 50);
  EXPECT_EQ(stages[1].maxIterations, 50);
  EXPECT_EQ(stages[2].maxIterations, 700);
  c.solver.maxIterations = 20;
  for (const SolverSettings& stage : solveStages(c)) EXPECT_EQ(stage.maxIterations, 20);
  for (const auto k : {PreconditionerKind::None, PreconditionerKind::Jacobi, PreconditionerKind::CellMultigrid}) {
    c.solver.preconditioner = k;
    EXPECT_EQ(solveStages(c), std::vector{c.solver});
  }
}

TEST(IsphFailure, OfTheSolverNamesTheEquationAndKeepsTheLastGoodState) {
  for (const bool viscous : {false, true}) {
    Case c = tankCase(2, 14, 10);
    c.solver.maxIterations = 1;
    c.method.isph.alpha = 0;  // nothing to solve for in the arrangement
    if (viscous) c.materials[0].dynamicViscosity = 1e4;
    const Particles<2> before = created<2>(c);
    Particles<2> start = copyOf(before);
    for (std::uint32_t i = 0; viscous && i < start.fluidCount; ++i) start.velocity[i][0] = pseudoRandom(i);
    const Particles<2> state = copyOf(start);
    Simulation<2> simulation(c, std::move(start));
    std::string message = "no failure";
    try {
      simulation.advance();
    } catch (const RunError& error) {
      message = error.what();
    }
    EXPECT_EQ(message.find(viscous ? "viscosity: " : "pressure: "), 0u) << message;
    for (const char* part : {"did not converge", "hat-multigrid, mixed", "hat-multigrid, double"})
      EXPECT_NE(message.find(part), std::string::npos) << message;
    EXPECT_EQ(simulation.step(), 0);
    EXPECT_EQ(simulation.time(), 0);
    const Particles<2>& p = simulation.particles();
    for (std::uint32_t i = 0; i < p.count; ++i) {
      ASSERT_EQ(p.position[i], state.position[p.id[i]]);
      ASSERT_EQ(p.velocity[i], state.velocity[p.id[i]]);
      ASSERT_EQ(p.pressure[i], 0);
    }
  }
}

TEST(IsphFailure, NamesAValueThatIsNotFinite) {
  Case c = tankCase(2, 14, 10);
  Particles<2> p = created<2>(c);
  p.velocity[75][0] = NAN;
  Simulation<2> simulation(c, std::move(p));
  std::string message = "no failure";
  try {
    simulation.advance();
  } catch (const RunError& error) {
    message = error.what();
  }
  EXPECT_NE(message.find("not finite"), std::string::npos) << message;
  EXPECT_NE(message.find("particle 75"), std::string::npos) << message;
}

TEST(IsphFailure, FallbacksAreCountedAndSolveTheSameEquation) {
  Case c = tankCase(2, 24, 20);
  c.solver.tolerance = 1e-20;
  Simulation<2> direct(c, created<2>(c));
  const StepReport plain = direct.advance();
  EXPECT_EQ(plain.fallbacks, 0) << plain.failures;
  c.solver.hats.iterationBound = 2;
  Simulation<2> fallen(c, created<2>(c));
  for (int step = 1; step <= 2; ++step) {
    const StepReport report = fallen.advance();
    EXPECT_EQ(report.fallbacks, 2) << "step " << step;
    EXPECT_GT(report.iterations, 4);
    EXPECT_NE(report.failures.find("hat-multigrid, double"), std::string::npos) << report.failures;
    if (step > 1) continue;
    double apart = 0, most = 0;
    for (std::uint32_t i = 0; i < fallen.particles().fluidCount; ++i) {
      ASSERT_EQ(fallen.particles().id[i], direct.particles().id[i]);
      apart = std::max(apart, std::abs(fallen.particles().pressure[i] - direct.particles().pressure[i]));
      most = std::max(most, direct.particles().pressure[i]);
    }
    EXPECT_LE(apart, 1e-7 * most);  // measured: 2e-8
  }
}

}  // namespace
}  // namespace treacle::test
