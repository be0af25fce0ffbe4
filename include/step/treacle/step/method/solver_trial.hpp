#pragma once

#include "treacle/linear/krylov_scalars.hpp"

#include <string>
#include <vector>

namespace treacle {

/// What one solver made of a linear system; that it does not converge is a result, too.
struct SolverTrial {
  std::string solver;  // solverText()
  SolveReport report;
  std::vector<double> residuals;  // |r| / |b| of the recursion at the start and after each iteration
  double setupSeconds = 0;        // operator or matrix, and preconditioner
  double solveSeconds = 0;        // Krylov iterations
};

}  // namespace treacle
