#pragma once

#include "explicit_forces.hpp"
#include "step_rheology.hpp"
#include "treacle/mph/elasticity.hpp"
#include "treacle/mph/mph_neighbourhood.hpp"
#include "treacle/mph/pressure_stiffness.hpp"
#include "treacle/mph/surface_tension.hpp"

namespace treacle {

/// The stiffness of fluid under pressure in a step of MPH-I (mph/pressure_stiffness.hpp). The system resists the
/// new velocities by an additional viscosity, and its right-hand side has the stress that the last velocities
/// would have by it, so that only what changes in a step is resisted. A gradient over neighbours does not see
/// particles that swing against each other, and so these are resisted in full.
///
/// Velocities that were extrapolated over more than one step would make the given part unstable.
template <int D, class Backend>
class StepStiffness final : public ExplicitForces<D, Backend> {
 public:
  /// `others`: forces that go with these, or null; must outlive this.
  StepStiffness(const Case& c, const ExplicitForces<D, Backend>* others)
      : others_(others),
        materials_(StiffMaterials::make(c)),
        limits_(StiffnessLimits::of(c.method.pressureRadius)) {}

  /// Whether some fluid has such a viscosity in the step at hand, in any process. `rheology`: after its start(),
  /// or null where viscosities are those of the materials.
  bool find(FlowState<D, Backend>& state, const MphPairs<D>& pairs, const StepRheology<D, Backend>* rheology) {
    const std::uint32_t own = pairs.ownFluid();
    viscosity_.resize(state.context, own);
    const double count = setStiffness(
        state.context,
        StiffnessTerms{materials_, rheology ? rheology->table() : RheologyTable{}, limits_, pairs.spacing,
                       state.timeStep, pairs.material.first(own),
                       rheology ? rheology->rates() : std::span<const double>{},
                       std::span<const double>(state.particles.pressure).first(own), viscosity_.span()});
    acts_ = count > 0;
    return acts_;
  }
  bool acts() const { return acts_; }

  /// Both viscosities together after scale(), per own particle [Pa s].
  std::span<const double> sum() const { return sum_; }
  /// Per own particle [Pa s]; empty where nobody has one.
  std::span<const double> viscosity() const {
    return acts_ ? std::span<const double>(viscosity_) : std::span<const double>{};
  }

  /// Where viscosities are those of the materials: multiplies the viscosity scale of own particles, and sets their
  /// classes.
  void scale(FlowState<D, Backend>& state, MphNeighbourhood<D, Backend>& neighbourhood, std::span<double> scale) {
    const MphPairs<D>& pairs = neighbourhood.pairs();
    sum_.resize(state.context, pairs.fluidCount);
    class_.resize(state.context, pairs.activeCount);
    setStiffScale(state.context, StiffScale{materials_, pairs.material, viscosity_.span(), scale, sum_.span()});
    fillGhosts(state.context, Held::Fluid, sum_.data());
    setClasses(state.context, ClassTerms{pairs.classes, pairs.material, sum_.span(), class_.span()});
    neighbourhood.setViscosityClasses(class_);
  }

  /// What of it is given back, on the neighbours of the step, where the viscosities of own particles, both
  /// together, are `sum` [Pa s] and MphPairs::viscosityScale is `scale`.
  void prepare(FlowState<D, Backend>& state, const MphPairs<D>& pairs, std::span<const double> sum,
               std::span<const double> scale) {
    if (!acts_) return;
    Context<Backend>& context = state.context;
    const std::uint32_t own = pairs.ownFluid();
    given_.resize(context, pairs.fluidCount), gradient_.resize(context, pairs.fluidCount);
    correction_.resize(context, own), force_.resize(context, own);
    setGivenScale(context, GivenScale{viscosity_.span(), sum, scale, given_.span()});
    const std::span<Vec<D>> last = state.particles.velocity.span().first(pairs.activeCount);
    fillGhosts(context, Held::Active, last.data());
    gradientCorrection<D>(context, pairs, correction_.span(), true);
    MphPairs<D> places = pairs;  // the velocity in walls is that of their places alone
    places.classes.ofNeighbours = false;
    velocityGradient<D>(context, places, correction_.span(), last, gradient_.span().first(own));
    fillGhosts(context, Held::Fluid, given_.data());
    fillGhosts(context, Held::Fluid, gradient_.data());
    clearValues(context, force_.span());
    giveBack<D>(context, withGiven(pairs), gradient_.span(), force_.span());
  }

  void addForces(FlowState<D, Backend>& state, std::span<Vec<D>> y) const override {
    if (others_) others_->addForces(state, y);
    if (acts_) addSurfaceForces<D>(state.context, force_.span().first(y.size()), y);
  }
  void allForces(FlowState<D, Backend>& state, const MphPairs<D>& pairs, const ClusterListView& walls,
                 std::span<Vec<D>> y, std::span<Vec<D>> load) const override {
    const std::uint32_t n = pairs.ownFluid();
    if (others_)
      others_->allForces(state, pairs, walls, y, load);
    else
      clearValues(state.context, y);
    if (!acts_) return;
    addSurfaceForces<D>(state.context, force_.span().first(n), y.first(n));
    onWalls_.resize(state.context, y.size() - pairs.fluidCount);
    clearValues(state.context, onWalls_.span());
    giveBackOnWalls<D>(state.context, withGiven(pairs), walls, gradient_.span(), onWalls_.span());
    addSurfaceForces<D>(state.context, onWalls_.span(), y.subspan(pairs.fluidCount));
    addSurfaceForces<D>(state.context, onWalls_.span(), load);
  }

  std::size_t bytes() const {
    return viscosity_.bytes() + sum_.bytes() + class_.bytes() + given_.bytes() + gradient_.bytes() +
           correction_.bytes() + force_.bytes() + onWalls_.bytes();
  }

 private:
  MphPairs<D> withGiven(const MphPairs<D>& pairs) const {
    MphPairs<D> given = pairs;
    given.viscosityScale = given_.span().data();
    return given;
  }

  const ExplicitForces<D, Backend>* others_;
  StiffMaterials materials_;
  StiffnessLimits limits_;
  bool acts_ = false;                              // in the step at hand
  Buffer<double, Backend> viscosity_;              // per own particle [Pa s]
  Buffer<double, Backend> sum_;                    // with the material's, per fluid particle [Pa s]
  Buffer<std::uint8_t, Backend> class_;            // per active particle
  Buffer<double, Backend> given_;                  // its share of the viscosity scale, per fluid particle
  Buffer<Block<D>, Backend> gradient_;             // of the last velocities, per fluid particle [1/s]
  Buffer<SymmetricBlock<D>, Backend> correction_;  // B
  Buffer<Vec<D>, Backend> force_;                  // [N/m3]
  mutable Buffer<Vec<D>, Backend> onWalls_;        // per active wall particle [N/m3]
};

}  // namespace treacle
