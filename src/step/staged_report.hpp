#pragma once

#include "failure.hpp"
#include "treacle/linear/krylov_scalars.hpp"
#include "treacle/model/case.hpp"

#include <cmath>
#include <string>
#include <vector>

namespace treacle {

/// What became of a solve in stages: status and residual of the last one, iterations of all.
struct StagedReport : SolveReport {
  int fallbacks = 0;     // stages that were tried before the last one
  std::string failures;  // which these were, and why they were given up
};

/// Solves with stages[stage], which is prepared, and with the stages behind it while they fail: solve() makes one
/// try, keepBetter(report) leaves the better of its guesses for the next, prepare() makes stages[stage] ready.
template <class Solve, class KeepBetter, class Prepare>
StagedReport solveInStages(const std::vector<SolverSettings>& stages, std::size_t& stage, Solve&& solve,
                           KeepBetter&& keepBetter, Prepare&& prepare) {
  StagedReport total;
  while (true) {
    const SolveReport report = solve();
    const int iterations = total.iterations + report.iterations;
    static_cast<SolveReport&>(total) = report;
    total.iterations = iterations;
    // No other way helps where the system itself or the guess is not finite.
    const bool hopeless = !std::isfinite(report.startResidual);
    if (report.status == SolveStatus::Converged || hopeless || stage + 1 == stages.size()) return total;
    total.failures += (total.fallbacks++ > 0 ? "; " : "") + describeStage(stages[stage], report);
    keepBetter(report);
    ++stage;
    prepare();
  }
}

/// Whether what a try made of its guess is better than the guess itself.
inline bool isBetter(const SolveReport& report) {
  // A step with a value that is not finite may have spoiled the result after the residual was taken.
  return report.status != SolveStatus::NotFinite && report.residual < report.startResidual;
}

}  // namespace treacle
