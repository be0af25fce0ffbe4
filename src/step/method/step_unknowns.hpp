#pragma once

#include "bodies/affine_solve.hpp"
#include "bodies/rigid_bodies.hpp"
#include "bodies/rigid_contacts.hpp"
#include "pressure_unknowns.hpp"
#include "staged_solver.hpp"
#include "treacle/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

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

/// What a step finds together with its flow, by whatever method the fluid flows: the velocities of rigid bodies,
/// and the pressures of openings with a flow rate and of trapped gas.
template <int D, class Backend>
class StepUnknowns {
 public:
  /// `state` must outlive this.
  explicit StepUnknowns(FlowState<D, Backend>& state) : state_(state), pumps_(state) {
    if (state.theCase.hasRigid()) bodies_.emplace(state);
  }

  /// Gas whose pressures are found, too. Must outlive this.
  void add(StepGas<D, Backend>& gas) { gas_ = &gas, gasPressures_.emplace(state_, gas); }

  bool hasBodies() const { return bodies_.has_value(); }
  /// Whether there may be anything to find, and pressures.
  bool some() const { return hasBodies() || hasPressures(); }
  bool hasPressures() const { return hasPumps() || gas_; }
  bool hasPumps() const { return pumps_.some(); }

  /// Before anything of the step depends on the velocities of walls.
  void start() {
    if (bodies_) bodies_->start();
  }

  /// Finds the unknowns, and the flow with these. `flow(isFirst)`: solves it with the values that were set; what
  /// it is made of has those of the first call already. `loads()`: what bodies bear of it. `surface`:
  /// rigidContacts(). Returns what became of all solves. Errors: RunError.
  template <class Flow, class Loads>
  StagedReport solve(const SortedParticles<D>& sorted, std::span<const WallSurface<D>> surface, Flow&& flow,
                     Loads&& loads) {
    std::vector<FlowUnknowns*> kinds;  // bodies first, as their restraints count them
    if (bodies_) bodies_->setLoads(loads), kinds.push_back(&*bodies_);
    if (pumps_.some()) kinds.push_back(&pumps_);
    if (gasPressures_) kinds.push_back(&*gasPressures_);
    std::vector<double> x, scale;
    std::vector<std::size_t> sizes;
    for (const FlowUnknowns* kind : kinds) {
      const std::vector<double> values = kind->values(), scales = kind->scales();
      x.insert(x.end(), values.begin(), values.end());
      scale.insert(scale.end(), scales.begin(), scales.end());
      sizes.push_back(values.size());
    }
    response_.clear();
    if (x.empty()) return flow(true);
    if (!gas_ || !gas_->isNew()) response_ = state_.particles.response;
    std::vector<Restraint> restraints;
    if (bodies_) restraints = bodies_->restraints(rigidContacts(state_, sorted, surface), x.size());
    std::optional<StagedReport> report;
    const auto missing = [&](const std::vector<double>& at) {
      if (report) {
        std::size_t first = 0;
        for (std::size_t k = 0; k < kinds.size(); first += sizes[k++])
          kinds[k]->set(std::span(at).subspan(first, sizes[k]));
      }
      const StagedReport next = flow(!report);
      if (report)
        report->follow(next);
      else
        report = next;
      std::vector<double> all;
      for (FlowUnknowns* kind : kinds) {
        const std::vector<double> some = kind->missing();
        all.insert(all.end(), some.begin(), some.end());
      }
      return all;
    };
    const AffineSolve::Result result =
        AffineSolve::run(missing, x, response_, scale, tolerance, mostSteps, restraints);
    if (!result.converged) throw RunError(notFound(kinds, result.values));
    if (bodies_) bodies_->keepChange();
    return *report;
  }

  /// Those of the last flow are those of the step.
  void accept() {
    pumps_.accept();
    state_.particles.response = response_;
  }

 private:
  static constexpr double tolerance = 1e-6;  // of a step to the solution, of the scales
  static constexpr int mostSteps = 60;

  std::string notFound(const std::vector<FlowUnknowns*>& kinds, int solves) const {
    std::string names;
    for (const FlowUnknowns* kind : kinds) names += (names.empty() ? "" : " and ") + kind->name();
    return fmt::format("{} were not found in {} solves; take {} <= {:.3g}", names, solves,
                       state_.theCase.time.stepKey(), state_.timeStep / 2);
  }

  FlowState<D, Backend>& state_;
  PumpPressures<D, Backend> pumps_;
  std::optional<RigidSystem<D, Backend>> bodies_;  // where the case has rigid bodies; then also:
  StepGas<D, Backend>* gas_ = nullptr;
  std::optional<GasPressures<D, Backend>> gasPressures_;  // where there is gas
  std::vector<double> response_;                          // Particles::response
};

}  // namespace treacle
