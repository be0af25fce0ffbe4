#pragma once

#include "treacle/core/couple.hpp"
#include "treacle/core/floored_inverse.hpp"
#include "treacle/isph/isph_flow.hpp"

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
    sum[Density] += pairs.densityWeight(r.r);
    const double slope = pairs.slope(r);
    for (int k = 0; k < D; ++k) sum[Lack + k] += slope * d[k];
    if (!pairs.accurate || i == j) return;
    sum[Laplacian] += 2 * slope;
    addSquare(slope, d, sum + Moments);
  }
  TREACLE_HD void store(const IsphPairs<D>& pairs, std::uint32_t i, const double* sum) const {
    const double ratio = sum[Density] / pairs.latticeWeight;
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
    pairs.renormalisation[i] = pairs.renormalisationOf(sum + Moments);
    const double missing = s.missing(oneSided, 1 - sum[Laplacian] / pairs.latticeLaplacian);
    pairs.missing[i] = static_cast<float>(missing);
    surface[i] = isFree ? Place::Free : missing > s.least ? Place::Surface : Place::Inside;
  }
};

/// B', where the surfaces of walls are known, after DensityTerm. What walls show of velocities is a boundary
/// condition, the same all along the wall. So with B the particles next to a wall have 0.79 of the derivatives
/// along it, in 2D with the usual kernel. B' makes up for that: in its moments walls count across their surfaces
/// alone. Particles away from walls have B.
template <int D>
struct AcrossWallsTerm {
  static constexpr int values = D * (D + 1) / 2;

  TREACLE_HD void fluid(const IsphPairs<D>& pairs, std::uint32_t, std::uint32_t, const Vec<D>& d,
                        const Distance& r, double* sum) const {
    addSquare(pairs.slope(r), d, sum);
  }
  TREACLE_HD void wall(const IsphPairs<D>& pairs, std::uint32_t, std::uint32_t j, const Vec<D>& d,
                       const Distance& r, double* sum) const {
    addSquare(pairs.slope(r), pairs.across(j, d), sum);
  }
  TREACLE_HD void store(const IsphPairs<D>& pairs, std::uint32_t i, const double* sum) const {
    pairs.acrossWalls[i] = pairs.renormalisationOf(sum);
  }
  TREACLE_HD void storeAway(const IsphPairs<D>& pairs, std::uint32_t i) const {
    pairs.acrossWalls[i] = pairs.renormalisation[i];
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

/// Force on walls: what viscous forces, pressures and the walls that stop particles take from the momentum of the
/// fluid in a step. What stops a particle is shared out by slopes and has one direction: walls on two sides of it
/// are not driven apart. Friction acts at the wall's surface: the couple is that of moving it there. Rows of
/// walls: i is the wall.
template <int D>
struct WallForceTerm {
  static constexpr int values = D + planesOf<D>;
  const double* pressure;               // of fluid [Pa]
  const Vec<D>* velocity;               // that the viscous step takes its forces of, of fluid and walls [m/s]
  const Vec<D>* stopped;                // of CorrectorTerm
  bool viscous;                         // there is a viscous step
  std::uint32_t firstWall;              // index of the first one that has a force
  Vec<D>* force;                        // [N/m3]
  Vec<3>* couple;                       // [N/m2]
  const SmoothFlow<D>* flow = nullptr;  // that of PredictorTerm

  TREACLE_HD void fluid(const IsphPairs<D>& pairs, std::uint32_t i, std::uint32_t j, const Vec<D>& d,
                        const Distance& r, double* sum) const {
    const double slope = pairs.slope(r), p = pressure[j], inertia = pairs.density(j) / pairs.timeStep;
    const Vec<D> toWall = -1.0 * d;
    const Vec<D> away = (p + pairs.wallPressure(p, j, i, toWall)) * pairs.renormalised(j, d);
    for (int k = 0; k < D; ++k) sum[k] += slope * (inertia * stopped[j][k] - away[k]);
    if (!viscous) return;
    const double drag = 2 * slope * pairs.viscosityAtWall(j, i, toWall);
    Vec<D> friction = drag * (velocity[j] - pairs.velocityAtSurface(i, toWall, velocity[i]));
    if (flow) friction += transposedForce(pairs.viscosityBetween(j, j), slope, flow[j], flow[j], d);
    for (int k = 0; k < D; ++k) sum[k] += friction[k];
    const double behind = pairs.wallSurface ? seenFace(pairs.surfaceOf(i), toWall).behind() : 0;
    addCouple(behind, d, friction, sum + D);
    if (flow || !pairs.wallMotion) return;
    // Friction lacks the rest of the stress, mu (grad v)^T, which makes no force on a wall, but a torque on one
    // that turns: the stress is that of velocities in the frame of the wall.
    const Vec<D> arm = pairs.wallMotion[pairs.body[i]].arm(pairs.position[i]) + behind * d;
    addCouple(1.0, arm, drag * pairs.swirl(i, (1 - behind) * toWall), sum + D);
  }
  TREACLE_HD void store(const IsphPairs<D>&, std::uint32_t i, const double* sum) const {
    couple[i - firstWall] = coupleOf<D>(sum + D);
    for (int k = 0; k < D; ++k) force[i - firstWall][k] = sum[k];
  }
};

}  // namespace treacle
