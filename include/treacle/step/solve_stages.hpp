#pragma once

#include "treacle/model/case.hpp"

#include <string>
#include <vector>

namespace treacle {

/// The ways in which the linear systems of a case are solved, each one the fallback of the one before it. Those of
/// the projected multigrid have their degrees filled in and stop early: one that needs so many iterations is not
/// what this preconditioner is chosen for, and another way is cheaper. `shared`: by several processes, whose last
/// resort is block-Jacobi.
std::vector<SolverSettings> solveStages(const Case& c, bool shared = false);

/// "cg, projected-multigrid, mixed: pressure degree 9, grid degree 4, velocity degree 2"
std::string solverText(const SolverSettings& settings);

/// How ISPH takes the viscous step of a case, e.g. "explicit (up to time steps of 0.011 s)".
std::string viscousText(const Case& c);

}  // namespace treacle
