#pragma once

#include "treacle/core/macros.hpp"

#include <cmath>

namespace treacle {

/// What a number density n of a particle says of the fluid around it. The place of a particle is open by
/// g = |sum_j v_ij d_ij| / (n_0 l), v = [1-q^2]_+^3: nothing inside of the fluid, and what is missing on one side
/// near a free surface. In the outermost rows of a lattice with a plane surface g is 0.83, 0.34 and 0.02, in 3D
/// 0.85, 0.32 and 0.01, and n/n_0 is about 1 - 0.04 g - 0.45 g^2.
struct Cover {
  double rest;   // n/n_0 of fluid that has its density and is as open
  double bears;  // share of a pressure below zero that it bears, 0 to 1

  /// Whether a particle counts for the volume of the fluid: not if it is alone or nearly so.
  TREACLE_HD static bool isInside(double open, double ratio) { return ratio > 0.4 && open < inside * ratio; }

  TREACLE_HD static Cover of(double open, double ratio) {
    const double rest = 1 - open * (0.04 + 0.45 * open);
    return {rest, falling(open, inside, 0.35) * falling(rest - ratio, 0.15, 0.3)};
  }

 private:
  static constexpr double inside = 0.2;

  /// From 1 up to a to 0 from b on.
  TREACLE_HD static double falling(double x, double a, double b) {
    const double t = fmin(1.0, fmax(0.0, (b - x) / (b - a)));
    return t * t * (3 - 2 * t);
  }
};

}  // namespace treacle
