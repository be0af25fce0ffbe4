#pragma once

#include "commands.hpp"

#include <vector>

namespace treacle {

/// The solvers that `convergence` compares: the case's [solver] with the keys of each --solver on top, or with
/// those of a list of its own for the method. Errors: InputError that begins with --solver and says what was
/// expected.
std::vector<SolverSettings> comparedSolvers(const ConvergenceOptions& options, MethodKind method);

/// "key=value" for readCase: those of --set, and --precision as another one.
std::vector<std::string> overridesOf(const ConvergenceOptions& options);

}  // namespace treacle
