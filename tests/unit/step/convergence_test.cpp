#include "support/isph_cases.hpp"
#include "support/oracle.hpp"
#include "support/same_bits.hpp"
#include "support/state_of.hpp"
#include "support/stretched_body.hpp"
#include "treacle/core/timer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace treacle::test {
namespace {

/// What every trial has, whatever became of it.
void checkCurve(const SolverTrial& trial) {
  SCOPED_TRACE(trial.solver);
  ASSERT_EQ(trial.residuals.size(), static_cast<std::size_t>(trial.report.iterations) + 1);
  EXPECT_EQ(trial.residuals.front(), std::sqrt(trial.report.startResidual));
  EXPECT_EQ(trial.residuals.back(), std::sqrt(trial.report.residual));
}

/// Seconds of all trials of a test, and of the calls that made them.
struct Seconds {
  double setup = 0, solve = 0, calls = 0;

  template <int D>
  std::vector<SolverTrial> convergence(Simulation<D>& simulation, const std::vector<SolverSettings>& solvers) {
    Timer timer;
    std::vector<SolverTrial> trials = simulation.convergence(solvers);
    calls += timer.lap();
    for (const SolverTrial& trial : trials) {
      EXPECT_GT(trial.setupSeconds, 0);
      EXPECT_GT(trial.solveSeconds, 0);
      setup += trial.setupSeconds, solve += trial.solveSeconds;
    }
    return trials;
  }

  /// Trials are parts of their calls, and most of them: of what is left, the first of two set-ups and the system,
  /// a quarter. What is asked for bears that another program has the processor meanwhile.
  void check() const {
    EXPECT_LE(setup + solve, calls);
    EXPECT_GE(setup + solve, 0.02 * calls);
  }
};

/// The case's own solver does what it does in the next step, which may have other solves as well, and the others
/// leave no trace in it.
template <int D>
void checkTrials(Simulation<D>& compared, Simulation<D>& plain, const std::vector<SolverSettings>& solvers,
                 int steps, bool otherSolves = false) {
  Seconds seconds;
  for (int step = 0; step < steps; ++step) {
    const std::vector<SolverTrial> trials = seconds.convergence(compared, solvers);
    ASSERT_EQ(trials.size(), solvers.size());
    const StepReport report = compared.advance(), expected = plain.advance();
    for (std::size_t k = 0; k < trials.size(); ++k) {
      checkCurve(trials[k]);
      EXPECT_EQ(trials[k].report.status, SolveStatus::Converged) << trials[k].solver;
      EXPECT_LE(trials[k].report.residual, solvers[k].tolerance);
      // The first guess is the same, unless modes improve it.
      const double start = trials[0].report.startResidual;
      if (solvers[k].deflation == 0) {
        EXPECT_NEAR(trials[k].report.startResidual, start, 1e-12 * start);
      }
    }
    if (otherSolves)
      EXPECT_LT(trials.back().report.iterations, expected.iterations) << "step " << step;
    else
      EXPECT_EQ(trials.back().report.iterations, expected.iterations) << "step " << step;
    EXPECT_EQ(trials.back().report.residual, expected.residual);
    EXPECT_EQ(report.residual, expected.residual);
    expectSameBits(stateOf(compared), stateOf(plain));
  }
  seconds.check();
}

TEST(Convergence, OfMphLeavesTheNextStepAsItIs) {
  StretchedBody a, b;
  auto compared = a.start(8), plain = b.start(8);
  SolverSettings none = a.c.solver;
  none.preconditioner = PreconditionerKind::None;
  none.krylov = KrylovKind::Cr;
  none.deflation = 0;
  SolverSettings assembled = none;
  assembled.operatorKind = OperatorKind::Assembled;
  assembled.preconditioner = PreconditionerKind::BucketMultigrid;
  assembled.precision = Precision::Double;
  SolverSettings shallow = a.c.solver;
  shallow.deflation = 0;
  checkTrials(compared, plain, {none, assembled, shallow, a.c.solver}, 5);  // modes are there from step 4 on
  EXPECT_EQ(compared.particles().modeCount(), 8u);
  // Without a preconditioner hundreds of iterations take longer than to set them up.
  const std::vector<SolverTrial> plainTrial = compared.convergence(std::vector{none});
  EXPECT_GT(plainTrial[0].report.iterations, 100);
  EXPECT_GT(plainTrial[0].solveSeconds, 3 * plainTrial[0].setupSeconds);  // measured: a hundred times
}

template <int D>
void checkIsph() {
  using enum PreconditionerKind;
  Case c = tankCase(D, D == 2 ? 16 : 8, D == 2 ? 14 : 7);
  c.solver.preconditioner = HatMultigrid;
  c.solver.deflation = 0;
  c.time.courant = 0.1;
  for (Body& body : c.bodies)
    if (body.kind == BodyKind::Wall) body.oscillation = {{0.005, 0, 0}, 0.1, 0.3};
  // In double precision: a matrix in single precision has another first residual.
  c.solver.precision = Precision::Double;
  std::vector<SolverSettings> solvers;
  for (const PreconditionerKind kind : {None, Jacobi, CellMultigrid, HatMultigrid}) {
    solvers.push_back(c.solver);
    solvers.back().preconditioner = kind;
  }
  Simulation<D> compared(c, created<D>(c)), plain(c, created<D>(c));
  checkTrials(compared, plain, solvers, 4, true);
}

/// |r| / |b| of the conjugate residual method on dense matrices, without a preconditioner.
std::vector<double> denseCurve(const Matrix& a, const Vector& b, const Vector& start, int iterations) {
  Vector r = b - a * start, ar = a * r, p = r, q = ar;
  std::vector<double> curve{r.norm() / b.norm()};
  for (int k = 0; k < iterations; ++k) {
    const double before = r.dot(ar), alpha = before / q.squaredNorm();
    r -= alpha * q;
    ar = a * r;
    const double beta = r.dot(ar) / before;
    p = r + beta * p;
    q = ar + beta * q;
    curve.push_back(r.norm() / b.norm());
  }
  return curve;
}

TEST(Convergence, CurvesAreThoseOfTheMethodOnTheMatrixOfTheFormulas) {
  Scene<2> s = makeScene<2>();
  s.c.gravity[1] = -10;
  const Oracle<2> oracle(s);
  Vector u(s.unknowns());
  for (Index k = 0; k < u.size(); ++k) u[k] = s.particles.velocity[k / 2][k % 2];
  const std::vector<double> expected = denseCurve(oracle.matrix(), oracle.rightHandSide(), u, 20);
  std::vector<SolverSettings> solvers;
  for (const OperatorKind kind : {OperatorKind::MatrixFree, OperatorKind::Assembled}) {
    SolverSettings solver;
    solver.krylov = KrylovKind::Cr;
    solver.preconditioner = PreconditionerKind::None;
    solver.precision = Precision::Double;
    solver.operatorKind = kind;
    solver.deflation = 0;
    solvers.push_back(solver);
  }
  Simulation<2> simulation(s.c, std::move(s.particles));
  for (const SolverTrial& trial : simulation.convergence(solvers)) {
    checkCurve(trial);
    ASSERT_GT(trial.residuals.size(), expected.size());
    for (std::size_t k = 0; k < expected.size(); ++k)
      EXPECT_NEAR(trial.residuals[k], expected[k], 1e-12 * expected[k]) << "iteration " << k;
    // The residual of this method never grows.
    EXPECT_TRUE(std::ranges::is_sorted(trial.residuals, std::greater{}));
  }
}

TEST(Convergence, OfIsphLeavesTheNextStepAsItIs) {
  checkIsph<2>();
  checkIsph<3>();
}

TEST(Convergence, ASolveThatFailsIsAResult) {
  StretchedBody body;
  auto simulation = body.start(0);
  SolverSettings few = body.c.solver;
  few.maxIterations = 2;
  SolverSettings bounded = body.c.solver;
  bounded.projected.iterationBound = 2;  // that of stages, of which a trial has one
  const std::vector<SolverTrial> trials = simulation.convergence(std::vector{few, bounded});
  EXPECT_EQ(trials[0].report.status, SolveStatus::IterationLimit);
  EXPECT_EQ(trials[0].residuals.size(), 3u);
  EXPECT_EQ(trials[1].report.status, SolveStatus::Converged);
  for (const SolverTrial& trial : trials) checkCurve(trial);
  // What was cut off is the beginning of the other one.
  ASSERT_GT(trials[1].residuals.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(trials[0].residuals[k], trials[1].residuals[k]) << k;
  EXPECT_NE(trials[0].solver.find("projected-multigrid, mixed: pressure degree 4"), std::string::npos);
  EXPECT_TRUE(simulation.convergence({}).empty());
}

}  // namespace
}  // namespace treacle::test
