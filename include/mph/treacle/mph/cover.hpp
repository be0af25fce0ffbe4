#pragma once

#include "treacle/core/macros.hpp"

#include <cmath>
#include <cstdint>
#include <span>

namespace treacle {

/// What a number density n of a particle says of the fluid around it. The place of a particle is open by
/// g = |sum_j v_ij d_ij| / (n_0 l), v = [1-q^2]_+^3: nothing inside of the fluid, and what is missing on one side
/// near a free surface. In the outermost rows of a lattice with a plane surface g is 0.83, 0.34 and 0.02, in 3D
/// 0.85, 0.32 and 0.01, and n/n_0 is about 1 - 0.04 g - 0.45 g^2. Where a wall that makes up the share w of n_0
/// ends a surface, it fills that share of what is missing: then g and 1 - n/n_0 are (1 - w) times those without
/// it.
struct Cover {
  double rest;   // n/n_0 of fluid that has its density and is as open
  double bears;  // share of a pressure below zero that it bears, 0 to 1
  double tells;  // how far its number density tells what fluid is missing, 0 to 1

  /// Whether a particle counts for the volume of the fluid: not if it is alone or nearly so, and not beside a
  /// wall, where a gap under fluid that has rolled onto it would count as fluid that has swollen. `walls`: w.
  TREACLE_HD static bool isInside(double open, double ratio, double walls) {
    return ratio > 0.4 && open < inside * ratio && walls < 0.05;
  }

  /// `walls`: w. The formula for the rest is right to some 0.5 % next to a surface, which kappa makes a tension
  /// far above the stress of a slow flow. Only places that are hardly open tell.
  TREACLE_HD static Cover of(double open, double ratio, double walls = 0) {
    const double rest = 1 - open * (0.04 + 0.45 * open / (1 - fmin(0.9, walls)));
    const double bears = falling(open, inside, 0.35) * falling(rest - ratio, 0.08, 0.12);
    return {rest, bears, bears * falling(open, 0.04, 0.07)};
  }

  /// The share of its bulk viscosity that a particle has, 0 to 1. A divergence that is a sum over particles takes
  /// two surfaces that come close for one fluid, and lambda would hold the gap between them open. A particle next
  /// to a gap has less around it than `rest` says. A thin sheet has so, too, but its surroundings lack more by a
  /// wider weight than by that of the density, while beyond a gap there is fluid again. `wide`: what stands around
  /// the particle over that of a full lattice, by the weight v.
  TREACLE_HD static double resists(double open, double ratio, double wide, double walls) {
    const double sheet = fmax(0.0, ratio - wide), gap = of(open, ratio, walls).rest - ratio - 5 * sheet;
    return fmax(exp(-fmax(0.0, gap - 0.02) / 0.01), 1 - falling(1 - ratio, 0.4, 0.5));
  }

 private:
  static constexpr double inside = 0.2;

  /// From 1 up to a to 0 from b on.
  TREACLE_HD static double falling(double x, double a, double b) {
    const double t = fmin(1.0, fmax(0.0, (b - x) / (b - a)));
    return t * t * (3 - 2 * t);
  }
};

/// What number densities say of the places of particles: the sums of numberDensity() and wallDensity(). `rest`:
/// n_0.
struct Places {
  std::span<const double> n, open, wide, walls;

  TREACLE_HD Cover cover(std::uint32_t i, double rest) const {
    return Cover::of(open[i], n[i] / rest, walls[i] / rest);
  }
  TREACLE_HD double resists(std::uint32_t i, double rest) const {
    return Cover::resists(open[i], n[i] / rest, wide[i], walls[i] / rest);
  }
};

}  // namespace treacle
