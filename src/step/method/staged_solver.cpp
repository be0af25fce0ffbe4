#include "staged_solver.hpp"

#include "run/failure.hpp"

#include <algorithm>
#include <cmath>

namespace treacle {
namespace {

/// Whether what a try made of its guess is better than the guess itself.
bool isBetter(const SolveReport& report) {
  // A step with a value that is not finite may have spoiled the result after the residual was taken.
  return report.status != SolveStatus::NotFinite && report.residual < report.startResidual;
}

/// In single precision CR computes s = K r anew when |r|^2 has fallen by so much.
constexpr double refreshOfMixed = 1e-4;

}  // namespace

template <int D, class Backend>
void StagedSolver<D, Backend>::prepareOperator(Context<Backend>& context) {
  stage_ = 0;
  system_.prepareOperator(context, stage());
}

template <int D, class Backend>
void StagedSolver<D, Backend>::preparePreconditioner(Context<Backend>& context) {
  system_.preparePreconditioner(context, stage());
}

template <int D, class Backend>
StagedReport StagedSolver<D, Backend>::solve(Context<Backend>& context, std::span<const double> b,
                                             std::span<double> x, SolverModes<D, Backend>* modes, double* history,
                                             double looser) {
  if (modes && !stages_.front().deflates()) modes->drop();  // of a state that another solver made
  if (!isLastStage()) {
    guess_.resize(context, x.size());
    copy(context, x, guess_.span());
  }
  StagedReport total;
  while (true) {
    const SolveReport report = solveStage(context, b, x, modes, history, looser);
    total.follow(report);
    // No other way helps where the system itself or the guess is not finite.
    const bool hopeless = !std::isfinite(report.startResidual);
    if (report.status == SolveStatus::Converged || hopeless || isLastStage()) {
      giveUp(guess_);
      return total;
    }
    ++total.fallbacks;
    total.addFailures(describeStage(stage(), report));
    keepBetter(context, report, x);
    ++stage_;
    system_.prepareOperator(context, stage());
    system_.preparePreconditioner(context, stage());
  }
}

/// Keeps the better one of the guess that a stage started from and its result, for the next stage.
template <int D, class Backend>
void StagedSolver<D, Backend>::keepBetter(Context<Backend>& context, const SolveReport& report,
                                          std::span<double> x) {
  if (isBetter(report))
    copy(context, x, guess_.span());
  else
    copy(context, guess_.span(), x);
}

template <int D, class Backend>
SolveReport StagedSolver<D, Backend>::solveStage(Context<Backend>& context, std::span<const double> b,
                                                 std::span<double> x, SolverModes<D, Backend>* modes,
                                                 double* history, double looser) {
  const Product a = [&](std::span<const double> from, std::span<double> to) {
    system_.multiply(context, from, to);
  };
  const Product k = [&](std::span<const double> r, std::span<double> z) { system_.precondition(context, r, z); };
  const double refresh = stage().precision == Precision::Mixed ? refreshOfMixed : 0;
  const double wanted = stage().tolerance, tolerance = std::max(wanted, std::min(looser * wanted, loosest));
  const StoppingRule rule{tolerance, stage().maxIterations, refresh, history};
  if (stage().krylov == KrylovKind::Cr) return conjugateResidual(context, {a, k, b, x}, rule, krylov_);
  if (!modes || stage_ > 0 || !stage().deflates()) {
    const Product single = [&](std::span<const double> from, std::span<double> to) {
      system_.multiplySingle(context, from, to);
    };
    return conjugateGradient(context, {a, k, b, x, system_.likesSingle() ? &single : nullptr}, rule, krylov_);
  }
  Deflation<Backend>& deflation = keeper_.prepare(context, *modes, x.size() / D, stage().deflation);
  const SolveReport report = conjugateGradient(context, {a, k, b, x}, rule, krylov_, &deflation);
  keeper_.finish(context, *modes, report, stage().deflation);
  return report;
}

#define TREACLE_INSTANTIATE(Backend)       \
  template class StagedSolver<1, Backend>; \
  template class StagedSolver<2, Backend>; \
  template class StagedSolver<3, Backend>;
TREACLE_FOR_EACH_BACKEND(TREACLE_INSTANTIATE)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
