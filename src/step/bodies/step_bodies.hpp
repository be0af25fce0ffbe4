#pragma once

#include "method/staged_solver.hpp"
#include "rigid_bodies.hpp"
#include "rigid_contacts.hpp"

#include <algorithm>
#include <optional>
#include <span>

namespace treacle {

/// Forces on rigid bodies are small differences of large pressures: with flows that are solved to the tolerance of
/// the case their velocities would not be found to a thousandth. What a small change of a pressure does to a flow
/// rate is small, too.
inline Case solvedCase(Case c) {
  const auto hasFlowRate = [](const Opening& o) { return o.flowRate.has_value(); };
  if (c.hasRigid() || std::ranges::any_of(c.openings, hasFlowRate))
    c.solver.tolerance = std::max(1e-4 * c.solver.tolerance, 1e-20);
  return c;
}

/// The rigid bodies of a step, by whatever method the fluid flows: their velocities, which the flow is solved
/// with, and their contacts.
template <int D, class Backend>
class StepBodies {
 public:
  explicit StepBodies(FlowState<D, Backend>& state) : state_(state), system_(state), contacts_(state) {}

  /// Before anything of the step depends on the velocities of walls.
  void start() { system_.start(); }

  /// Finds the velocities of the bodies, and the flow with these. `flow(isFirst)`: solves it with the velocities
  /// that walls have; what it is made of has those of the first call already. `loads()`: what bodies bear of it.
  /// `surface`: RigidContacts::find. Returns what became of all solves. Errors: RunError.
  template <class Flow, class Loads>
  StagedReport solve(const SortedParticles<D>& sorted, std::span<const WallSurface<D>> surface, Flow&& flow,
                     Loads&& loads) {
    std::optional<StagedReport> report;
    system_.solve(contacts_.find(state_, sorted, surface), [&] {
      const StagedReport next = flow(!report);
      if (report)
        report->follow(next);
      else
        report = next;
      return loads();
    });
    return *report;
  }

  std::size_t bytes() const { return contacts_.bytes(); }

 private:
  FlowState<D, Backend>& state_;
  RigidSystem<D, Backend> system_;
  RigidContacts<D, Backend> contacts_;
};

}  // namespace treacle
