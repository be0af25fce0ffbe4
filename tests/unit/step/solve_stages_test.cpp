#include "treacle/step/method/solve_stages.hpp"

#include "method/mph_solver.hpp"
#include "support/oracle.hpp"
#include "treacle/step/run/simulation.hpp"

#include <gtest/gtest.h>

namespace treacle::test {
namespace {

TEST(SolveStages, OfTheProjectedMultigridAreStrongerAndThenAnotherPreconditioner) {
  Case c = sceneCase(3);
  c.solver.projected = {6, 3, 2, 50};
  c.solver.maxIterations = 700;
  const std::vector<SolverSettings> stages = solveStages(c);
  ASSERT_EQ(stages.size(), 3u);
  EXPECT_EQ(solverText(stages[0]),
            "cg, projected-multigrid, mixed: pressure degree 6, grid degree 3, velocity degree 2, "
            "deflation by up to 8 modes");
  EXPECT_EQ(solverText(stages[1]),
            "cg, projected-multigrid, double: pressure degree 12, grid degree 3, velocity degree 3");
  EXPECT_EQ(solverText(stages[2]), "cr, bucket-multigrid, double");
  EXPECT_EQ(stages[0].maxIterations, 50);
  EXPECT_EQ(stages[1].maxIterations, 50);
  EXPECT_EQ(stages[2].maxIterations, 700);
  c.solver.maxIterations = 20;
  for (const SolverSettings& stage : solveStages(c)) EXPECT_EQ(stage.maxIterations, 20);
}

TEST(SolveStages, DegreesAreChosenByTheStiffnessOfTheCase) {
  Case c = sceneCase(2);
  const auto pressureDegree = [&](double bulkViscosity) {
    c.materials[0].bulkViscosity = bulkViscosity;
    return solveStages(c).front().projected.pressureDegree;
  };
  EXPECT_GT(pressureDegree(1e3), 0);
  EXPECT_GT(pressureDegree(1e6), pressureDegree(1e4));
  const int single = pressureDegree(1e4);
  c.materials.push_back(c.materials[0]);
  EXPECT_EQ(pressureDegree(1e4), single);
  Material& thin = c.materials[1];  // as incompressible as the first, for its viscosity
  thin.density *= 1e-3, thin.dynamicViscosity *= 1e-4, thin.bulkViscosity *= 1e-4;
  EXPECT_GT(pressureDegree(1e4), 4 * single);
}

TEST(SolveStages, DegreesOfGasesUnderLiquidsCountTheViscosityOfLongSteps) {
  Case c = sceneCase(2, true, SchemeKind::Accurate);
  Material gas = c.materials[0];
  gas.density = 1, gas.dynamicViscosity = 1e-4;
  c.materials.push_back(gas);
  for (Material& m : c.materials) m.bulkViscosity = 100;
  c.gravity = {};
  c.bodies.resize(2);
  for (int k = 0; k < 2; ++k) {
    Body& body = c.bodies[k];
    body.kind = BodyKind::Fluid;
    body.material = k == 0 ? 2 : 0;
    body.shape.min = {0, 10.0 * k * c.spacing, 0}, body.shape.max = {c.spacing, 10.0 * (k + 1) * c.spacing, 0};
  }
  const auto degree = [&] { return solveStages(c).front().projected.pressureDegree; };
  const int without = degree();
  c.gravity[1] = -10;
  EXPECT_LT(degree(), 0.7 * without);
  c.gravity[1] = 10;  // the gas lies on the liquid
  EXPECT_EQ(degree(), without);
}

TEST(SolveStages, SystemsTooStiffForSinglePrecisionBeginInDouble) {
  Case c = sceneCase(2, false);
  EXPECT_EQ(solveStages(c).front().precision, Precision::Mixed);
  for (Material& m : c.materials) m.bulkViscosity = 1e8;
  EXPECT_EQ(solveStages(c).front().precision, Precision::Double);
}

TEST(SolveStages, OtherPreconditionersHaveNoFallback) {
  Case c = sceneCase(2);
  for (const auto k :
       {PreconditionerKind::None, PreconditionerKind::BlockJacobi, PreconditionerKind::BucketMultigrid}) {
    c.solver.preconditioner = k;
    EXPECT_EQ(solveStages(c), std::vector{c.solver});
  }
}

/// A u = b of one scene, b random of the size `scale`, from a first guess of zero.
template <int D>
struct System {
  Scene<D> s = makeScene<D>();
  std::vector<Vec<D>> b, u;

  explicit System(double scale = 1) : b(unflat<D>(scale * randomVector(s.unknowns(), 3))), u(s.n()) {}

  StagedReport solve() {
    MphSolver<D> solver(solveStages(s.c));
    solver.prepareOperator(s.context, s.pairs(), s.ranges(), s.terms());
    solver.preparePreconditioner(s.context);
    return solver.solve(s.context, b, u);
  }

  /// |b - A u|^2 / |b|^2 with the matrix from the formulas of the paper.
  double residual() const {
    const Vector right = flat<D>(b);
    return (right - Oracle<D>(s).matrix() * flat<D>(u)).squaredNorm() / right.squaredNorm();
  }
};

template <int D>
void checkChain() {
  System<D> direct;
  const StagedReport report = direct.solve();
  EXPECT_EQ(report.fallbacks, 0);
  EXPECT_EQ(report.failures, "");
  EXPECT_EQ(report.startResidual, 1);
  EXPECT_LT(direct.residual(), 2e-12);

  System<D> second;
  second.s.c.solver.projected.iterationBound = report.iterations - 1;
  const StagedReport once = second.solve();
  EXPECT_EQ(once.status, SolveStatus::Converged);
  EXPECT_EQ(once.fallbacks, 1) << once.failures;
  EXPECT_GE(once.iterations, report.iterations);
  EXPECT_LT(once.startResidual, 1e-10) << "did not go on where the first stage ended";
  EXPECT_LT(second.residual(), 2e-12);

  System<D> third;
  third.s.c.solver.projected.iterationBound = 2;
  const StagedReport twice = third.solve();
  EXPECT_EQ(twice.status, SolveStatus::Converged);
  EXPECT_EQ(twice.fallbacks, 2);
  EXPECT_GT(twice.iterations, report.iterations);
  EXPECT_LT(twice.startResidual, 1e-4);  // after four iterations; measured: 3e-6
  EXPECT_NE(twice.failures.find("projected-multigrid, mixed"), std::string::npos) << twice.failures;
  EXPECT_NE(twice.failures.find("projected-multigrid, double"), std::string::npos) << twice.failures;
  EXPECT_LT(third.residual(), 2e-12);
}

TEST(SolveStages, EachGoesOnWhereTheOneBeforeEnded) {
  checkChain<2>();
  checkChain<3>();
}

TEST(SolveStages, OverflowInSinglePrecisionIsSolvedInDouble) {
  System<2> system(1e42);
  const StagedReport report = system.solve();
  EXPECT_EQ(report.status, SolveStatus::Converged);
  EXPECT_EQ(report.fallbacks, 1);
  EXPECT_NE(report.failures.find("not finite"), std::string::npos) << report.failures;
  EXPECT_LT(system.residual(), 2e-12);
}

TEST(SolveStages, ARightHandSideThatIsNotFiniteIsNotTriedAgain) {
  System<2> system;
  system.b[7][1] = NAN;
  const StagedReport report = system.solve();
  EXPECT_EQ(report.status, SolveStatus::NotFinite);
  EXPECT_EQ(report.fallbacks, 0);
}

TEST(SolveStages, EveryStepBeginsWithTheFirst) {
  Scene<2> s = makeScene<2>();
  s.c.gravity[1] = -10;
  s.c.solver.projected.iterationBound = 2;
  Simulation<2> simulation(s.c, std::move(s.particles));
  for (int step = 1; step <= 3; ++step) EXPECT_EQ(simulation.advance().fallbacks, 2) << "step " << step;
}

}  // namespace
}  // namespace treacle::test
