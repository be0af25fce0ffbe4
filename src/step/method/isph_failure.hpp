#pragma once

#include "run/failure.hpp"
#include "run/flow_state.hpp"
#include "staged_solver.hpp"
#include "treacle/model/particles/particles_copy.hpp"

#include <fmt/format.h>

#include <string>

namespace treacle {

/// That one of the solves of a step of ISPH has converged; `what` is solved for. Errors: RunError.
template <int D, class Backend>
void requireConverged(FlowState<D, Backend>& state, const char* what, const StagedReport& report) {
  if (report.status == SolveStatus::Converged) return;
  std::string diagnosis =
      fmt::format("{}: {}", what, describeFailure(report, state.theCase.solver.tolerance, report.failures));
  if (report.status == SolveStatus::NotFinite) {
    Particles<D> host;
    copyToHost(state.context, state.particles, host);
    diagnosis += "; " + describeNotFinite<D>(state.context, host, host.velocity);
  }
  throw RunError(diagnosis);
}

}  // namespace treacle
