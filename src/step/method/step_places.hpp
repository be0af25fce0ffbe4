#pragma once

#include "run/flow_state.hpp"
#include "treacle/core/halo.hpp"
#include "treacle/mph/cover.hpp"
#include "treacle/mph/mph_sums.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

namespace treacle {

/// Number densities in a step of MPH-I, and what else it knows of the places of particles.
template <int D, class Backend>
class StepPlaces {
 public:
  /// n goes into the state's particles, ghosts included. `volume`: that of numberDensity().
  void compute(FlowState<D, Backend>& state, const MphPairs<D>& pairs, std::span<const double> volume) {
    const std::uint32_t active = pairs.activeCount;
    std::span<double> n = state.particles.numberDensity;
    clearValues(state.context, n.subspan(active));
    if (state.theCase.keepsVolume()) {
      open_.resize(state.context, active);
      wide_.resize(state.context, active);
    }
    numberDensity<D>(state.context, pairs, n.first(active), {open_.span(), wide_.span()}, volume);
    fillGhosts(state.context, Held::Active, n.data());
    walls_.resize(state.context, state.particles.fluidCount);
    wallDensity<D>(state.context, pairs, walls_);
  }

  Places of(const FlowState<D, Backend>& state) const {
    return {state.particles.numberDensity, open_, wide_, walls_};
  }

  void describe(const FlowState<D, Backend>& state, const MphPairs<D>& pairs, DiagnosticsInput<D>& in) const {
    const std::uint32_t n = state.particles.fluidCount;
    in.numberDensity = state.particles.numberDensity.span().first(n);
    in.pressure = state.particles.pressure.span().first(n);
    in.restDensity = in.neighbourDensity = pairs.restDensity;
    in.ownDensity = pairs.terms.density(pairs.terms.densityFactor, ExactDistance(0));
    if (walls_.size() == n) in.wallDensity = walls_;
    if (open_.size() >= n) in.open = open_.span().first(n);
  }

  std::size_t bytes() const { return open_.bytes() + wide_.bytes() + walls_.bytes(); }

 private:
  Buffer<double, Backend> open_, wide_;  // PlaceSums, where the case keeps its volume [-]
  Buffer<double, Backend> walls_;        // the walls' part of n per own fluid particle [-]
};

}  // namespace treacle
