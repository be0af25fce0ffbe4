#pragma once

#include "explicit_forces.hpp"
#include "treacle/core/halo.hpp"
#include "treacle/mph/surface_tension.hpp"
#include "treacle/mph/tension.hpp"

namespace treacle {

/// The tension of the fluid in a step of MPH-I, and the shift that keeps its particles in order.
template <int D, class Backend>
class StepTension final : public ExplicitForces<D, Backend> {
 public:
  /// Leaves fluid and walls next to gaps a share of their lambda: the fluid by `b`, that of fluid particles, and
  /// the walls by what is returned. `around`: of the places at hand.
  std::span<const double> letGapsClose(FlowState<D, Backend>& state, const MphPairs<D>& pairs,
                                       const Places& around, std::span<SymmetricBlock<D>> b) {
    Context<Backend>& context = state.context;
    const std::uint32_t own = pairs.ownFluid();
    covered_.resize(context, pairs.fluidCount);
    wallShare_.resize(context, pairs.activeCount);
    treacle::letGapsClose<D>(context, pairs, around, b.first(own), covered_.span().first(own));
    fillGhosts(context, Held::Fluid, covered_.data());
    clearValues(context, wallShare_.span());
    coveredMeans<D>(context, pairs, pairs.wallList, covered_, wallShare_.span());
    letWallsYield(context, wallShare_.span());
    fillGhosts(context, Held::Active, wallShare_.data());
    return wallShare_.span();
  }

  /// The forces of the tensions that particles have, on the neighbours of the step. Walls have the mean of the
  /// fluid around them, by their share. `around`: of the places at hand. letGapsClose() comes first.
  void prepare(FlowState<D, Backend>& state, const MphPairs<D>& pairs, const Places& around) {
    Context<Backend>& context = state.context;
    const std::uint32_t own = pairs.ownFluid();
    const std::span<double> held = state.particles.heldPressure.span().first(pairs.activeCount);
    covered_.resize(context, pairs.fluidCount);
    force_.resize(context, pairs.activeCount);
    coverTension<D>(context, pairs, around, held.first(own), covered_.span().first(own));
    fillGhosts(context, Held::Fluid, covered_.data());
    coveredMeans<D>(context, pairs, pairs.wallList, covered_, held);
    const std::uint32_t fluid = pairs.fluidCount, walls = pairs.ownEnd() - fluid;
    shareTension(context, wallShare_.span().subspan(fluid, walls), held.subspan(fluid, walls));
    fillGhosts(context, Held::Active, held.data());
    tensionForces<D>(context, pairs, pairs.fluidList, held, force_.span());
  }

  void addForces(FlowState<D, Backend>& state, std::span<Vec<D>> y) const override {
    addSurfaceForces<D>(state.context, force_.span().first(y.size()), y);
  }

  void allForces(FlowState<D, Backend>& state, const MphPairs<D>& pairs, const ClusterListView& walls,
                 std::span<Vec<D>> y, std::span<Vec<D>> load) const override {
    const std::uint32_t n = pairs.ownFluid();
    copyValues(state.context, std::span<const Vec<D>>(force_.span()).first(n), y.data());
    clearValues(state.context, y.subspan(n));
    tensionForces<D>(state.context, pairs, walls, tension(state, pairs), y);
    addSurfaceForces<D>(state.context, y.subspan(pairs.fluidCount), load);
  }

  /// What own fluid particles go with.
  std::span<const Vec<D>> transport(FlowState<D, Backend>& state, const MphPairs<D>& pairs) {
    transport_.resize(state.context, pairs.ownFluid());
    spreadVelocities<D>(state.context, pairs, state.timeStep, state.velocity, tension(state, pairs),
                        transport_.span());
    return transport_.span();
  }

  /// Leaves the pressures that act, with the tensions of the step, and renews the tensions of the fluid. `around`:
  /// as in prepare().
  void accept(FlowState<D, Backend>& state, const MphPairs<D>& pairs, const Places& around) {
    Context<Backend>& context = state.context;
    const std::uint32_t own = pairs.ownFluid();
    const std::span<double> held = state.particles.heldPressure.span().first(pairs.activeCount);
    actingPressures<D>(context, pairs, around, held, state.particles.pressure.span().first(pairs.activeCount));
    lackOfDensity<D>(context, pairs, around, covered_.span().first(own));
    fillGhosts(context, Held::Fluid, covered_.data());
    mean_.resize(context, pairs.fluidCount);
    coveredMeans<D>(context, pairs, pairs.fluidList, covered_, mean_.span());
    followDensity<D>(context, pairs, state.timeStep, around, mean_.span().first(own), held.first(own));
  }

  std::span<const Vec<D>> transport() const { return transport_; }  // of the last step
  std::size_t bytes() const {
    return force_.bytes() + covered_.bytes() + wallShare_.bytes() + mean_.bytes() + transport_.bytes();
  }

 private:
  static std::span<const double> tension(const FlowState<D, Backend>& state, const MphPairs<D>& pairs) {
    return state.particles.heldPressure.span().first(pairs.activeCount);
  }

  Buffer<Vec<D>, Backend> force_;      // per active particle; of fluid [N/m3]
  Buffer<Covered, Backend> covered_;   // per fluid particle; ln f, the tension, the lack of density
  Buffer<double, Backend> mean_;       // of the lack, per fluid particle
  Buffer<double, Backend> wallShare_;  // per active particle
  Buffer<Vec<D>, Backend> transport_;  // per own fluid particle [m/s]
};

}  // namespace treacle
