#pragma once

#include "explicit_forces.hpp"
#include "treacle/core/halo.hpp"
#include "treacle/mph/surface_tension.hpp"

#include <utility>

namespace treacle {

/// The surface tension of a step of MPH-I, of the places at its start.
template <int D, class Backend>
class StepSurface final : public ExplicitForces<D, Backend> {
 public:
  explicit StepSurface(const Case& c) : terms_(SurfaceTerms<D>::make(c)), wallsBearIt_(c.needsWallForces()) {}

  /// On the neighbours of the step; `walls`: those of wall particles, as far as surfaces reach.
  void prepare(FlowState<D, Backend>& state, const MphPairs<D>& pairs, const ClusterListView& walls) {
    Context<Backend>& context = state.context;
    const std::uint32_t fluid = pairs.fluidCount, wallCount = pairs.ownEnd() - fluid;
    for (Buffer<Vec<D>, Backend>* field : {&normal_, &force_, &even_}) field->resize(context, pairs.fluidCount);
    slope_.resize(context, pairs.fluidCount);
    fit_.resize(context, pairs.fluidCount);
    if (wallsBearIt_) ofWalls_.resize(context, pairs.fluidCount);
    sums_.resize(context, pairs.ownFluid());
    smoothed_.resize(context, pairs.ownFluid());
    unshared_.resize(context, pairs.ownFluid());
    fitted_.resize(context, pairs.ownFluid());
    atWalls_.resize(context, wallCount);
    adhesion_.resize(context, pairs.activeCount);

    surfaceSlope<D>(context, pairs, terms_, sums_.span(), slope_.span(), adhesion_.span().first(pairs.ownFluid()));
    wallAdhesion<D>(context, pairs, terms_, walls, atWalls_.span(), adhesion_.span().subspan(fluid, wallCount));
    fillGhosts(context, Held::Fluid, slope_.data());
    fillGhosts(context, Held::Active, adhesion_.data());
    const SurfaceForces<D> forces{force_.span(),  unshared_.span(), smoothed_.span(),
                                  normal_.span(), fit_.span(),      ofWalls_.span()};
    surfaceForces<D>(context, pairs, terms_, sums_.span(), slope_.span(), adhesion_.span(), forces);
    fillGhosts(context, Held::Fluid, normal_.data());
    fillGhosts(context, Held::Fluid, fit_.data());
    if (wallsBearIt_) fillGhosts(context, Held::Fluid, ofWalls_.data());
    bendSurface<D>(context, pairs, terms_, forces, fitted_.span());
    for (int k = 0; k < surfacePasses<D>; ++k) {
      if (k > 0) std::swap(force_, even_);
      fillGhosts(context, Held::Fluid, force_.data());
      const bool last = k == surfacePasses<D> - 1;
      evenAlongSurface<D>(context, pairs, terms_,
                          {normal_.span(), fit_.span(), force_.span(), even_.span(),
                           last ? std::span<const Vec<D>>(unshared_.span()) : std::span<const Vec<D>>{}});
    }
  }

  void addForces(FlowState<D, Backend>& state, std::span<Vec<D>> y) const override {
    addSurfaceForces<D>(state.context, even_.span().first(y.size()), y);
  }

  void allForces(FlowState<D, Backend>& state, const MphPairs<D>& pairs, const ClusterListView& walls,
                 std::span<Vec<D>> y, std::span<Vec<D>> load) const override {
    const std::uint32_t n = pairs.ownFluid();
    copyValues(state.context, std::span<const Vec<D>>(even_.span()).first(n), y.data());
    clearValues(state.context, y.subspan(n));
    surfaceOnWalls<D>(state.context, pairs, terms_, walls,
                      {ofWalls_.span(), adhesion_.span(), y.subspan(pairs.fluidCount), load});
  }

  std::span<const SurfaceSlope<D>> slope() const { return slope_; }    // per fluid particle
  std::span<const Adhesion<D>> adhesion() const { return adhesion_; }  // per active particle
  std::size_t bytes() const {
    return sums_.bytes() + slope_.bytes() + normal_.bytes() + force_.bytes() + even_.bytes() + fit_.bytes() +
           smoothed_.bytes() + unshared_.bytes() + fitted_.bytes() + ofWalls_.bytes() + atWalls_.bytes() +
           adhesion_.bytes();
  }

 private:
  SurfaceTerms<D> terms_;
  bool wallsBearIt_;
  Buffer<SurfaceSums<D>, Backend> sums_;
  Buffer<SurfaceSlope<D>, Backend> slope_;
  Buffer<Vec<D>, Backend> normal_;            // |m| in the direction of S [Pa^1/2]
  Buffer<Vec<D>, Backend> force_, even_;      // to be shared; shared, in the end all of it [N/m3]
  Buffer<Vec<D>, Backend> smoothed_;          // S [Pa]
  Buffer<Vec<D>, Backend> unshared_;          // what is not shared [N/m3]
  Buffer<SurfaceFit, Backend> fit_, fitted_;  // of each particle; summed over its neighbours
  Buffer<Vec<D>, Backend> ofWalls_;           // SurfaceForces::ofWalls [N/m3]
  Buffer<WallSums<D>, Backend> atWalls_;      // per own wall particle
  Buffer<Adhesion<D>, Backend> adhesion_;     // per active particle
};

}  // namespace treacle
