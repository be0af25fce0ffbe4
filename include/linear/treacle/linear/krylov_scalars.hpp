#pragma once

#include "treacle/core/macros.hpp"

#include <cmath>

namespace treacle {

struct StoppingRule {
  double tolerance = 1e-12;  // bound on |r|^2 / |b|^2
  int maxIterations = 5000;
  /// CR: s = K r is computed anew when |r|^2 has fallen by this factor since the last time; 0: never. The
  /// recursion for s keeps the rounding errors of K, and in single precision those outgrow s before the tolerance
  /// is reached.
  double refresh = 0;
  /// Where to leave |r|^2 / |b|^2 at the start and after each iteration: maxIterations + 1 numbers in the
  /// backend's memory. Null: nowhere.
  double* history = nullptr;
};

/// Running: another iteration is due. Refresh: the same, once s = K r has been computed anew.
enum class SolveStatus { Running, Refresh, Converged, IterationLimit, Breakdown, NotFinite };

struct SolveReport {
  SolveStatus status = SolveStatus::Converged;
  int iterations = 0;
  double residual = 0;       // |r|^2 / |b|^2 of the recursion
  double startResidual = 0;  // that of the first guess
};

/// The scalars of a Krylov loop and its stopping test. They stay in the backend's memory: inside an iteration the
/// host need not look at them. CG and CR share their form: a direction with beta = rho / rhoOld, then a step with
/// alpha = rho / sigma; (rho, sigma) is (r.z, p.A p) in CG and (s.A s, q.K q) in CR.
struct KrylovScalars {
  StoppingRule rule;
  double bb = 0;  // |b|^2
  double rr = 0;  // |r|^2
  double rrAtStart = 0;
  double rrOfLastRefresh = 0;
  double rho = 0, alpha = 0, beta = 0;
  int iteration = 0;
  SolveStatus status = SolveStatus::Running;

  TREACLE_HD void start(double bSquared, double rSquared) {
    bb = bSquared;
    rr = rrAtStart = rrOfLastRefresh = rSquared;
    iteration = 0;
    status = SolveStatus::Running;
    record();
    test();
  }
  TREACLE_HD void setDirection(double newRho) {
    beta = iteration == 0 ? 0 : newRho / rho;
    rho = newRho;
  }
  /// Both sums are positive for symmetric positive definite A and K.
  TREACLE_HD void setStep(double sigma) {
    const bool positive = rho > 0 && sigma > 0;
    alpha = positive ? rho / sigma : 0;
    if (!positive) status = isFinite(rho) && isFinite(sigma) ? SolveStatus::Breakdown : SolveStatus::NotFinite;
  }
  TREACLE_HD void endIteration(double rSquared) {
    if (status != SolveStatus::Running) return;
    rr = rSquared;
    ++iteration;
    record();
    test();
    if (status == SolveStatus::Running && rr < rule.refresh * rrOfLastRefresh) {
      rrOfLastRefresh = rr;
      status = SolveStatus::Refresh;
    }
  }

  SolveReport report() const { return {status, iteration, rr / scale(), rrAtStart / scale()}; }

 private:
  TREACLE_HD static bool isFinite(double x) { return x - x == 0; }
  TREACLE_HD double scale() const { return bb > 0 ? bb : 1; }

  TREACLE_HD void record() {
    if (rule.history) rule.history[iteration] = rr / scale();
  }

  /// A zero right-hand side asks for a zero residual.
  TREACLE_HD void test() {
    if (!isFinite(rr))
      status = SolveStatus::NotFinite;
    else if (rr <= rule.tolerance * bb)
      status = SolveStatus::Converged;
    else if (iteration >= rule.maxIterations)
      status = SolveStatus::IterationLimit;
  }
};

}  // namespace treacle
