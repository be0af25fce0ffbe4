#pragma once

#include "run/failure.hpp"
#include "run/flow_state.hpp"
#include "step_rheology.hpp"
#include "treacle/step/method/state_terms.hpp"

#include <array>
#include <cmath>

namespace treacle {

/// The states of materials in a step of MPH-I: after the flow, with its shear rates, and before the temperatures,
/// which get the heat that they set free.
template <int D, class Backend>
class StepStates {
 public:
  /// Errors: RunError for states that are not finite.
  void solve(FlowState<D, Backend>& state, const StepRheology<D, Backend>& rheology) {
    const Particles<D, Backend>& p = state.particles;
    const std::uint32_t own = p.fluidCount;
    StateTerms terms{
        rheology.table(), state.timeStep, p.material.span().first(own), rheology.foundRates(), {}, {}};
    for (std::size_t k = 0; k < p.has.states; ++k) {
      next_[k].resize(state.context, own);
      terms.next[k] = next_[k].data();
    }
    if (p.has.temperatures) heating_.resize(state.context, own);
    terms.heating = heating_.span();
    const auto sums = advanceStates(state.context, terms);
    if (const double bad = sums[StateTerms::NotFinite]; bad > 0) throw RunError(describeStates(bad));
    power_ = sums[StateTerms::Heat] * std::pow(state.theCase.spacing, D);
  }

  /// Per own fluid particle [W/m3]; empty without heat.
  std::span<const double> heating() const { return heating_; }
  /// What they set free in the step [W; per metre of depth in 2D].
  double power() const { return power_; }

  void accept(FlowState<D, Backend>& state) {
    for (std::size_t k = 0; k < state.particles.has.states; ++k)
      copyValues(state.context, std::span<const double>(next_[k]), state.particles.states[k].data());
  }

  std::size_t bytes() const {
    std::size_t sum = heating_.bytes();
    for (const auto& next : next_) sum += next.bytes();
    return sum;
  }

 private:
  std::array<Buffer<double, Backend>, maxStates> next_;
  Buffer<double, Backend> heating_;
  double power_ = 0;
};

}  // namespace treacle
