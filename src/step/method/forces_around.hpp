#pragma once

#include "explicit_forces.hpp"
#include "treacle/mph/surface_tension.hpp"

namespace treacle {

/// Explicit forces that come on top of others. A class of this kind finds its forces on fluid before the step is
/// solved, and those on walls when somebody asks.
template <int D, class Backend>
class ForcesAround : public ExplicitForces<D, Backend> {
 public:
  /// Whether there are such forces in the step at hand.
  bool acts() const { return acts_; }

  void addForces(FlowState<D, Backend>& state, std::span<Vec<D>> y) const final {
    if (others_) others_->addForces(state, y);
    if (acts_) addSurfaceForces<D>(state.context, force_.span().first(y.size()), y);
  }
  void allForces(FlowState<D, Backend>& state, const MphPairs<D>& pairs, const ClusterListView& walls,
                 std::span<Vec<D>> y, std::span<Vec<D>> load) const final {
    const std::uint32_t own = pairs.ownFluid();
    if (others_)
      others_->allForces(state, pairs, walls, y, load);
    else
      clearValues(state.context, y);
    if (!acts_) return;
    addSurfaceForces<D>(state.context, force_.span().first(own), y.first(own));
    onWalls_.resize(state.context, y.size() - pairs.fluidCount);
    clearValues(state.context, onWalls_.span());
    addWallForces(state, pairs, walls, onWalls_.span());
    addSurfaceForces<D>(state.context, onWalls_.span(), y.subspan(pairs.fluidCount));
    addSurfaceForces<D>(state.context, onWalls_.span(), load);
  }
  std::span<const Vec<3>> couples() const override {
    return others_ ? others_->couples() : std::span<const Vec<3>>{};
  }
  void addLoads(std::span<LoadSums> loads) const final {
    if (others_) others_->addLoads(loads);
  }

 protected:
  /// `others`: forces that go with these, or null; must outlive this.
  explicit ForcesAround(const ExplicitForces<D, Backend>* others) : others_(others) {}

  void setActing(bool acts) { acts_ = acts; }
  /// Room for those of the step at hand, per own fluid particle [N/m3].
  std::span<Vec<D>> makeForces(Context<Backend>& context, std::uint32_t own) {
    force_.resize(context, own);
    return force_.span();
  }
  std::size_t forceBytes() const { return force_.bytes() + onWalls_.bytes(); }

 private:
  /// Adds those on the wall particles of a list, from the first wall particle on [N/m3].
  virtual void addWallForces(FlowState<D, Backend>& state, const MphPairs<D>& pairs, const ClusterListView& walls,
                             std::span<Vec<D>> force) const = 0;

  const ExplicitForces<D, Backend>* others_;
  bool acts_ = true;                         // in the step at hand
  Buffer<Vec<D>, Backend> force_;            // per own fluid particle [N/m3]
  mutable Buffer<Vec<D>, Backend> onWalls_;  // per active wall particle [N/m3]
};

}  // namespace treacle
