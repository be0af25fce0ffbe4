#pragma once

#include "treacle/core/floored_inverse.hpp"
#include "treacle/isph/isph_flow.hpp"

#include <cmath>
#include <cstdint>

namespace treacle {

/// The formulas of ISPH, the same on all backends: what each neighbour adds to a particle's sums, and what is made
/// of them. fluid() and wall() add what neighbour j of particle i gives at d = x_j - x_i, r = |d|, to as many sums
/// as `values`; the rows of fluid hold i itself, at r = 0. store() takes the sums. Pointers are in the backend's
/// memory.

/// Density and lack of neighbours, from which the free surface follows; in the accurate scheme B as well, the
/// inverse of M = sum V W' / r d d^T, with which sums over gradients are exact for linear fields (Bonet, Lok
/// 1999), and the share of its neighbours that a particle at the free surface misses.
template <int D>
struct DensityTerm {
  static constexpr int moments = D * (D + 1) / 2, values = 3 + D + moments;
  enum { Density, Lack, Others = Lack + D, Laplacian, Moments };  // places of the sums
  double* density;                                                // <rho> / rho [-]
  Vec<D>* deficit;        // sum V grad W [1/m]: points to where the neighbours are
  std::uint8_t* surface;  // Place

  TREACLE_HD void fluid(const IsphPairs<D>& pairs, std::uint32_t i, std::uint32_t j, const Vec<D>& d,
                        const Distance& r, double* sum) const {
    wall(pairs, i, j, d, r, sum);
    sum[Others] += i != j;
  }
  TREACLE_HD void wall(const IsphPairs<D>& pairs, std::uint32_t i, std::uint32_t j, const Vec<D>& d,
                       const Distance& r, double* sum) const {
    sum[Density] += pairs.volume * pairs.kernel.value(r.r);
    const double slope = pairs.slope(r);
    for (int k = 0; k < D; ++k) sum[Lack + k] += slope * d[k];
    if (!pairs.accurate || i == j) return;
    sum[Laplacian] += 2 * slope;
    addSquare(slope, d, sum + Moments);
  }
  TREACLE_HD void store(const IsphPairs<D>& pairs, std::uint32_t i, const double* sum) const {
    const double ratio = sum[Density] / pairs.latticeDensity;
    Vec<D> lack;
    for (int k = 0; k < D; ++k) lack[k] = sum[Lack + k];
    const SurfaceCriterion& s = pairs.surface;
    const double oneSided = norm(lack) * pairs.spacing;
    const bool isFree = sum[Others] < s.fewest(D);
    density[i] = ratio;
    deficit[i] = lack;
    if (!pairs.accurate) {
      const bool isSurface = ratio < s.sparse || (ratio < s.dense && oneSided > s.oneSided);
      surface[i] = isFree || isSurface ? Place::Free : Place::Inside;
      return;
    }
    const SymmetricBlock<D> moment = squareOf<D>(sum + Moments);
    pairs.renormalisation[i] = converted<float>(flooredInverse(moment, pairs.leastMoment, false));
    const double missing = s.missing(oneSided, 1 - sum[Laplacian] / pairs.latticeLaplacian);
    pairs.missing[i] = static_cast<float>(missing);
    surface[i] = isFree ? Place::Free : missing > s.least ? Place::Surface : Place::Inside;
  }
};

/// v* = v + dt (nu lap v + g) [O23 eq. (7)] with the Laplacian of [O23 eq. (6)], and with the forces of
/// isph_flow.hpp where there is a `flow`. A no-slip wall is met with the fluid's velocity mirrored at the wall's.
template <int D>
struct PredictorTerm {
  static constexpr int values = D;
  const Vec<D>* velocity;
  Vec<D>* predicted;
  bool viscous;
  const SmoothFlow<D>* flow = nullptr;  // of velocity

  TREACLE_HD void fluid(const IsphPairs<D>& pairs, std::uint32_t i, std::uint32_t j, const Vec<D>& d,
                        const Distance& r, double* sum) const {
    const double viscosity = viscous ? pairs.viscosityBetween(i, j) : 0;
    add(2 * pairs.slope(r) * viscosity, i, j, sum);
    if (!flow) return;
    const Vec<D> force = hourglassForce(pairs, velocity, flow, i, j, d, r) +
                         transposedForce(viscosity, pairs.slope(r), flow[i], flow[j], d);
    for (int k = 0; k < D; ++k) sum[k] += force[k];
  }
  TREACLE_HD void wall(const IsphPairs<D>& pairs, std::uint32_t i, std::uint32_t j, const Vec<D>& d,
                       const Distance& r, double* sum) const {
    if (pairs.noSlip) add(4 * pairs.slope(r) * pairs.viscosityAtWall(i, j), i, j, sum);
    if (!flow || !viscous) return;
    const Vec<D> force = transposedForce(pairs.viscosityBetween(i, i), pairs.slope(r), flow[i], flow[i], d);
    for (int k = 0; k < D; ++k) sum[k] += force[k];
  }
  TREACLE_HD void add(double c, std::uint32_t i, std::uint32_t j, double* sum) const {
    if (!viscous) return;
    for (int k = 0; k < D; ++k) sum[k] += c * (velocity[j][k] - velocity[i][k]);
  }
  TREACLE_HD void store(const IsphPairs<D>& pairs, std::uint32_t i, const double* sum) const {
    const double density = pairs.density(i);
    const Vec<D> u = pairs.frame.turned(velocity[i]), f = pairs.frame.on(pairs.position[i], density);
    for (int k = 0; k < D; ++k) predicted[i][k] = u[k] + pairs.timeStep * (sum[k] + f[k]) / density;
  }
};

/// Two terms in one walk over the neighbours; neither reads what the other stores.
template <class First, class Second>
struct BothTerms {
  static constexpr int values = First::values + Second::values;
  First first;
  Second second;

  template <int D>
  TREACLE_HD void fluid(const IsphPairs<D>& pairs, std::uint32_t i, std::uint32_t j, const Vec<D>& d,
                        const Distance& r, double* sum) const {
    first.fluid(pairs, i, j, d, r, sum);
    second.fluid(pairs, i, j, d, r, sum + First::values);
  }
  template <int D>
  TREACLE_HD void wall(const IsphPairs<D>& pairs, std::uint32_t i, std::uint32_t j, const Vec<D>& d,
                       const Distance& r, double* sum) const {
    first.wall(pairs, i, j, d, r, sum);
    second.wall(pairs, i, j, d, r, sum + First::values);
  }
  template <int D>
  TREACLE_HD void store(const IsphPairs<D>& pairs, std::uint32_t i, const double* sum) const {
    first.store(pairs, i, sum);
    second.store(pairs, i, sum + First::values);
  }
};

/// Right-hand side of the implicit viscous step, rho/dt v + rho g, the pull of no-slip walls and, where there
/// is a `flow`, the damping of hourglass modes, by component, and div(mu L^T), the rest of the viscous stress, on
/// particles that lack neighbours. Inside a fluid it is zero; taken there, too, in long steps, channels flow too
/// fast (docs/notes/isph.md).
template <int D>
struct ViscousSourceTerm {
  static constexpr int values = D;
  const Vec<D>* velocity;
  double* source[D];
  const SmoothFlow<D>* flow = nullptr;  // of velocity

  TREACLE_HD void fluid(const IsphPairs<D>& pairs, std::uint32_t i, std::uint32_t j, const Vec<D>& d,
                        const Distance& r, double* sum) const {
    if (!flow) return;
    Vec<D> force = hourglassForce(pairs, velocity, flow, i, j, d, r);
    if (isNearSurface(pairs, i))
      force += transposedForce(pairs.viscosityBetween(i, j), pairs.slope(r), flow[i], flow[j], d);
    for (int k = 0; k < D; ++k) sum[k] += force[k];
  }
  TREACLE_HD void wall(const IsphPairs<D>& pairs, std::uint32_t i, std::uint32_t j, const Vec<D>& d,
                       const Distance& r, double* sum) const {
    const double c = pairs.noSlip ? 4 * pairs.slope(r) * pairs.viscosityAtWall(i, j) : 0;
    Vec<D> force = c * velocity[j];
    if (flow && isNearSurface(pairs, i))
      force += transposedForce(pairs.viscosityBetween(i, i), pairs.slope(r), flow[i], flow[i], d);
    for (int k = 0; k < D; ++k) sum[k] += force[k];
  }
  TREACLE_HD void store(const IsphPairs<D>& pairs, std::uint32_t i, const double* sum) const {
    const double density = pairs.density(i);
    const Vec<D> u = pairs.frame.turned(velocity[i]), f = pairs.frame.on(pairs.position[i], density);
    for (int k = 0; k < D; ++k) source[k][i] = density / pairs.timeStep * u[k] + f[k] + sum[k];
  }

 private:
  TREACLE_HD static bool isNearSurface(const IsphPairs<D>& pairs, std::uint32_t i) {
    return pairs.missingShare(i) > 0;
  }
};

/// The viscous force of no-slip walls [N/m3], as in PredictorTerm but for div(mu L^T), which makes none on them.
template <int D>
struct WallFrictionTerm {
  static constexpr int values = D;
  const Vec<D>* velocity;
  Vec<D>* force;

  TREACLE_HD void fluid(const IsphPairs<D>&, std::uint32_t, std::uint32_t, const Vec<D>&, const Distance&,
                        double*) const {}
  TREACLE_HD void wall(const IsphPairs<D>& pairs, std::uint32_t i, std::uint32_t j, const Vec<D>&,
                       const Distance& r, double* sum) const {
    const double c = pairs.noSlip ? 4 * pairs.slope(r) * pairs.viscosityAtWall(i, j) : 0;
    for (int k = 0; k < D; ++k) sum[k] += c * (velocity[j][k] - velocity[i][k]);
  }
  TREACLE_HD void store(const IsphPairs<D>&, std::uint32_t i, const double* sum) const {
    for (int k = 0; k < D; ++k) force[i][k] = sum[k];
  }
};

/// Right-hand side of the pressure equation [O23 eq. (10)], divided by -rho: -div v* / dt + alpha (<rho>/rho - 1)
/// / dt^2, zero for free particles. Compression raises p. Walls are met with v* mirrored at the wall's velocity:
/// with the wall's velocity itself half of the flow into it would be missed. Walls count in it as in the
/// Laplacian, so that water at rest has the hydrostatic pressure. In the accurate scheme particles at the free
/// surface lack neighbours, not volume: a density below 1 does not count, and the less the more neighbours are
/// missing. The term with alpha has an equation of its own there, by which particles move (IsphArrangement).
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
    sum[0] += pairs.slope(r) * dot(predicted[j] - predicted[i], pairs.renormalised(i, d));
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

/// Force on walls: what viscous forces, pressures and the walls that stop particles take from the momentum of the
/// fluid in a step. What stops a particle is shared out by slopes and has one direction: walls on two sides of it
/// are not driven apart. Rows of walls: i is the wall.
template <int D>
struct WallForceTerm {
  static constexpr int values = D;
  const double* pressure;               // of fluid [Pa]
  const Vec<D>* velocity;               // that the viscous step takes its forces of, of fluid and walls [m/s]
  const Vec<D>* stopped;                // of CorrectorTerm
  bool viscous;                         // there is a viscous step
  std::uint32_t firstWall;              // index of the first one that has a force
  Vec<D>* force;                        // [N/m3]
  const SmoothFlow<D>* flow = nullptr;  // that of PredictorTerm

  TREACLE_HD void fluid(const IsphPairs<D>& pairs, std::uint32_t i, std::uint32_t j, const Vec<D>& d,
                        const Distance& r, double* sum) const {
    const double slope = pairs.slope(r), p = pressure[j];
    const double push = p + pairs.wallPressure(p, j, i, -1.0 * d), inertia = pairs.density(j) / pairs.timeStep;
    const double drag = viscous && pairs.noSlip ? 4 * pairs.viscosityAtWall(j, i) : 0;
    const Vec<D> away = push * pairs.renormalised(j, d);
    for (int k = 0; k < D; ++k)
      sum[k] += slope * (drag * (velocity[j][k] - velocity[i][k]) - away[k] + inertia * stopped[j][k]);
    if (!viscous || !flow) return;
    const Vec<D> stress = transposedForce(pairs.viscosityBetween(j, j), slope, flow[j], flow[j], d);
    for (int k = 0; k < D; ++k) sum[k] += stress[k];
  }
  TREACLE_HD void store(const IsphPairs<D>&, std::uint32_t i, const double* sum) const {
    for (int k = 0; k < D; ++k) force[i - firstWall][k] = sum[k];
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
  TREACLE_HD double wall(const IsphPairs<D>&, std::uint32_t, std::uint32_t, const Distance&) const { return 0; }
  TREACLE_HD double own(const IsphPairs<D>& pairs, std::uint32_t i) const { return pairs.missingCoefficient(i); }
};

/// The same of the implicit viscous step, rho/dt I - mu lap; all fluid is unknown.
template <int D>
struct ViscousRow {
  TREACLE_HD bool isUnknown(std::uint32_t) const { return true; }
  TREACLE_HD double coefficient(const IsphPairs<D>& pairs, std::uint32_t i, std::uint32_t j, const Vec<D>&,
                                const Distance& r) const {
    return 2 * pairs.slope(r) * pairs.viscosityBetween(i, j);
  }
  double largest(const IsphPairs<D>& pairs) const {
    return 2 * pairs.slope(0) * (pairs.mostViscosity + pairs.mostEddyViscosity);
  }
  TREACLE_HD double wall(const IsphPairs<D>& pairs, std::uint32_t i, std::uint32_t j, const Distance& r) const {
    return pairs.noSlip ? 4 * pairs.slope(r) * pairs.viscosityAtWall(i, j) : 0;
  }
  TREACLE_HD double own(const IsphPairs<D>& pairs, std::uint32_t i) const {
    return pairs.density(i) / pairs.timeStep;
  }
};

}  // namespace treacle
