#pragma once

#include "run/flow_state.hpp"
#include "treacle/mph/wall_surfaces.hpp"

#include <cstdint>
#include <span>

namespace treacle {

/// The surfaces of the walls [first, first + count) as they are at the start of the step, into `placed`, which
/// stays as it is where they are not known.
template <int D, class Backend>
void placeWallSurfaces(FlowState<D, Backend>& state, std::uint32_t first, std::uint32_t count,
                       Buffer<WallSurface<D>, Backend>& placed) {
  const Particles<D, Backend>& p = state.particles;
  if (p.wallSurface.empty()) return;
  placed.resize(state.context, count);
  placeSurfaces<D>(state.context, {p.wallSurface.span(), state.wallMotion.span()},
                   p.body.span().subspan(first, count), placed.span());
}

}  // namespace treacle
