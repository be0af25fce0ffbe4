#pragma once

#include "step_elasticity.hpp"
#include "step_rheology.hpp"
#include "step_stiffness.hpp"

#include <optional>

namespace treacle {

/// The viscosities of a step of MPH-I, as the pairs of the neighbourhood have them: those of the materials or the
/// particles' own, what free surfaces get for missing neighbours, and what long steps take under pressure.
template <int D, class Backend>
class StepViscosities {
 public:
  explicit StepViscosities(const Case& c) : correction_(c.method.viscosityCorrection) {
    if (c.hasOwnViscosities()) rheology_.emplace(c);
  }
  /// For the accurate scheme. `others`: forces that go with those of the stiffness, or null; must outlive this.
  void addStiffness(const Case& c, const ExplicitForces<D, Backend>* others) { stiffness_.emplace(c, others); }

  /// Where particles have their own viscosities; else null.
  StepRheology<D, Backend>* rheology() { return rheology_ ? &*rheology_ : nullptr; }
  const StepRheology<D, Backend>* rheology() const { return rheology_ ? &*rheology_ : nullptr; }
  /// In the accurate scheme; else null.
  const StepStiffness<D, Backend>* stiffness() const { return stiffness_ ? &*stiffness_ : nullptr; }

  /// Whether those of the step at hand are not those of the materials, so that what is known of the spectrum of
  /// one step's system says little of the next one's.
  bool change() const { return rheology_ || isStiff(); }

  /// Finds those of the step at hand, with its matrix B. Where particles have their own, the first guess is in
  /// state.velocity, ghosts included. `elasticity`: of the case, or null. Errors: RunError for viscosities that
  /// are not finite.
  void set(FlowState<D, Backend>& state, MphNeighbourhood<D, Backend>& neighbourhood,
           StepElasticity<D, Backend>* elasticity) {
    const MphPairs<D>& pairs = neighbourhood.pairs();
    if (rheology_) rheology_->start(state, neighbourhood);
    if (stiffness_) stiffness_->find(state, pairs, rheology());
    if (!rheology_) return setOfMaterials(state, neighbourhood);
    std::span<const double> added = isStiff() ? stiffness_->viscosity() : std::span<const double>{};
    if (elasticity) added = elasticity->implicitViscosity(state, pairs, *rheology_, added);
    rheology_->setImplicit(added);
    rheology_->apply(state, neighbourhood);
  }

  /// Before walls of rigid bodies take the velocities that the step tries.
  void remember(const FlowState<D, Backend>& state, const MphPairs<D>& pairs) {
    if (stiffness_) stiffness_->remember(state, pairs);
  }

  /// The forces that the stiffness gives back, with the viscosities of set().
  void giveBack(FlowState<D, Backend>& state, const MphPairs<D>& pairs) {
    if (!isStiff()) return;
    rheology_ ? stiffness_->prepare(state, pairs, rheology_->viscosities(), rheology_->scaled())
              : stiffness_->prepare(state, pairs, stiffness_->sum(), scale_);
  }

  std::size_t bytes() const {
    return scale_.bytes() + (rheology_ ? rheology_->bytes() : 0) + (stiffness_ ? stiffness_->bytes() : 0);
  }

 private:
  bool isStiff() const { return stiffness_ && stiffness_->acts(); }

  void setOfMaterials(FlowState<D, Backend>& state, MphNeighbourhood<D, Backend>& neighbourhood) {
    neighbourhood.setViscosities({}, {});
    if (correction_ == 0 && !isStiff()) return;
    scale_.resize(state.context, neighbourhood.pairs().fluidCount);
    viscosityScale<D>(state.context, neighbourhood.pairs(), correction_, scale_.span());
    if (isStiff()) stiffness_->scale(state, neighbourhood, scale_.span());
    fillGhosts(state.context, Held::Fluid, scale_.data());
    neighbourhood.setViscosityScale(scale_);
  }

  double correction_;                                   // method.viscosity_correction
  Buffer<double, Backend> scale_;                       // MphPairs::viscosityScale of materials' viscosities [-]
  std::optional<StepRheology<D, Backend>> rheology_;    // where particles have their own
  std::optional<StepStiffness<D, Backend>> stiffness_;  // in the accurate scheme
};

}  // namespace treacle
