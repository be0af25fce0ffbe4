#pragma once

#include "treacle/isph/isph_flow.hpp"

#include <cmath>
#include <cstdint>

namespace treacle {

/// The pressure equation of ISPH and what pressures do (isph_terms.hpp).

/// Right-hand side of the pressure equation [O23 eq. (10)], divided by -rho: -div v* / dt + alpha (<rho>/rho - 1)
/// / dt^2, zero for free particles. Compression raises p. Walls are met with v* mirrored at the wall's velocity:
/// with the wall's velocity itself half of the flow into it would be missed. Walls count in it as in the
/// Laplacian, so that water at rest has the hydrostatic pressure, and derivatives along them are those of the
/// fluid (DensityTerm). In the accurate scheme particles at the free surface lack neighbours, not volume: a
/// density below 1 does not count, and the less the more neighbours are missing. The term with alpha has an
/// equation of its own there, by which particles move (IsphArrangement).
template <int D>
struct PressureSourceTerm {
  static constexpr int values = 1;
  const Vec<D>* predicted;  // of fluid; walls: their velocity
  const double* density;    // <rho> / rho
  const std::uint8_t* surface;
  double* source;
  double* arrangement = nullptr;  // where it is not null, it takes the term with alpha

  TREACLE_HD void fluid(const IsphPairs<D>& pairs, std::uint32_t i, std::uint32_t j, const Vec<D>& d,
                        const Distance& r, double* sum) const {
    sum[0] += pairs.slope(r) * dot(predicted[j] - predicted[i], pairs.derivative(i, d));
  }
  TREACLE_HD void wall(const IsphPairs<D>& pairs, std::uint32_t i, std::uint32_t j, const Vec<D>& d,
                       const Distance& r, double* sum) const {
    sum[0] += 2 * pairs.slope(r) * pairs.renormalisedAlong(i, d) * dot(predicted[j] - predicted[i], d);
  }
  TREACLE_HD void store(const IsphPairs<D>& pairs, std::uint32_t i, const double* sum) const {
    const double missing = pairs.missingShare(i);
    const double excess = missing > 0 ? std::fmax(0.0, density[i] - 1) : density[i] - 1;
    const bool isFree = surface[i] == Place::Free;  // its sum may not be finite
    const double compression = pairs.alpha * excess / (pairs.timeStep * pairs.timeStep);
    source[i] = isFree ? 0 : (1 - missing) * ((arrangement ? 0 : compression) - sum[0] / pairs.timeStep);
    if (arrangement) arrangement[i] = isFree ? 0 : (1 - missing) * compression;
  }
};

/// Adds to the right-hand side of the pressure equation what gas around the free surface does: missing neighbours
/// and free particles have its pressure (IsphPairs::outside).
template <int D>
struct OutsideTerm {
  static constexpr int values = 1;
  const std::uint8_t* surface;
  double* source;

  TREACLE_HD void fluid(const IsphPairs<D>& pairs, std::uint32_t i, std::uint32_t j, const Vec<D>& d,
                        const Distance& r, double* sum) const {
    if (surface[j] == Place::Free) sum[0] += pairs.pressureCoefficient(i, j, d, r);
  }
  TREACLE_HD void wall(const IsphPairs<D>&, std::uint32_t, std::uint32_t, const Vec<D>&, const Distance&,
                       double*) const {}
  TREACLE_HD void store(const IsphPairs<D>& pairs, std::uint32_t i, const double* sum) const {
    if (surface[i] == Place::Free) return;
    source[i] += (pairs.missingCoefficient(i) + sum[0]) * pairs.outsidePressure(i);
  }
};

/// v = v* - dt grad p / rho [O23 eq. (8)], the gradient in its symmetric form [O23 eq. (5)]: it keeps momentum and
/// drives particles apart. In the accurate scheme it is sum V (p_i B_i + p_j B_j) grad W, the adjoint of the
/// divergence: a strained lattice under pressure does not resist shear. Pressures count above that of the gas
/// outside, so that fluid all around which it is the same feels nothing of it. Particles without pressure have
/// nothing to stop them at a wall: those closer to it than half a spacing lose the velocity into it; others do
/// when they are closer still, in impacts that a step does not resolve. Whoever got inside nevertheless leaves at
/// a fiftieth of a spacing per step.
///
/// In the accurate scheme particles move with what another pressure makes of v* (IsphArrangement).
template <int D>
struct CorrectorTerm {
  static constexpr int values = 4 * D + 2;
  enum { Pull, Moved = D, Towards = 2 * D, Wall = 3 * D, Slopes = 4 * D, Share };  // places of the sums
  const double* pressure;
  const double* pressing;   // pressure by which a particle has one; what is solved again must not jump by that
  const Vec<D>* predicted;  // of fluid; walls: their velocity
  Vec<D>* velocity;
  double* wallShare = nullptr;  // of the particle's density in a full lattice, what walls make up [-]; may be null
  Vec<D>* stopped = nullptr;  // velocity that it loses at walls, over the sum of their slopes [m3/s]; may be null
  const double* moving = nullptr;  // the pressure by which particles move; may be null
  Vec<D>* transport = nullptr;     // velocity by it; with `moving`

  TREACLE_HD void fluid(const IsphPairs<D>& pairs, std::uint32_t i, std::uint32_t j, const Vec<D>& d,
                        const Distance& r, double* sum) const {
    const Vec<D> mine = pairs.renormalised(i, d), other = pairs.renormalised(j, d);
    const double slope = pairs.slope(r), outside = pairs.outsidePressure(i);
    addPull(slope * (pressure[i] - outside), mine, slope * (pressure[j] - outside), other, sum + Pull);
    if (moving) addPull(slope * (moving[i] - outside), mine, slope * (moving[j] - outside), other, sum + Moved);
  }
  TREACLE_HD void wall(const IsphPairs<D>& pairs, std::uint32_t i, std::uint32_t j, const Vec<D>& d,
                       const Distance& r, double* sum) const {
    const Vec<D> mine = pairs.renormalised(i, d);
    const double slope = pairs.slope(r), outside = pairs.outsidePressure(i);
    addPull(slope * (pressure[i] - outside), mine, slope * (pairs.wallPressure(pressure[i], i, j, d) - outside),
            mine, sum + Pull);
    if (moving)
      addPull(slope * (moving[i] - outside), mine, slope * (pairs.wallPressure(moving[i], i, j, d) - outside),
              mine, sum + Moved);
    for (int k = 0; k < D; ++k) {
      sum[Towards + k] += slope * d[k];
      sum[Wall + k] += slope * predicted[j][k];
    }
    sum[Slopes] += slope;
    sum[Share] += pairs.kernel.value(r.r);
  }
  TREACLE_HD void store(const IsphPairs<D>& pairs, std::uint32_t i, const double* sum) const {
    const double share = sum[Share] * pairs.volume / pairs.latticeDensity;
    if (wallShare) wallShare[i] = share;
    Vec<D> lost;
    velocity[i] = corrected(pairs, i, sum + Pull, pressing[i] > 0, share, sum, lost);
    if (stopped) stopped[i] = lost;
    if (moving) transport[i] = corrected(pairs, i, sum + Moved, moving[i] > 0, share, sum, lost);
  }

 private:
  TREACLE_HD static void addPull(double a, const Vec<D>& mine, double b, const Vec<D>& other, double* sum) {
    for (int k = 0; k < D; ++k) sum[k] += a * mine[k] + b * other[k];
  }

  /// The velocity by the sum `pull`, of which walls take what `lost` says.
  TREACLE_HD Vec<D> corrected(const IsphPairs<D>& pairs, std::uint32_t i, const double* pull, bool isPressed,
                              double share, const double* sum, Vec<D>& lost) const {
    const double factor = pairs.timeStep / pairs.density(i);
    Vec<D> v, towards, wallVelocity;
    for (int k = 0; k < D; ++k) {
      v[k] = predicted[i][k] - factor * pull[k];
      towards[k] = sum[Towards + k];
      wallVelocity[k] = sum[Wall + k] / (sum[Slopes] > 0 ? sum[Slopes] : 1);
    }
    lost = {};
    const WallContact& contact = pairs.contact;
    if (share <= (isPressed ? contact.pressed : contact.touching) || norm2(towards) == 0) return v;
    const double away = share > contact.inside ? 0.02 * pairs.spacing / pairs.timeStep : 0, g = norm(towards);
    const double into = dot(v - wallVelocity, towards) / g + away;
    if (into <= 0) return v;
    lost = (into / (g * sum[Slopes])) * towards;
    return v - (into / g) * towards;
  }
};

/// Pressure that walls show: the mean of what their fluid neighbours see in them. Rows of walls: i is the wall.
template <int D>
struct WallPressureTerm {
  static constexpr int values = 2;
  const double* pressure;
  double* result;  // of the walls, at their index

  TREACLE_HD void fluid(const IsphPairs<D>& pairs, std::uint32_t i, std::uint32_t j, const Vec<D>& d,
                        const Distance& r, double* sum) const {
    const double w = pairs.kernel.value(r.r);
    sum[0] += w * pairs.wallPressure(pressure[j], j, i, -1.0 * d);
    sum[1] += w;
  }
  TREACLE_HD void store(const IsphPairs<D>&, std::uint32_t i, const double* sum) const {
    result[i] = sum[1] > 0 ? sum[0] / sum[1] : 0;
  }
};

/// Row i of the pressure matrix: off-diagonal elements of unknown neighbours in place of their columns, the
/// diagonal with those of known pressure, zero, and with missing neighbours, which have it as well. A free
/// particle has a row of zeros.
template <int D>
struct PressureRow {
  const std::uint8_t* surface;

  TREACLE_HD bool isUnknown(std::uint32_t i) const { return surface[i] != Place::Free; }
  TREACLE_HD double coefficient(const IsphPairs<D>& pairs, std::uint32_t i, std::uint32_t j, const Vec<D>& d,
                                const Distance& r) const {
    return pairs.pressureCoefficient(i, j, d, r);
  }
  /// Bound on all of them.
  double largest(const IsphPairs<D>& pairs) const {
    return 2 * pairs.slope(0) / pairs.leastDensity / (pairs.accurate ? pairs.leastMoment : 1);
  }
  TREACLE_HD double wall(const IsphPairs<D>&, std::uint32_t, std::uint32_t, const Vec<D>&, const Distance&) const {
    return 0;
  }
  TREACLE_HD double own(const IsphPairs<D>& pairs, std::uint32_t i) const { return pairs.missingCoefficient(i); }
};

}  // namespace treacle
