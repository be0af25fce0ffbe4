#pragma once

#include "treacle/core/macros.hpp"
#include "treacle/model/geometry/wall_surface.hpp"

namespace treacle {

/// A face of a wall between a fluid particle i and a particle j of the wall.
template <int D>
struct SeenFace {
  Vec<D> way{};      // from j to the nearest point of the face, along its outward normal [m]
  double below = 0;  // d_j, length of the way; 0: there is no face [m]
  double above = 0;  // d_i, distance of i from the plane of the face [m]

  TREACLE_HD bool exists() const { return below > 0; }
  /// The share of the line from i to j that is in the wall, d_j / (d_i + d_j); 0 without a face.
  TREACLE_HD double behind() const { return exists() ? below / (below + (above > 0 ? above : 0)) : 0; }
  /// The part of v across the face; there must be one.
  TREACLE_HD Vec<D> across(const Vec<D>& v) const { return (dot(way, v) / (below * below)) * way; }
};

/// Of several faces the one that the line from i to j crosses last: it has i in front of it, and the largest
/// d_i / d_j. d = x_j - x_i [m].
template <int D>
TREACLE_HD SeenFace<D> seenFace(const WallSurface<D>& surface, const Vec<D>& d) {
  SeenFace<D> seen;
  for (const Vec<D, float>& face : surface.face) {
    const Vec<D> way = converted<double>(face);
    const double depth = norm(way);
    if (depth == 0) continue;
    const double height = -dot(way, d) / depth - depth;
    if (seen.below == 0 || (height > 0 && height * seen.below > seen.above * depth)) seen = {way, depth, height};
  }
  return seen;
}

/// The least distance of fluid from a wall in wallFactor, in spacings: a particle that touches the wall holds on
/// to it, but not without bound.
inline constexpr double leastWallDistance = 0.25;

/// By what the viscosity of a fluid particle i with a wall particle j is multiplied so that the fluid meets the
/// wall's velocity at the wall's surface and not at its particles: the wall's velocity is extrapolated through the
/// surface, linearly in the distances d_i and d_j of both from it, u_j - u_i = (u_wall - u_i) (d_i + d_j) / d_i
/// (Morris, Fox, Zhu 1997). With a slip length b the fluid's velocity meets the wall's that far behind the
/// surface: (d_i + d_j) / (d_i + b). d = x_j - x_i [m], spacing l and slip [m].
template <int D>
TREACLE_HD double wallFactor(const WallSurface<D>& surface, const Vec<D>& d, double spacing, double slip) {
  const SeenFace<D> seen = seenFace(surface, d);
  if (!seen.exists()) return 1;
  double above = seen.above;
  if (const double least = leastWallDistance * spacing; above < least) above = least;
  return (above + seen.below) / (above + slip);
}

}  // namespace treacle
