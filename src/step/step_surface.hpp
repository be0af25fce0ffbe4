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
    slope_.resize(state.context, pairs.fluidCount);
    surfaceSlope<D>(state.context, pairs, terms_, slope_.span());
    fillGhosts(state.context, Held::Fluid, slope_.data());
  }

  /// y += the forces per own fluid particle [N/m3].
  void addForces(FlowState<D, Backend>& state, const MphPairs<D>& pairs, std::span<Vec<D>> y) const {
    addSurfaceTension<D>(state.context, pairs, terms_, slope_.span(), y);
  }

  std::span<const Vec<D>> slope() const { return slope_; }  // m per fluid particle
  std::size_t bytes() const { return slope_.bytes(); }

 private:
  SurfaceTerms<D> terms_;
  Buffer<Vec<D>, Backend> slope_;
};

}  // namespace treacle
