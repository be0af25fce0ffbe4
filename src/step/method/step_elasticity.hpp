#pragma once

#include "forces_around.hpp"
#include "run/failure.hpp"
#include "step_rheology.hpp"
#include "treacle/core/halo.hpp"
#include "treacle/mph/elasticity.hpp"
#include "treacle/step/method/elastic_terms.hpp"
#include "treacle/step/method/set_each.hpp"

#include <array>

namespace treacle {

/// The elastic modes of the fluid in a step of MPH-I. The stress at the end of the step is that of the expected
/// velocities, and the system solves for how it changes with the velocities as for a viscosity (StepRheology), so
/// that the step may be long against the relaxation time.
template <int D, class Backend>
class StepElasticity final : public ForcesAround<D, Backend> {
 public:
  /// `others`: forces that go with these, or null; must outlive this.
  StepElasticity(const Case& c, const ExplicitForces<D, Backend>* others)
      : ForcesAround<D, Backend>(others), table_(ElasticTable::make(c)) {}

  /// What the modes add to the viscosity in the step at hand, per own particle [Pa s], and `others` do; empty: no
  /// others. `rheology`: of the step.
  std::span<const double> implicitViscosity(FlowState<D, Backend>& state, const MphPairs<D>& pairs,
                                            const StepRheology<D, Backend>& rheology,
                                            std::span<const double> others) {
    if (rheology.table().hasSlowness()) {
      slowness_.resize(state.context, pairs.ownFluid());
      setEach(
          state.context,
          Slowness{rheology.table(), pairs.material.first(pairs.ownFluid()), rheology.rates(), slowness_.span()},
          slowness_.size());
    }
    implicit_.resize(state.context, pairs.ownFluid());
    setImplicitViscosity<D>(state.context, {conformations(state, pairs), others, implicit_.span()});
    return implicit_;
  }

  /// With the expected velocities in state.velocity, of all active particles.
  void prepare(FlowState<D, Backend>& state, const MphPairs<D>& pairs) {
    Context<Backend>& context = state.context;
    const std::uint32_t own = pairs.ownFluid();
    correction_.resize(context, own), gradient_.resize(context, own);
    carried_.resize(context, pairs.fluidCount);
    gradientCorrection<D>(context, pairs, correction_.span(), false);
    expectStress<D>(context, {elasticState(state, pairs), correction_.span(), carried_.span().first(own)});
    fillGhosts(context, Held::Fluid, carried_.data());
    stressForces<D>(context, pairs, carried_.span(), this->makeForces(context, own));
  }

  /// The conformations that follow from the velocities of the solve. Errors: RunError if some are not finite.
  void solve(FlowState<D, Backend>& state, const MphPairs<D>& pairs) {
    if (state.theCase.heat) power_.resize(state.context, pairs.ownFluid());
    AdvancedModes<D> terms{elasticState(state, pairs), {}, power_.span()};
    for (std::size_t k = 0; k < state.particles.has.elasticModes; ++k) {
      next_[k].resize(state.context, pairs.ownFluid());
      terms.next[k] = next_[k].data();
    }
    if (const double bad = advanceModes<D>(state.context, terms); bad > 0) throw RunError(describeElasticity(bad));
  }

  /// The power of the stresses of the last solve beside what the system had of them as a viscosity, per own
  /// particle [W/m3]; empty without heat.
  std::span<const double> power() const { return power_; }

  void accept(FlowState<D, Backend>& state) {
    for (std::size_t k = 0; k < state.particles.has.elasticModes; ++k)
      copyValues(state.context, std::span<const SymmetricBlock<D>>(next_[k]),
                 state.particles.conformation[k].data());
  }

  std::span<const Vec<3>> couples() const override { return couple_; }

  std::size_t bytes() const {
    std::size_t sum = couple_.bytes() + implicit_.bytes() + correction_.bytes() + gradient_.bytes() +
                      carried_.bytes() + slowness_.bytes() + power_.bytes() + this->forceBytes();
    for (const auto& next : next_) sum += next.bytes();
    return sum;
  }

 private:
  void addWallForces(FlowState<D, Backend>& state, const MphPairs<D>& pairs, const ClusterListView& walls,
                     std::span<Vec<D>> force) const override {
    couple_.resize(state.context, force.size());
    clearValues(state.context, couple_.span());
    stressOnWalls<D>(state.context, pairs, walls, carried_.span(), force, couple_.span());
  }
  /// With the gradient of state.velocity.
  ElasticState<D> elasticState(FlowState<D, Backend>& state, const MphPairs<D>& pairs) {
    velocityGradient<D>(state.context, pairs, correction_.span(), state.velocity.span(), gradient_.span());
    return conformations(state, pairs);
  }
  ElasticState<D> conformations(const FlowState<D, Backend>& state, const MphPairs<D>& pairs) const {
    ElasticState<D> of{table_, state.timeStep,   pairs.material.first(pairs.ownFluid()),
                       {},     gradient_.span(), slowness_.span()};
    for (std::size_t k = 0; k < state.particles.has.elasticModes; ++k)
      of.conformation[k] = state.particles.conformation[k].data();
    return of;
  }

  ElasticTable table_;
  Buffer<double, Backend> implicit_;               // [Pa s]
  Buffer<double, Backend> slowness_;               // RheologyTable::slowness [-]
  Buffer<double, Backend> power_;                  // [W/m3]
  Buffer<SymmetricBlock<D>, Backend> correction_;  // B
  Buffer<Block<D>, Backend> gradient_;             // [1/s]
  Buffer<Block<D>, Backend> carried_;              // the stress times B, per fluid particle [Pa]
  mutable Buffer<Vec<3>, Backend> couple_;         // stressOnWalls(), per active wall particle [N/m2]
  std::array<Buffer<SymmetricBlock<D>, Backend>, maxElasticModes> next_;
};

}  // namespace treacle
