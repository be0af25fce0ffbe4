#pragma once

#include "run/failure.hpp"
#include "run/flow_state.hpp"
#include "treacle/core/halo.hpp"
#include "treacle/mph/mph_balance.hpp"
#include "treacle/mph/mph_neighbourhood.hpp"
#include "treacle/mph/particle_viscosity.hpp"
#include "treacle/mph/viscosity_scale.hpp"

#include <vector>

namespace treacle {

/// The viscosities of a step of MPH-I where particles have their own: from the temperatures and factors that the
/// particles carry and the shear rates of the flow that the step begins its solve with, then from those of each
/// solve. What is not accepted has not changed the particles.
template <int D, class Backend>
class StepRheology {
 public:
  explicit StepRheology(const Case& c)
      : table_(RheologyTable::make(c, formulas_)),
        settings_(c.rheology),
        correction_(c.method.viscosityCorrection) {}

  /// The laws of states, in the backend's memory, and what the particles carry in the step at hand.
  const RheologyTable& table() const { return table_; }
  /// The shear rates of the viscosities, and those of the last solve [1/s].
  std::span<const double> rates() const { return rate_; }
  std::span<const double> foundRates() const { return found_; }

  /// By what the volumes of fluid particles are multiplied in the step at hand, ghosts included [-]; empty where
  /// no material has a factor. At the shear rates of the step before. Errors: RunError for factors out of bounds.
  std::span<const double> setVolumes(FlowState<D, Backend>& state, const MphPairs<D>& pairs) {
    if (!state.theCase.hasVolumeFactors()) return {};
    const std::uint32_t own = pairs.ownFluid();
    read(state, own);
    volume_.resize(state.context, pairs.fluidCount);
    const double bad = treacle::setVolumes(
        state.context, VolumeTerms{table_, pairs.material.first(own), state.particles.shearRate.span().first(own),
                                   volume_.span()});
    if (bad > 0) throw RunError(describeVolumes(bad));
    fillGhosts(state.context, Held::Fluid, volume_.data());
    return volume_;
  }
  /// The viscosities of fluid particles, ghosts included, and what the pairs take as scale [Pa s].
  std::span<const double> viscosities() const { return viscosity_; }
  std::span<const double> scaled() const { return scaled_; }
  /// Those of the step at hand.
  std::span<const double> volumes() const { return volume_; }

  /// What is added to the viscosity in the step at hand, per own particle [Pa s]; empty: nothing.
  void setImplicit(std::span<const double> viscosity) { table_.implicit = viscosity; }

  /// For the first solve of a step, on its neighbours and walls' surfaces; from its first guess, state.velocity,
  /// ghosts included: with the rates of the step before, most steps would need another solve. apply() is to
  /// follow.
  void start(FlowState<D, Backend>& state, MphNeighbourhood<D, Backend>& neighbourhood) {
    const std::uint32_t fluid = neighbourhood.pairs().fluidCount, own = neighbourhood.pairs().ownFluid();
    setImplicit({});
    for (Buffer<double, Backend>* field : {&share_, &viscosity_, &scaled_}) field->resize(state.context, fluid);
    for (Buffer<double, Backend>* field : {&rate_, &found_}) field->resize(state.context, own);
    class_.resize(state.context, neighbourhood.pairs().activeCount);
    neighbourhood.setViscosities({}, {});
    viscosityScale<D>(state.context, neighbourhood.pairs(), 1, share_.span());
    shearRate<D>(state.context, neighbourhood.pairs(), state.velocity, share_, rate_);
    read(state, own);
    solves_ = 0;
  }

  /// Sets the viscosities of rates(). Errors: RunError for viscosities that are negative or not finite.
  void apply(FlowState<D, Backend>& state, MphNeighbourhood<D, Backend>& neighbourhood) {
    const MphPairs<D>& pairs = neighbourhood.pairs();
    setViscosities(state.context, ViscosityTerms{table_, correction_, pairs.material, rate_.span(), share_.span(),
                                                 viscosity_.span(), scaled_.span()});
    if (!formulas_.empty())
      if (const double bad = countUnsound(state.context, viscosity_.span().first(pairs.ownFluid())); bad > 0)
        throw RunError(describeViscosities(bad));
    fillGhosts(state.context, Held::Fluid, viscosity_.data());
    fillGhosts(state.context, Held::Fluid, scaled_.data());
    setClasses(state.context, ClassTerms{pairs.classes, pairs.material, viscosity_.span(), class_.span()});
    neighbourhood.setViscosities(scaled_, class_);
  }

  /// Takes the velocities of a solve, state.velocity, ghosts included; whether the step is to be solved once more,
  /// with viscosities that follow from them.
  bool follow(FlowState<D, Backend>& state, MphNeighbourhood<D, Backend>& neighbourhood) {
    const MphPairs<D>& pairs = neighbourhood.pairs();
    const std::uint32_t own = pairs.ownFluid();
    shearRate<D>(state.context, pairs, state.velocity, share_, found_);
    change_ = nextRates(state.context,
                        RateTerms{table_, pairs.material, rate_.span().first(own), found_.span().first(own),
                                  viscosity_.span().first(own), rate_.span().first(own)});
    if (++solves_ >= settings_.iterations || change_ <= settings_.tolerance) return false;
    apply(state, neighbourhood);
    return true;
  }

  /// Whether viscosities have changed so much that what is known of the spectrum of the last system says little of
  /// the next one's: a smoother that takes an eigenvalue for too small lets residuals grow.
  bool isAnother() const { return change_ > 0.1; }

  /// The particles take the rates that the last solve has led to.
  void accept(FlowState<D, Backend>& state) {
    copyValues(state.context, std::span<const double>(rate_), state.particles.shearRate.data());
  }

  std::size_t bytes() const {
    return steps_.bytes() + share_.bytes() + viscosity_.bytes() + scaled_.bytes() + rate_.bytes() +
           found_.bytes() + class_.bytes() + volume_.bytes();
  }

 private:
  void read(FlowState<D, Backend>& state, std::uint32_t own) {
    table_.read(state.particles, own, state.time);
    if (formulas_.empty() || !steps_.empty()) return;
    fromHost(state.context, std::span<const FormulaStep>(formulas_), steps_);
    table_.states.steps = steps_.data();
  }

  std::vector<FormulaStep> formulas_;
  Buffer<FormulaStep, Backend> steps_;  // the same
  RheologyTable table_;
  RheologySettings settings_;
  double correction_;
  int solves_ = 0;                                      // of the step at hand
  double change_ = 0;                                   // of the viscosity by the last solve
  Buffer<double, Backend> share_, viscosity_, scaled_;  // per fluid particle: 1/m_i [-], mu_i and s_i mu_i [Pa s]
  Buffer<double, Backend> rate_, found_;  // per own one: gamma of these viscosities, and of the last solve [1/s]
  Buffer<std::uint8_t, Backend> class_;   // per active particle
  Buffer<double, Backend> volume_;        // per fluid particle [-]
};

}  // namespace treacle
