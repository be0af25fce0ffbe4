#pragma once

#include "method/explicit_forces.hpp"
#include "treacle/mph/mph_balance.hpp"
#include "treacle/mph/mph_neighbourhood.hpp"
#include "treacle/mph/mph_repulsion.hpp"
#include "wall_loads.hpp"

#include <algorithm>
#include <vector>

namespace treacle {

/// What walls bear of the fluid in a step of MPH-I, and holds what that takes.
template <int D, class Backend>
class WallForces {
 public:
  /// On the neighbours of the step, once they are there.
  void prepare(FlowState<D, Backend>& state, const MphNeighbourhood<D, Backend>& neighbourhood) {
    const MphPairs<D>& pairs = neighbourhood.pairs();
    const std::uint32_t n = pairs.fluidCount;
    walls_ = pairs.wallList;
    if (!walls_.offset) return;
    // The lists of the step reach only as far as pressures.
    const double reach = std::max(pairs.terms.densityRadius, pairs.terms.viscosityRadius);
    buildClusterList<D>(state.context, pairs.grid, neighbourhood.ranges(), pairs.position,
                        {n, pairs.ownEnd(), {reach, 0}, true, pairs.side}, list_);
    walls_ = list_.view();
  }

  /// With these velocities and pressures of all active particles. `others`: null where there are none.
  void sum(FlowState<D, Backend>& state, const MphPairs<D>& pairs, std::span<const Vec<D>> u,
           std::span<const double> pressure, const ExplicitForces<D, Backend>* others) {
    const std::uint32_t n = pairs.fluidCount, active = pairs.activeCount;  // of ghosts nothing is summed
    force_.resize(state.context, active - n);
    divergence_.resize(state.context, active - n);
    density_.resize(state.context, active - n);
    fluidAtWalls<D>(state.context, pairs, walls_, u, pressure,
                    {force_.span(), divergence_.span(), density_.span()});
    if (pairs.terms.repulsionRadius > 0) addRepulsionOnWalls<D>(state.context, pairs, 1 / state.timeStep, force_);
    others_ = others;
    if (!others) return;
    otherForce_.resize(state.context, active);
    others->allForces(state, pairs, walls_, otherForce_.span(), force_.span());
  }

  /// Per body of the case, of all processes, after sum() with the velocities `u` [N], [N m] and [W]; in 2D per
  /// metre of depth.
  std::vector<LoadSums> loads(FlowState<D, Backend>& state, const MphPairs<D>& pairs, std::span<const Vec<D>> u) {
    std::vector<LoadSums> loads = loadsOfBodies<D, Backend>(
        state, pairs.fluidCount, pairs.position, u, force_.span().first(pairs.ownEnd() - pairs.fluidCount),
        others_ ? others_->couples() : std::span<const Vec<3>>{});
    if (others_) others_->addLoads(loads);
    return loads;
  }

  /// On patches of walls, likewise.
  std::vector<double> pressures(FlowState<D, Backend>& state, const MphPairs<D>& pairs) {
    return patchPressures<D, Backend>(state, pairs.fluidCount, pairs.position,
                                      force_.span().first(pairs.ownEnd() - pairs.fluidCount));
  }

  const ClusterListView& walls() const { return walls_; }             // their neighbours, as far as any pair acts
  std::span<const double> divergence() const { return divergence_; }  // the fluid's part, per wall particle [1/s]
  std::span<const double> density() const { return density_; }        // likewise [-]

  std::span<const Vec<D>> otherForce() const {
    return otherForce_;
  }  // of ExplicitForces, per active particle [N/m3], or empty

  std::size_t bytes() const {
    return list_.bytes() + force_.bytes() + divergence_.bytes() + density_.bytes() + otherForce_.bytes();
  }

 private:
  ClusterList<Backend> list_;
  ClusterListView walls_;
  Buffer<Vec<D>, Backend> force_;                       // per active wall particle [N/m3]
  Buffer<double, Backend> divergence_;                  // [1/s]
  Buffer<double, Backend> density_;                     // [-]
  Buffer<Vec<D>, Backend> otherForce_;                  // of ExplicitForces, per active particle [N/m3]
  const ExplicitForces<D, Backend>* others_ = nullptr;  // of the last sum()
};

}  // namespace treacle
