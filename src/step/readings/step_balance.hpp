#pragma once

#include "method/step_surface.hpp"
#include "method/step_tension.hpp"
#include "run/flow_state.hpp"
#include "treacle/model/motion/wall_motion.hpp"
#include "treacle/model/state/balance.hpp"
#include "treacle/mph/mph_balance.hpp"
#include "treacle/mph/mph_neighbourhood.hpp"
#include "treacle/mph/mph_repulsion.hpp"
#include "treacle/step/readings/balance_sums.hpp"
#include "walls/wall_forces.hpp"

#include <algorithm>
#include <cmath>

namespace treacle {

/// Makes the balance of a step of MPH-I, and holds what that takes.
template <int D, class Backend>
class StepBalance {
 public:
  /// `walls`: of the same step, prepared; must outlive this.
  explicit StepBalance(WallForces<D, Backend>& walls) : walls_(walls) {}

  /// Once state.velocity and the pressures are those of the end of the step; positions and particles' velocities
  /// are still those of its start. `divergence`: C^T u^{k+1}, `elastic`: elasticPressure(), per active particle;
  /// `surface`, `tension`: null where the case has none; it has at most one of them. `others`: all explicit
  /// forces, or null. `buoyancy`: of own fluid.
  Balance make(FlowState<D, Backend>& state, const MphPairs<D>& pairs, std::span<const double> divergence,
               std::span<const double> elastic, const StepSurface<D, Backend>* surface,
               const StepTension<D, Backend>* tension, const ExplicitForces<D, Backend>* others,
               const Buoyancy<D>& buoyancy) {
    sumPairs(state, pairs, others);
    Balance balance;
    setPowers(state, pairs, divergence, elastic, surface, tension, buoyancy, balance);
    setLoads(state, pairs, balance);
    return balance;
  }

  std::size_t bytes() const { return shear_.bytes() + repulsion_.bytes(); }

 private:
  void sumPairs(FlowState<D, Backend>& state, const MphPairs<D>& pairs, const ExplicitForces<D, Backend>* others) {
    const std::uint32_t n = pairs.fluidCount;
    shear_.resize(state.context, n);
    shearDissipation<D>(state.context, pairs, state.velocity, shear_);
    walls_.sum(state, pairs, state.velocity, state.particles.pressure.span().first(pairs.activeCount), others);
    if (pairs.terms.repulsionRadius == 0) return;
    repulsion_.resize(state.context, n);
    repulsionPower<D>(state.context, pairs, 1 / state.timeStep, state.velocity, repulsion_);
  }

  void setPowers(FlowState<D, Backend>& state, const MphPairs<D>& pairs, std::span<const double> divergence,
                 std::span<const double> elastic, const StepSurface<D, Backend>* surface,
                 const StepTension<D, Backend>* tension, const Buoyancy<D>& buoyancy, Balance& balance) {
    using Terms = PowerTerms<D>;
    const Terms terms{pairs.fluidCount,
                      pairs.ownFluid(),
                      pairs.materials,
                      pairs.bulkShare(),
                      pairs.material,
                      state.particles.velocity,
                      state.velocity,
                      divergence,
                      elastic,
                      shear_,
                      walls_.divergence(),
                      walls_.density(),
                      repulsion_,
                      walls_.otherForce(),
                      surface ? surface->slope() : std::span<const SurfaceSlope<D>>{},
                      tension ? tension->transport() : std::span<const Vec<D>>{},
                      pairs.position,
                      state.frame,
                      state.velocityStep,
                      buoyancy};
    const auto sums = sumPowers<D>(state.context, terms, pairs.ownEnd());
    const double volume = std::pow(pairs.spacing, D);  // [K23 eq. (11)]
    balance.shearDissipation = volume * sums[Terms::Shear];
    balance.bulkDissipation = volume * sums[Terms::Bulk];
    balance.inertialLoss = volume * sums[Terms::Inertial];
    balance.elasticPower = volume * sums[Terms::Elastic];
    balance.repulsionPower = volume * sums[Terms::Repulsion];
    (surface ? balance.surfacePower : balance.elasticPower) += volume * sums[Terms::Force];
    balance.shiftPower = volume * sums[Terms::Shift];
    balance.buoyancyPower = volume * sums[Terms::Buoyant];
    balance.surfaceEnergy = volume * sums[Terms::SurfaceEnergy];
    balance.elasticEnergy = volume * sums[Terms::ElasticEnergy];
  }

  void setLoads(FlowState<D, Backend>& state, const MphPairs<D>& pairs, Balance& balance) {
    const std::vector<LoadSums> loads = walls_.loads(state, pairs, state.velocity);
    balance.walls = wallLoads(state, loads);
    balance.patches = walls_.pressures(state, pairs);
    for (const WallLoad& load : balance.walls) balance.wallPower -= load.power;
  }

  WallForces<D, Backend>& walls_;
  Buffer<double, Backend> shear_;      // [W/m3]
  Buffer<double, Backend> repulsion_;  // [W/m3]; empty where the scheme has none
};

}  // namespace treacle
