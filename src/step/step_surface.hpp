#pragma once

#include "flow_state.hpp"
#include "treacle/core/halo.hpp"
#include "treacle/mph/surface_tension.hpp"

namespace treacle {

/// The surface tension of a step of MPH-I, of the places at its start.
template <int D, class Backend>
class StepSurface {
 public:
  explicit StepSurface(const Case& c) : terms_(SurfaceTerms<D>::make(c)) {}

  /// On the neighbours of the step.
  void prepare(FlowState<D, Backend>& state, const MphPairs<D>& pairs) {
    sums_.resize(state.context, pairs.ownFluid());
    slope_.resize(state.context, pairs.fluidCount);
    surfaceSlope<D>(state.context, pairs, terms_, sums_.span(), slope_.span());
    fillGhosts(state.context, Held::Fluid, slope_.data());
  }

  /// y += the forces per own fluid particle [N/m3].
  void addForces(FlowState<D, Backend>& state, const MphPairs<D>& pairs, std::span<Vec<D>> y) const {
    addSurfaceTension<D>(state.context, pairs, terms_, sums_.span(), slope_.span(), y);
  }

  /// Sets y to the forces on own fluid particles and, from the place of the first wall particle on, on those of
  /// `walls`, which are added to `load` [N/m3]. `ofWalls`: room per fluid particle.
  void allForces(FlowState<D, Backend>& state, const MphPairs<D>& pairs, const ClusterListView& walls,
                 std::span<Vec<D>> ofWalls, std::span<Vec<D>> y, std::span<Vec<D>> load) const {
    clearValues(state.context, y);
    addSurfaceTension<D>(state.context, pairs, terms_, sums_.span(), slope_.span(), y, ofWalls);
    fillGhosts(state.context, Held::Fluid, ofWalls.data());
    surfaceOnWalls<D>(state.context, pairs, terms_, walls, ofWalls, y.subspan(pairs.fluidCount), load);
  }

  std::span<const Vec<D>> slope() const { return slope_; }  // m per fluid particle
  std::size_t bytes() const { return sums_.bytes() + slope_.bytes(); }

 private:
  SurfaceTerms<D> terms_;
  Buffer<SurfaceSums<D>, Backend> sums_;
  Buffer<Vec<D>, Backend> slope_;
};

}  // namespace treacle
