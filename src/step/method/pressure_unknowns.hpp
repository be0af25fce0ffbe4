#pragma once

#include "flow_unknowns.hpp"
#include "run/flow_state.hpp"
#include "step_gas.hpp"
#include "treacle/step/flow/outflow.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace treacle {

/// The pressures of openings with a flow rate, with which that is their flow.
template <int D, class Backend>
class PumpPressures final : public FlowUnknowns {
 public:
  /// `state` must outlive this.
  explicit PumpPressures(FlowState<D, Backend>& state) : state_(state) {
    for (std::size_t k = 0; k < state.faces.size(); ++k)
      if (state.faces[k].hasFlowRate()) pumps_.push_back(k);
  }

  bool some() const { return !pumps_.empty(); }

  std::string name() const override { return fmt::format("the pressures of {} openings", pumps_.size()); }
  std::vector<double> values() const override {
    std::vector<double> x;
    for (const std::size_t k : pumps_) x.push_back(state_.openingForces[k].pressure);
    return x;
  }
  /// The pressure of the gas around the fluid, or what pressures of a flow are like [Pa].
  std::vector<double> scales() const override {
    const Case& c = state_.theCase;
    double scale = c.gas ? c.gas->pressure : 0;
    if (!c.gas)
      for (const Material& m : c.materials)
        scale = std::max({scale, 1e-3 * m.bulkModulus, m.density * std::pow(c.spacing / state_.timeStep, 2)});
    return std::vector(pumps_.size(), scale);
  }
  void set(std::span<const double> x) override {
    for (std::size_t k = 0; k < pumps_.size(); ++k) state_.openingForces[pumps_[k]].pressure = x[k];
    state_.takeOpenings();
  }
  /// What is too much of the flow through openings [m3/s; m2/s in 2D].
  std::vector<double> missing() override {
    std::vector<double> excess;
    const auto [from, to] = state_.velocityInterval();
    const std::uint32_t n = state_.particles.fluidCount;
    for (const std::size_t k : pumps_)
      excess.push_back(openingFlow<D>(state_.context, state_.openingForces[k],
                                      state_.particles.position.span().first(n), state_.velocity.span().first(n)) -
                       state_.faces[k].flowRate(from, to));
    return excess;
  }

  /// Those of the last flow are those of the step.
  void accept() {
    for (const std::size_t k : pumps_)
      state_.particles.flow.openings[k].pressure = state_.openingForces[k].pressure;
  }

 private:
  FlowState<D, Backend>& state_;
  std::vector<std::size_t> pumps_;  // openings with a flow rate
};

/// The pressures of trapped gas at the end of the step, with which the flow leaves it the volume that goes with
/// them.
template <int D, class Backend>
class GasPressures final : public FlowUnknowns {
 public:
  /// Both must outlive this.
  GasPressures(FlowState<D, Backend>& state, StepGas<D, Backend>& gas) : state_(state), gas_(gas) {}

  std::string name() const override {
    return fmt::format("the pressures of {} pockets of trapped gas", gas_.pressures().size());
  }
  std::vector<double> values() const override { return gas_.pressures(); }
  std::vector<double> scales() const override {
    return std::vector(gas_.pressures().size(), state_.theCase.gas->pressure);
  }
  void set(std::span<const double> x) override { gas_.set(state_, x); }
  std::vector<double> missing() override { return gas_.excess(state_); }

 private:
  FlowState<D, Backend>& state_;
  StepGas<D, Backend>& gas_;
};

}  // namespace treacle
