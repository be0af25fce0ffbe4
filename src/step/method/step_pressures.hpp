#pragma once

#include "bodies/affine_solve.hpp"
#include "staged_solver.hpp"
#include "step_gas.hpp"
#include "treacle/core/error.hpp"
#include "treacle/step/flow/outflow.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace treacle {

/// The pressures that a step finds together with its flow: of openings with a flow rate, with which that is their
/// flow, and of trapped gas at the end of the step, with which the flow leaves it the volume that goes with them.
template <int D, class Backend>
class StepPressures {
 public:
  explicit StepPressures(FlowState<D, Backend>& state) : state_(state) {
    for (std::size_t k = 0; k < state.faces.size(); ++k)
      if (state.faces[k].hasFlowRate()) pumps_.push_back(k);
  }

  /// Whether openings have flow rates.
  bool some() const { return !pumps_.empty(); }

  /// `flow(isFirst)`: solves the flow with the pressures that openings and `gas`, which may be null, have; what it
  /// is made of has those of the first call already. Returns what became of all solves. Errors: RunError.
  template <class Flow>
  StagedReport solve(StepGas<D, Backend>* gas, Flow&& flow) {
    std::vector<double> x;
    for (const std::size_t k : pumps_) x.push_back(state_.openingForces[k].pressure);
    if (gas) x.insert(x.end(), gas->pressures().begin(), gas->pressures().end());
    response_ = gas ? gas->gas().response : state_.particles.gas.response;
    if (x.empty()) return flow(true);
    std::optional<StagedReport> report;
    const auto missing = [&](const std::vector<double>& at) {
      if (report) set(at, gas);
      const StagedReport next = flow(!report);
      if (report)
        report->follow(next);
      else
        report = next;
      return excess(gas);
    };
    const AffineSolve::Result result = AffineSolve::run(missing, x, response_, scale(), tolerance, mostSteps);
    if (!result.converged)
      throw RunError(
          fmt::format("the pressures of {} openings and {} pockets of trapped gas were not found in {} solves; "
                      "take {} <= {:.3g}",
                      pumps_.size(), x.size() - pumps_.size(), result.values, state_.theCase.time.stepKey(),
                      state_.timeStep / 2));
    return *report;
  }

  /// Those of the last solve are those of the step. After StepGas::accept().
  void accept() {
    for (const std::size_t k : pumps_)
      state_.particles.flow.openings[k].pressure = state_.openingForces[k].pressure;
    state_.particles.gas.response = response_;
  }

 private:
  static constexpr double tolerance = 1e-6;  // of a step to the solution, of scale()
  static constexpr int mostSteps = 60;

  /// The pressure of the air, or what pressures of a flow are like [Pa].
  double scale() const {
    const Case& c = state_.theCase;
    if (c.gas) return c.gas->pressure;
    double scale = 0;
    for (const Material& m : c.materials)
      scale = std::max({scale, 1e-3 * m.bulkModulus, m.density * std::pow(c.spacing / state_.timeStep, 2)});
    return scale;
  }

  void set(const std::vector<double>& x, StepGas<D, Backend>* gas) {
    for (std::size_t k = 0; k < pumps_.size(); ++k) state_.openingForces[pumps_[k]].pressure = x[k];
    if (!pumps_.empty()) state_.takeOpenings();
    if (gas) gas->set(state_, std::span(x).subspan(pumps_.size()));
  }

  /// What is too much of the flow through openings and of the pressures of the gas, for the flow in
  /// state.velocity.
  std::vector<double> excess(StepGas<D, Backend>* gas) {
    std::vector<double> excess;
    const auto [from, to] = state_.velocityInterval();
    const std::uint32_t n = state_.particles.fluidCount;
    for (const std::size_t k : pumps_)
      excess.push_back(openingFlow<D>(state_.context, state_.openingForces[k],
                                      state_.particles.position.span().first(n), state_.velocity.span().first(n)) -
                       state_.faces[k].flowRate(from, to));
    if (gas) std::ranges::copy(gas->excess(state_), std::back_inserter(excess));
    return excess;
  }

  FlowState<D, Backend>& state_;
  std::vector<std::size_t> pumps_;  // openings with a flow rate
  std::vector<double> response_;    // GasState::response
};

}  // namespace treacle
