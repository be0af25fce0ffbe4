#pragma once

#include "treacle/core/cuda.hpp"
#include "treacle/core/macros.hpp"
#include "treacle/model/geometry/wall_surface.hpp"
#include "treacle/model/motion/wall_motion.hpp"

#include <cmath>
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

/// The least distance of fluid from a wall in wallFactor, in spacings: a particle that touches the wall holds on
/// to it, but not without bound.
inline constexpr double leastWallDistance = 0.25;

/// By what the viscosity of a fluid particle i with a wall particle j is multiplied so that the fluid meets the
/// wall's velocity at the wall's surface and not at its particles: the wall's velocity is extrapolated through the
/// surface, linearly in the distances d_i and d_j of both from it, u_j - u_i = (u_wall - u_i) (d_i + d_j) / d_i
/// (Morris, Fox, Zhu 1997). With a slip length b the fluid's velocity meets the wall's that far behind the
/// surface: (d_i + d_j) / (d_i + b). Of several faces the one counts that the line from i to j crosses last: it
/// has i in front of it, and the largest d_i / d_j. d = x_j - x_i [m], spacing l and slip [m].
template <int D>
TREACLE_HD double wallFactor(const WallSurface<D>& surface, const Vec<D>& d, double spacing, double slip) {
  double above = 0, below = 0;  // d_i and d_j of the face that counts
  for (const Vec<D, float>& face : surface.face) {
    const Vec<D> toFace = converted<double>(face);
    const double depth = norm(toFace);
    if (depth == 0) continue;
    const double height = -dot(toFace, d) / depth - depth;
    if (below == 0 || (height > 0 && height * below > above * depth)) above = height, below = depth;
  }
  if (below == 0) return 1;
  if (const double least = leastWallDistance * spacing; above < least) above = least;
  return (above + below) / (above + slip);
}

}  // namespace treacle
