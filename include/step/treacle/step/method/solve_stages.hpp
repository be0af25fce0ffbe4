#pragma once

#include "treacle/core/processes.hpp"
#include "treacle/linear/hat_nodes.hpp"
#include "treacle/model/case/case.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace treacle {

/// The ways in which the linear systems of a case are solved, each one the fallback of the one before it. Those of
/// the projected multigrid have their degrees filled in and stop early: one that needs so many iterations is not
/// what this preconditioner is chosen for, and another way is cheaper.
std::vector<SolverSettings> solveStages(const Case& c);

/// How many nodes a grid of the preconditioner may have that the processes of a simulation do not divide.
inline std::uint64_t mostWholeNodes(const SolverSettings& settings, const Processes& processes) {
  const bool shared = processes.communicator && processes.communicator->size() > 1;
  return shared ? static_cast<std::uint64_t>(settings.dividedNodes) : anyNumber;
}

/// "cg, projected-multigrid, mixed: pressure degree 9, grid degree 4, velocity degree 2"
std::string solverText(const SolverSettings& settings);

/// How ISPH takes the viscous step of a case, e.g. "explicit (up to time steps of 0.011 s)".
std::string viscousText(const Case& c);

}  // namespace treacle
