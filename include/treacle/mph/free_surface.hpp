#pragma once

#include "treacle/core/cuda.hpp"
#include "treacle/mph/mph_pairs.hpp"

#include <span>

namespace treacle {

/// How much of the free surface is a particle's, by what it lacks of neighbours on one side: |sum_j g d|, with the
/// gradient's coefficients g, walls being neighbours like others. On a flat lattice the first layer has all of the
/// surface, one spacing each in the plane; the layers below have a twentieth of its lack or less. Particles in the
/// midst of a fluid that flows have 0.06/l in nine of ten cases, at most 0.14/l, where the first layer has 0.46/l;
/// so a lack of less than 0.3 of that counts as none, one of more than 0.55 as it is, with a ramp between them.
/// Lattices turned by 22.5 and 45 degrees have 0.93 and 0.82 (2D), 0.91 and 0.93 (3D) of their surface.
struct SurfaceLack {
  double flat;     // of the first layer of a flat lattice [1/m]
  double spacing;  // l [m]

  template <int D>
  static SurfaceLack make(const MphPairs<D>& pairs);

  /// The particle's area over its volume [1/m].
  TREACLE_HD double area(double lack) const {
    const double share = lack / flat, ramp = (share - 0.3) / 0.25;
    return ramp <= 0 ? 0 : (ramp < 1 ? ramp : 1) * share / spacing;
  }
};

/// Per own fluid particle [1/m].
template <int D>
void surfaceArea(Context<Cpu>&, const MphPairs<D>&, const SurfaceLack&, std::span<double> area);
template <int D>
void surfaceArea(Context<Cuda>&, const MphPairs<D>&, const SurfaceLack&, std::span<double> area);

}  // namespace treacle
