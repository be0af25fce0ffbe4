#pragma once

#include "forces_around.hpp"
#include "step_rheology.hpp"
#include "treacle/mph/elasticity.hpp"
#include "treacle/mph/mph_neighbourhood.hpp"
#include "treacle/mph/pressure_stiffness.hpp"

namespace treacle {

/// The stiffness of fluid under pressure in a step of MPH-I (mph/pressure_stiffness.hpp). The system resists the
/// new velocities by an additional viscosity, and its right-hand side gives back the forces that this viscosity
/// has in the gradient of the last velocities, so that only what changes in a step is resisted. A gradient over
/// neighbours does not see particles that swing against each other, and so these are resisted in full.
///
/// Velocities that were extrapolated over more than one step would make the given part unstable.
template <int D, class Backend>
class StepStiffness final : public ForcesAround<D, Backend> {
 public:
  /// `others`: forces that go with these, or null; must outlive this.
  StepStiffness(const Case& c, const ExplicitForces<D, Backend>* others)
      : ForcesAround<D, Backend>(others),
        materials_(StiffMaterials::make(c)),
        limits_(StiffnessLimits::of(c.method.pressureRadius)) {}

  /// Finds who has such a viscosity in the step at hand; acts() tells whether anybody does, in any process.
  /// `rheology`: after its start(), or null where viscosities are those of the materials.
  void find(FlowState<D, Backend>& state, const MphPairs<D>& pairs, const StepRheology<D, Backend>* rheology) {
    const std::uint32_t own = pairs.ownFluid();
    viscosity_.resize(state.context, own);
    const StiffFluid fluid = setStiffness(
        state.context,
        StiffnessTerms{materials_, rheology ? rheology->table() : RheologyTable{}, limits_, pairs.spacing,
                       state.timeStep, pairs.material.first(own),
                       rheology ? rheology->rates() : std::span<const double>{},
                       std::span<const double>(state.particles.pressure).first(own), viscosity_.span()});
    this->setActing(fluid.particles > 0);
    way_ = fluid.way / limits_.most;
  }

  /// In cases with rigid bodies: the velocities of now, before their walls take those that the step tries. These
  /// are extrapolated, and given back they would make bodies unstable.
  void remember(const FlowState<D, Backend>& state, const MphPairs<D>& pairs) {
    if (!state.theCase.hasRigid()) return;
    last_.resize(state.context, pairs.activeCount);
    copyValues(state.context, std::span<const Vec<D>>(state.particles.velocity).first(pairs.activeCount),
               last_.data());
  }

  /// Both viscosities together after scale(), per own particle [Pa s].
  std::span<const double> sum() const { return sum_; }
  /// How far pressures carry particles in the step, in the mean, over the way that needs no such viscosity.
  double way() const { return way_; }
  /// The additional viscosity per own particle [Pa s].
  std::span<const double> viscosity() const { return viscosity_; }

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

  /// Finds the forces that are given back, on the neighbours of the step. Per own particle, `sum` is the viscosity
  /// of the fluid and the stiffness together [Pa s], and `scale` is MphPairs::viscosityScale.
  void prepare(FlowState<D, Backend>& state, const MphPairs<D>& pairs, std::span<const double> sum,
               std::span<const double> scale) {
    Context<Backend>& context = state.context;
    const std::uint32_t own = pairs.ownFluid();
    given_.resize(context, pairs.fluidCount), gradient_.resize(context, pairs.fluidCount);
    correction_.resize(context, own);
    setGivenScale(context, GivenScale{viscosity_.span(), sum, scale, given_.span()});
    const std::span<Vec<D>> last =
        (state.theCase.hasRigid() ? last_ : state.particles.velocity).span().first(pairs.activeCount);
    fillGhosts(context, Held::Active, last.data());
    gradientCorrection<D>(context, pairs, correction_.span(), true);
    MphPairs<D> places = pairs;    // the velocity in walls is that of their places alone,
    places.ownViscosities = true;  // without ownShareAtWall()
    velocityGradient<D>(context, places, correction_.span(), last, gradient_.span().first(own));
    fillGhosts(context, Held::Fluid, given_.data());
    fillGhosts(context, Held::Fluid, gradient_.data());
    const std::span<Vec<D>> force = this->makeForces(context, own);
    clearValues(context, force);
    giveBack<D>(context, withGiven(pairs), gradient_.span(), force);
  }

  std::size_t bytes() const {
    return viscosity_.bytes() + sum_.bytes() + class_.bytes() + given_.bytes() + gradient_.bytes() +
           correction_.bytes() + last_.bytes() + this->forceBytes();
  }

 private:
  MphPairs<D> withGiven(const MphPairs<D>& pairs) const {
    MphPairs<D> given = pairs;
    given.viscosityScale = given_.span().data();
    return given;
  }

  void addWallForces(FlowState<D, Backend>& state, const MphPairs<D>& pairs, const ClusterListView& walls,
                     std::span<Vec<D>> force) const override {
    giveBackOnWalls<D>(state.context, withGiven(pairs), walls, gradient_.span(), force);
  }

  double way_ = 0;
  StiffMaterials materials_;
  StiffnessLimits limits_;
  Buffer<double, Backend> viscosity_;              // per own particle [Pa s]
  Buffer<double, Backend> sum_;                    // with the material's, per fluid particle [Pa s]
  Buffer<std::uint8_t, Backend> class_;            // per active particle
  Buffer<double, Backend> given_;                  // its share of the viscosity scale, per fluid particle
  Buffer<Block<D>, Backend> gradient_;             // of the last velocities, per fluid particle [1/s]
  Buffer<SymmetricBlock<D>, Backend> correction_;  // B
  Buffer<Vec<D>, Backend> last_;                   // velocities, see remember() [m/s]
};

}  // namespace treacle
