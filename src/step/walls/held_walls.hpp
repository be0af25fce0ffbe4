#pragma once

#include "run/flow_state.hpp"
#include "treacle/model/particles/particles_copy.hpp"
#include "treacle/step/walls/distant_walls.hpp"

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>

namespace treacle {

template <int D>
void addFluid(const Context<Cpu>&, std::span<const Vec<D>> position, NearBlocks<D>& near) {
  near.addMoving(position);
}
/// Piece by piece: the host need not have room for all places.
template <int D>
void addFluid(const Context<Cuda>& context, std::span<const Vec<D>> position, NearBlocks<D>& near) {
  constexpr std::size_t piece = std::size_t{1} << 20;
  Buffer<Vec<D>> some;
  for (std::size_t first = 0; first < position.size(); first += piece) {
    some.resize(std::min(piece, position.size() - first));
    copyToHost(context, position.subspan(first, some.size()), some.data());
    near.addMoving(some);
  }
}

/// Makes the walls of the state those that are near something that moves in any process, and all others distant
/// ones. `cells`: those of the search. Collective. Errors: std::bad_alloc.
template <int D, class Backend>
void holdNearWalls(FlowState<D, Backend>& state, const CellGrid<D>& cells, DistantWalls<D>& distant) {
  Particles<D, Backend>& particles = state.particles;
  Particles<D> walls;
  copyWallsToHost(state.context, particles, walls);
  NearBlocks<D> near(state.theCase, cells);
  near.addMovingWalls(walls);
  addFluid<D>(state.context, particles.position.span().first(particles.fluidCount), near);
  if (state.context.communicator) near.unite(*state.context.communicator);
  if (distant.differs(near)) replaceWalls(state.context, distant.held(near, walls), particles);
  distant.accept(std::move(near));
}

}  // namespace treacle
