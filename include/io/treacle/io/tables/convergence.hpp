#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace treacle {

/// How a solver's residual falls.
struct ConvergenceCurve {
  std::string solver;
  std::string outcome;            // "converged", or why not
  std::vector<double> residuals;  // |r| / |b| at the start and after each iteration
  double setupSeconds = 0;
  double solveSeconds = 0;

  std::size_t iterations() const { return residuals.empty() ? 0 : residuals.size() - 1; }
  double lastResidual() const { return residuals.empty() ? 0 : residuals.back(); }
};

/// Every residual, a row each, as CSV (docs/output.md). Errors: RunError if the file cannot be written.
void writeConvergence(const std::filesystem::path& path, const std::vector<ConvergenceCurve>& curves);

/// Iterations and seconds, a row per solver, likewise.
void writeSolvers(const std::filesystem::path& path, const std::vector<ConvergenceCurve>& curves);

}  // namespace treacle
