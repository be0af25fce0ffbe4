#pragma once

#include "treacle/core/cuda.hpp"
#include "treacle/mph/mph_pairs.hpp"

#include <cmath>
#include <span>

namespace treacle {

/// The area of the free surface that is a particle's. The colour c is the sum of a weight over all neighbours,
/// walls and the particle itself included, 1 inside and 1/2 at the surface. The surfaces of equal c have the area
/// of the free surface in the mean, so by the coarea formula the sum of V |grad c| f(c) is the area if the
/// integral of f from 1/2 to 1 is 1; f has the factor that makes the area of a flat lattice exact. f is even about
/// 1/2: then the area does not depend on how ragged the surface is, because what particles beyond the surface add
/// is what those missing behind it do not. f is 0 where c differs from 1/2 by more than 0.45, so that disorder
/// inside the fluid has no area.
///
/// Areas of discs and balls cut from a lattice are 1.00 (2D) and 1.00 to 1.03 (3D) of the exact ones, and stay so
/// when particles are displaced by up to 0.45 spacings.
template <int D>
struct SurfaceColour {
  double inverseSquare;  // 1/h^2 [1/m2]
  double scale = 1;      // 1 over the sum in a full lattice
  double factor = 1;     // of f

  static SurfaceColour make(const MphPairs<D>& pairs);

  /// What both weights are powers of, at distance r.
  template <class Distance>
  TREACLE_HD auto part(const Distance& r) const {
    return positivePart(1.0 - r.square * inverseSquare);
  }
  /// w, and -dw/dr over r [1/m2]; of part().
  template <class T>
  TREACLE_HD static T weight(const T& part) {
    return D == 2 ? part * part * part : part * part;
  }
  template <class T>
  TREACLE_HD T slope(const T& part) const {
    return 2 * inverseSquare * (D == 2 ? 3.0 * part * part : 2.0 * part);
  }

  /// The area over the volume [1/m] of a particle with the colour c and its gradient's size [1/m].
  TREACLE_HD double area(double c, double gradient) const {
    constexpr double whole = 0.2, most = 0.45;  // |c - 1/2| where f begins to fall, and where it ends
    const double fall = (most - std::fabs(c - 0.5)) / (most - whole), s = fall < 0 ? 0 : fall < 1 ? fall : 1;
    return factor * gradient * s * s * (3 - 2 * s);
  }
};

/// Per own fluid particle the area of the free surface over the volume [1/m].
template <int D, class Backend>
void surfaceArea(Context<Backend>&, const MphPairs<D>&, const SurfaceColour<D>&, std::span<double> area);

}  // namespace treacle
