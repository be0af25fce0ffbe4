#pragma once

#include "treacle/core/cuda.hpp"
#include "treacle/mph/mph_pairs.hpp"

#include <span>

namespace treacle {

/// How much of the free surface is a particle's. It lacks neighbours on the side that sum_j g d points away from,
/// with the gradient's coefficients g, walls being neighbours like others, and it is at the surface if none stands
/// there, within 41 degrees of that direction and the radius of pressures: rows that a flow has torn apart inside
/// the fluid lack neighbours, too, but have others across the gap. Its area is as large as what it lacks, in that
/// of the first layer of a flat lattice, whose particles have one spacing each in the plane; a lack of less than a
/// tenth counts as none, with a ramp to three tenths.
///
/// Of lattices turned by up to 45 degrees the area found is 0.93 to 1.00 (2D) and 0.99 to 1.18 (3D) of the plane.
struct SurfaceLack {
  double flat;     // of the first layer of a flat lattice [1/m]
  double spacing;  // l [m]

  template <int D>
  static SurfaceLack make(const MphPairs<D>& pairs);

  /// Whether a neighbour at distance r is where a particle lacks some; along: d.lack.
  template <class Real>
  TREACLE_HD static auto covers(const Real& along, const Real& lack, const Real& r) {
    return -along > 0.75 * lack * r;
  }

  /// The area of an uncovered particle over its volume [1/m].
  TREACLE_HD double area(double lack) const {
    const double share = lack / flat, ramp = (share - 0.1) / 0.2;
    return ramp <= 0 ? 0 : (ramp < 1 ? ramp : 1) * share / spacing;
  }
};

/// Per own fluid particle: sum_j g d [1/m], and the area of the free surface over the volume [1/m].
template <int D, class Backend>
void surfaceArea(Context<Backend>&, const MphPairs<D>&, const SurfaceLack&, std::span<Vec<D>> lack,
                 std::span<double> area);

}  // namespace treacle
