#pragma once

#include "explicit_forces.hpp"
#include "run/flow_state.hpp"
#include "treacle/core/halo.hpp"
#include "treacle/mph/mph_repulsion.hpp"
#include "treacle/mph/mph_sums.hpp"
#include "treacle/step/method/buoyancy_terms.hpp"
#include "treacle/step/method/set_each.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace treacle {

/// b of [K23 eq. (16)] with the elastic pressures that are in it, buoyancy, other explicit forces and the
/// velocities of walls.
template <int D, class Backend>
class MphRightHandSide {
 public:
  /// `scratch`: what it holds does not outlive a call here.
  MphRightHandSide(FlowState<D, Backend>& state, const MphPairs<D>& pairs, Buffer<double, Backend>& scratch)
      : state_(state), pairs_(pairs), scratch_(scratch) {
    if (state.theCase.hasBuoyancy()) expansion_ = ExpansionTable::make(state.theCase);
  }

  /// Of number densities and velocities that stay. `adhesion`: of elasticPressure(). `volume`: factors of own
  /// fluid, or empty. `others` may be null. Changes state.velocity where walls move.
  void compute(std::span<const Adhesion<D>> adhesion, std::span<const double> volume,
               const ExplicitForces<D, Backend>* others) {
    elastic_.resize(state_.context, pairs_.activeCount);
    elasticPressure<D>(state_.context, pairs_, state_.particles.numberDensity.span().first(pairs_.activeCount),
                       adhesion, elastic_);
    b_.resize(state_.context, state_.particles.fluidCount);
    inertiaAndGravity<D>(state_.context, pairs_,
                         state_.particles.velocity.span().first(state_.particles.fluidCount), state_.frame, b_);
    if (expansion_) setEach(state_.context, AddBuoyancy<D>{buoyancy(volume), b_.span()}, b_.size());
    addPressureGradient<D>(state_.context, pairs_, elastic_, -1.0, b_);
    if (pairs_.terms.repulsionRadius > 0) addRepulsion<D>(state_.context, pairs_, 1 / state_.timeStep, b_);
    if (others) others->addForces(state_, b_);
    if (state_.theCase.hasRigid()) {
      atRest_.resize(state_.context, b_.size());
      copyValues(state_.context, std::span<const Vec<D>>(b_), atRest_.data());
    }
    if (state_.wallsMove) addWallVelocities();
  }

  /// With the present velocities of walls, those of rigid bodies included, in place of the ones before. Changes
  /// state.velocity.
  void takeWallVelocities() {
    copyValues(state_.context, std::span<const Vec<D>>(atRest_), b_.data());
    addWallVelocities();
  }

  /// With the temperatures at the start of the step; `volume`: of compute().
  Buoyancy<D> buoyancy(std::span<const double> volume) const {
    if (!expansion_) return {};
    const std::uint32_t own = state_.particles.fluidCount;
    return {*expansion_,
            state_.frame,
            pairs_.material.first(own),
            pairs_.position.first(own),
            state_.particles.has.temperatures ? state_.particles.temperature.span().first(own)
                                              : std::span<const double>{},
            volume};
  }

  /// b per own fluid particle [N/m3].
  std::span<Vec<D>> values() { return b_.span(); }
  /// elasticPressure() per active particle [Pa].
  std::span<const double> elastic() const { return elastic_.span(); }
  std::size_t bytes() const { return b_.bytes() + atRest_.bytes() + elastic_.bytes(); }

 private:
  /// b -= A_full (0 on the fluid, u on the walls)
  void addWallVelocities() {
    const std::uint32_t n = pairs_.fluidCount, active = pairs_.activeCount;
    const std::span<const Vec<D>> u = state_.particles.velocity;
    state_.velocity.resize(state_.context, active);
    clearValues(state_.context, state_.velocity.span().first(n));
    copyValues(state_.context, u.subspan(n, active - n), state_.velocity.data() + n);
    addWallDrag<D>(state_.context, pairs_, state_.velocity, b_);
    scratch_.resize(state_.context, active);
    divergence<D>(state_.context, pairs_, state_.velocity, scratch_);
    fillGhosts(state_.context, Held::Active, scratch_.data());
    bulkPressure<D>(state_.context, pairs_, scratch_, {}, scratch_);
    addPressureGradient<D>(state_.context, pairs_, scratch_, -1.0, b_);
  }

  FlowState<D, Backend>& state_;
  const MphPairs<D>& pairs_;
  Buffer<double, Backend>& scratch_;
  std::optional<ExpansionTable> expansion_;  // where some fluid expands
  Buffer<double, Backend> elastic_;
  Buffer<Vec<D>, Backend> b_;       // [N/m3]
  Buffer<Vec<D>, Backend> atRest_;  // b without velocities of walls, for rigid bodies
};

}  // namespace treacle
