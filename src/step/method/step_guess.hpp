#pragma once

#include "run/flow_state.hpp"
#include "treacle/core/copy_values.hpp"
#include "treacle/mph/mph_pairs.hpp"
#include "treacle/step/method/first_guess.hpp"

#include <span>

namespace treacle {

/// Where the solve of a step of MPH-I starts: the velocities of own fluid as those of the last steps go on.
template <int D, class Backend>
class StepGuess {
 public:
  explicit StepGuess(FlowState<D, Backend>& state) : state_(state) {}

  /// Of the first particles, as many as u has [m/s].
  void set(std::span<Vec<D>> u) {
    extrapolate<D>(
        state_.context,
        Extrapolation<D>::make(state_.theCase.solver.firstGuess, state_.velocityStep, state_.lastStep()),
        state_.particles.velocity.span().first(u.size()), memory(), u);
  }
  /// Into state.velocity, with the velocities of the walls.
  void setAll(const MphPairs<D>& pairs) {
    const std::uint32_t walls = pairs.fluidCount, active = pairs.activeCount;
    const std::span<const Vec<D>> last = state_.particles.velocity;
    state_.velocity.resize(state_.context, active);
    copyValues(state_.context, last.subspan(walls, active - walls), state_.velocity.data() + walls);
    set(state_.velocity.span().first(pairs.ownFluid()));
  }
  /// Remembers the accelerations of the step that is accepted, of `own` fluid particles.
  void accept(std::uint32_t own) {
    // The velocities of the start are given, no solution: nothing follows from the way to the first one.
    if (state_.step > 0)
      updateFlowMemory<D>(state_.context, state_.velocityStep, state_.lastStep(),
                          state_.particles.velocity.span().first(own), state_.velocity.span().first(own),
                          memory());
  }

 private:
  FlowMemory<D> memory() { return {state_.particles.acceleration.span(), state_.particles.jerk.span()}; }

  FlowState<D, Backend>& state_;
};

}  // namespace treacle
