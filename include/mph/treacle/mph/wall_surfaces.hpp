#pragma once

#include "treacle/core/cuda.hpp"
#include "treacle/core/macros.hpp"
#include "treacle/model/geometry/wall_surface.hpp"
#include "treacle/model/motion/wall_motion.hpp"

#include <cstdint>
#include <span>

namespace treacle {

/// What is known of walls' surfaces: per wall particle, as they were at t = 0, and the motions of bodies that may
/// have turned since, none if no wall turns. Spans in the backend's memory.
template <int D>
struct KnownSurfaces {
  std::span<const WallSurface<D>> surface;
  std::span<const WallMotion<D>> motion;
};

/// Those of the first wall particles, which belong to these bodies, as they are now.
template <int D, class Backend>
void placeSurfaces(Context<Backend>&, const KnownSurfaces<D>&, std::span<const std::uint8_t> body,
                   std::span<WallSurface<D>> placed);

/// The formula, for wall particle k.
template <int D>
TREACLE_HD WallSurface<D> placedSurface(const KnownSurfaces<D>& known, std::size_t k, std::uint8_t body) {
  WallSurface<D> s = known.surface[k];
  if (known.motion.empty()) return s;
  for (Vec<D, float>& face : s.face) face = converted<float>(known.motion[body].turned(converted<double>(face)));
  return s;
}

}  // namespace treacle
