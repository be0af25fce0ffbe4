#pragma once

#include "flow_state.hpp"
#include "step_surface.hpp"
#include "treacle/model/balance.hpp"
#include "treacle/model/wall_motion.hpp"
#include "treacle/mph/mph_balance.hpp"
#include "treacle/mph/mph_neighbourhood.hpp"
#include "treacle/mph/mph_repulsion.hpp"
#include "treacle/step/balance_sums.hpp"

#include <algorithm>
#include <cmath>

namespace treacle {

/// Makes the balance of a step of MPH-I, and holds what that takes.
template <int D, class Backend>
class StepBalance {
 public:
  /// Once state.velocity and the pressures are those of the end of the step; positions and particles' velocities
  /// are still those of its start. `divergence`: C^T u^{k+1}, `elastic`: kappa [n - n_0]_+, per active particle;
  /// `surface`: null where no fluid has a surface tension.
  Balance make(FlowState<D, Backend>& state, const MphNeighbourhood<D, Backend>& neighbourhood,
               std::span<const double> divergence, std::span<const double> elastic,
               const StepSurface<D, Backend>* surface) {
    const MphPairs<D>& pairs = neighbourhood.pairs();
    sumPairs(state, neighbourhood, surface);
    Balance balance;
    setPowers(state, pairs, divergence, elastic, surface, balance);
    setLoads(state, pairs, balance);
    return balance;
  }

  std::size_t bytes() const {
    return walls_.bytes() + shear_.bytes() + wallForce_.bytes() + wallDivergence_.bytes() + wallDensity_.bytes() +
           repulsion_.bytes() + surfaceForce_.bytes() + surfaceOfWalls_.bytes();
  }

 private:
  void sumPairs(FlowState<D, Backend>& state, const MphNeighbourhood<D, Backend>& neighbourhood,
                const StepSurface<D, Backend>* surface) {
    const MphPairs<D>& pairs = neighbourhood.pairs();
    const std::uint32_t n = pairs.fluidCount, active = pairs.activeCount;  // of ghosts nothing is summed
    ClusterListView walls = pairs.wallList;
    if (walls.offset) {  // the lists of the step reach only as far as pressures
      const double reach = std::max(pairs.terms.densityRadius, pairs.terms.viscosityRadius);
      buildClusterList<D>(state.context, pairs.grid, neighbourhood.ranges(), pairs.position, n, pairs.ownEnd(),
                          {reach, 0}, true, walls_);
      walls = walls_.view();
    }
    shear_.resize(state.context, n);
    wallForce_.resize(state.context, active - n);
    wallDivergence_.resize(state.context, active - n);
    wallDensity_.resize(state.context, active - n);
    shearDissipation<D>(state.context, pairs, state.velocity, shear_);
    fluidAtWalls<D>(state.context, pairs, walls, state.velocity, state.particles.pressure.span().first(active),
                    {wallForce_.span(), wallDivergence_.span(), wallDensity_.span()});
    if (pairs.terms.repulsionRadius > 0) {
      const double rate = 1 / state.timeStep;
      repulsion_.resize(state.context, n);
      repulsionPower<D>(state.context, pairs, rate, state.velocity, repulsion_);
      addRepulsionOnWalls<D>(state.context, pairs, rate, wallForce_);
    }
    if (!surface) return;
    surfaceForce_.resize(state.context, active);
    surfaceOfWalls_.resize(state.context, n);
    surface->allForces(state, pairs, walls, surfaceOfWalls_.span(), surfaceForce_.span(), wallForce_.span());
  }

  void setPowers(FlowState<D, Backend>& state, const MphPairs<D>& pairs, std::span<const double> divergence,
                 std::span<const double> elastic, const StepSurface<D, Backend>* surface, Balance& balance) {
    using Terms = PowerTerms<D>;
    const Terms terms{pairs.fluidCount,
                      pairs.ownFluid(),
                      pairs.materials,
                      pairs.material,
                      state.particles.velocity,
                      state.velocity,
                      divergence,
                      elastic,
                      shear_,
                      wallDivergence_,
                      wallDensity_,
                      repulsion_,
                      surfaceForce_,
                      surface ? surface->slope() : std::span<const Vec<D>>{}};
    const auto sums = sumPowers<D>(state.context, terms, pairs.ownEnd());
    const double volume = std::pow(pairs.spacing, D);  // [K23 eq. (11)]
    balance.shearDissipation = volume * sums[Terms::Shear];
    balance.bulkDissipation = volume * sums[Terms::Bulk];
    balance.inertialLoss = volume * sums[Terms::Inertial];
    balance.elasticPower = volume * sums[Terms::Elastic];
    balance.repulsionPower = volume * sums[Terms::Repulsion];
    balance.surfacePower = volume * sums[Terms::Surface];
    balance.surfaceEnergy = volume * sums[Terms::SurfaceEnergy];
    balance.elasticEnergy = volume * sums[Terms::ElasticEnergy];
  }

  void setLoads(FlowState<D, Backend>& state, const MphPairs<D>& pairs, Balance& balance) {
    const std::uint32_t n = pairs.fluidCount, walls = pairs.ownEnd() - n;
    const LoadTerms<D> terms{state.particles.body.span().subspan(n, walls), pairs.position.subspan(n, walls),
                             state.velocity.span().subspan(n, walls), wallForce_};
    const std::vector<LoadSums> loads = sumLoads<D>(state.context, terms, state.theCase.bodies.size());
    const double volume = std::pow(pairs.spacing, D);
    for (std::size_t b = 0; b < loads.size(); ++b) {
      if (state.theCase.bodies[b].kind != BodyKind::Wall) continue;
      const LoadSums& load = loads[b];
      balance.wallPower -= volume * load.power;
      balance.walls.push_back(
          {volume * load.force,
           volume * (load.torque - cross(wallCenter(state.theCase.bodies[b], state.time), load.force))});
    }
  }

  ClusterList<Backend> walls_;
  Buffer<double, Backend> shear_;           // [W/m3]
  Buffer<Vec<D>, Backend> wallForce_;       // [N/m3]
  Buffer<double, Backend> wallDivergence_;  // [1/s]
  Buffer<double, Backend> wallDensity_;     // [-]
  Buffer<double, Backend> repulsion_;       // [W/m3]; empty where the scheme has none
  // Of surface tension, empty where there is none: per active particle, and per fluid particle that of walls
  // [N/m3].
  Buffer<Vec<D>, Backend> surfaceForce_, surfaceOfWalls_;
};

}  // namespace treacle
