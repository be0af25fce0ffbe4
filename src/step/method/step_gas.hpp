#pragma once

#include "explicit_forces.hpp"
#include "flow/gas_pockets.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace treacle {

/// The gas that the fluid has trapped in a step of MPH-I: its pockets, and their pressures at the end of the step,
/// in which the flow with these pressures leaves them the volume that goes with them.
template <int D, class Backend>
class StepGas final : public ExplicitForces<D, Backend> {
 public:
  /// `others`: forces that go with those of the gas in allForces(); must outlive this.
  StepGas(const Case& c, const ExplicitForces<D, Backend>& others) : pockets_(c), others_(others) {}

  /// On the places in the middle of the step.
  void prepare(const FlowState<D, Backend>& state) {
    const Particles<D, Backend>& p = state.particles;
    position_.resize(p.count);
    copyToHost(state.context, std::span<const Vec<D>>(p.position), position_.data());
    gas_ = p.gas;
    pockets_.find(position_, p.fluidCount, gas_);
    const std::span<const GasContact<D>> all = pockets_.contacts();
    const auto walls = std::ranges::lower_bound(all, p.fluidCount, {}, &GasContact<D>::particle);
    fromHost(state.context, std::span<const GasContact<D>>(all.begin(), walls), ofFluid_);
    fromHost(state.context, std::span<const GasContact<D>>(walls, all.end()), ofWalls_);
    pressures_.clear();
    for (const GasState::Pocket& pocket : gas_.pockets) pressures_.push_back(pocket.pressure);
    setPressures(state);
  }

  /// y += the forces of the pressures at hand per own fluid particle [N/m3].
  void addPressures(FlowState<D, Backend>& state, std::span<Vec<D>> y) const {
    addGasForces<D>(state.context, ofFluid_.span(), pressure_.span(), particleVolume(state), y);
  }

  /// Of the pockets, with what the step before knew.
  const GasState& gas() const { return gas_; }
  const std::vector<double>& pressures() const { return pressures_; }
  void set(const FlowState<D, Backend>& state, std::span<const double> pressures) {
    pressures_.assign(pressures.begin(), pressures.end());
    setPressures(state);
  }

  /// By how much each pressure is more than what belongs to the volume of the pocket after the flow in
  /// state.velocity [Pa].
  std::vector<double> excess(FlowState<D, Backend>& state) {
    growth_ = growth(state);
    std::vector<double> excess;
    for (std::size_t k = 0; k < pressures_.size(); ++k)
      excess.push_back(pressures_[k] - pockets_.pressure(gas_.pockets[k], gas_.pockets[k].volume + growth_[k]));
    return excess;
  }

  /// The pressures and the growth of the last excess() are those of the step.
  void accept(FlowState<D, Backend>& state) {
    for (std::size_t k = 0; k < gas_.pockets.size(); ++k) {
      gas_.pockets[k].volume += growth_[k];
      gas_.pockets[k].pressure = pressures_[k];
    }
    state.particles.gas = gas_;
  }

  void addForces(FlowState<D, Backend>& state, std::span<Vec<D>> y) const override { others_.addForces(state, y); }
  void allForces(FlowState<D, Backend>& state, const MphPairs<D>& pairs, const ClusterListView& walls,
                 std::span<Vec<D>> y, std::span<Vec<D>> load) const override {
    others_.allForces(state, pairs, walls, y, load);
    addPressures(state, y);
  }

  std::size_t bytes() const {
    const std::size_t onHost = std::is_same_v<Backend, Cpu> ? position_.bytes() + pockets_.bytes() : 0;
    return onHost + ofFluid_.bytes() + ofWalls_.bytes() + pressure_.bytes();
  }

 private:
  static double particleVolume(const FlowState<D, Backend>& state) { return std::pow(state.theCase.spacing, D); }

  void setPressures(const FlowState<D, Backend>& state) {
    fromHost(state.context, std::span<const double>(pressures_), pressure_);
  }

  /// By how much pockets grow in the step, by the motion of fluid and walls.
  std::vector<double> growth(FlowState<D, Backend>& state) const {
    std::vector<double> growth;
    for (std::uint32_t k = 0; k < gas_.pockets.size(); ++k)
      growth.push_back(state.timeStep *
                       (gasRate<D>(state.context, ofFluid_.span(), k, state.velocity.span()) +
                        gasRate<D>(state.context, ofWalls_.span(), k, state.particles.velocity.span())));
    return growth;
  }

  GasPockets<D> pockets_;
  const ExplicitForces<D, Backend>& others_;
  GasState gas_;                   // of the step at hand
  std::vector<double> pressures_;  // that are tried [Pa]
  std::vector<double> growth_;     // with them [m3; m2 in 2D]
  Buffer<Vec<D>> position_;
  Buffer<GasContact<D>, Backend> ofFluid_, ofWalls_;
  Buffer<double, Backend> pressure_;
};

}  // namespace treacle
