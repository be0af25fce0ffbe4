#include "treacle/io/tables/convergence.hpp"

#include "files/csv_cell.hpp"
#include "treacle/io/files/atomic_file.hpp"

#include <fmt/format.h>

namespace treacle {
void writeConvergence(const std::filesystem::path& path, const std::vector<ConvergenceCurve>& curves) {
  std::string text = "solver,iteration,relative_residual\n";
  for (const ConvergenceCurve& curve : curves) {
    const std::string name = csvCell(curve.solver);
    for (std::size_t k = 0; k < curve.residuals.size(); ++k)
      text += fmt::format("{},{},{}\n", name, k, curve.residuals[k]);
  }
  writeFile(path, text);
}

void writeSolvers(const std::filesystem::path& path, const std::vector<ConvergenceCurve>& curves) {
  std::string text = "solver,outcome,iterations,relative_residual,setup_s,solve_s\n";
  for (const ConvergenceCurve& c : curves)
    text += fmt::format("{},{},{},{},{},{}\n", csvCell(c.solver), c.outcome, c.iterations(), c.lastResidual(),
                        c.setupSeconds, c.solveSeconds);
  writeFile(path, text);
}

}  // namespace treacle
