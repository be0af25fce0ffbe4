#pragma once

#include "treacle/core/cuda.hpp"
#include "treacle/model/motion/shifting.hpp"
#include "treacle/mph/cover.hpp"
#include "treacle/mph/mph_pairs.hpp"

#include <cmath>
#include <cstdint>
#include <span>

namespace treacle {

/// Fluid under tension (docs/accurate.md): what it takes for a fluid that is pulled, or whose gaps have closed, to
/// keep its volume. Spans have an element for each fluid particle, or for each active particle where that is said.

/// (b q, b) of a quantity q of a particle and its weight b in means.
using Covered = Vec<2>;

/// q = min(0, n - n_0), n_0 being that of fluid whose place is as open; b = Cover::tells. For own fluid particles.
template <int D, class Backend>
void lackOfDensity(Context<Backend>&, const MphPairs<D>&, const Places&, std::span<Covered> lack);

/// mean_i = sum_j w_ij b_j q_j / sum_j w_ij b_j over the fluid around the particles i of the list, each fluid
/// particle among its own neighbours (coveredMeanOf). `mean`: per active particle, written for those of the list.
template <int D, class Backend>
void coveredMeans(Context<Backend>&, const MphPairs<D>&, const ClusterListView& list, std::span<const Covered> q,
                  std::span<double> mean);

/// q = P, the tension of own fluid [Pa], b = Cover::bears.
template <int D, class Backend>
void coverTension(Context<Backend>&, const MphPairs<D>&, const Places&, std::span<const double> tension,
                  std::span<Covered> covered);

/// P of own fluid at the end of a step of dt [s] (tensionOf). `lack`: the means of lackOfDensity().
template <int D, class Backend>
void followDensity(Context<Backend>&, const MphPairs<D>&, double dt, const Places&, std::span<const double> lack,
                   std::span<double> tension);

/// force_i = sum_j 2 P_ij w'_ij e_ij, the force of the tensions [N/m3], w being the weight of densities and P_ij
/// the tension of a pair (pairTension). Of fluid particles from all neighbours, of walls from the fluid.
/// `tension`, `force`: per active particle, the latter written for those of the list.
template <int D, class Backend>
void tensionForces(Context<Backend>&, const MphPairs<D>&, const ClusterListView& list,
                   std::span<const double> tension, std::span<Vec<D>> force);

/// What own fluid particles go with in a step of dt [s] (spreadVelocityOf). `u`, `tension`: per active particle.
template <int D, class Backend>
void spreadVelocities(Context<Backend>&, const MphPairs<D>&, double dt, std::span<const Vec<D>> u,
                      std::span<const double> tension, std::span<Vec<D>> transport);

/// B of own fluid (renormalisation.hpp) by the root of f = Places::resists: C takes B once and C^T once, so that
/// lambda is multiplied by f. (ln f, 1) per own fluid particle is for letWallsYield().
template <int D, class Backend>
void letGapsClose(Context<Backend>&, const MphPairs<D>&, const Places&, std::span<SymmetricBlock<D>> b,
                  std::span<Covered> logarithm);

/// From the mean of ln f around walls to the share of lambda that they have (wallShareOf()).
template <class Backend>
void letWallsYield(Context<Backend>&, std::span<double> mean);

/// tension *= share, element by element.
template <class Backend>
void shareTension(Context<Backend>&, std::span<const double> share, std::span<double> tension);

/// From the pressures that C is multiplied by to those that act (actingPressureOf()). `tension`, `pressure`: per
/// active particle; of ghosts the latter is of no use.
template <int D, class Backend>
void actingPressures(Context<Backend>&, const MphPairs<D>&, const Places&, std::span<const double> tension,
                     std::span<double> pressure);

/// The formulas, for particle i.
template <int D>
TREACLE_HD Covered lackOf(const MphPairs<D>& pairs, std::uint32_t i, const Places& around) {
  const Cover cover = around.cover(i, pairs.restDensity);
  return {cover.tells * fmin(0.0, around.n[i] - cover.rest * pairs.densityWithoutPressure(i)), cover.tells};
}

/// The mean, from the sums of w b q and w b without the factor of w. Where the weights come to less than 1 % of
/// those of a full neighbourhood it fades: else what is next to nothing would decide.
template <int D>
TREACLE_HD double coveredMeanOf(const MphPairs<D>& pairs, const Covered& sum) {
  return sum[0] / fmax(sum[1], 0.01 * pairs.restDensity / pairs.terms.densityFactor);
}

/// ln f of a particle, whose f counts as 1e-4 or more.
TREACLE_HD inline Covered logarithmOf(double resists) { return {log(fmax(1e-4, resists)), 1}; }
/// The share of its lambda that a wall particle has: the root of the mean f around it. Fluid that has rolled onto
/// a wall with a gap under it would else never come down.
TREACLE_HD inline double wallShareOf(double mean) { return exp(0.5 * mean); }

/// The time in which a tension follows the density, in units of lambda / kappa.
inline constexpr double tensionTime = 3;

template <int D>
TREACLE_HD Covered coveredTensionOf(const MphPairs<D>& pairs, std::uint32_t i, const Places& around,
                                    double tension) {
  const double bears = around.cover(i, pairs.restDensity).bears;
  return {bears * tension, bears};
}

/// P is drawn towards the mean of kappa min(0, n - n_0) over the neighbours of a particle:
///
///   P^{k+1} = f P^k + (1 - f) kappa <min(0, n - n_0)>,   f = exp(-dt / T),   T = 3 lambda / kappa
///
/// Only covered particles have it, beside gaps by the root of Places::resists as other pressures, and it is not
/// below minus the limit of tension. Where little resists, tension would move particles to and fro and give them
/// energy. `lack`: the mean.
template <int D>
TREACLE_HD double tensionOf(const MphPairs<D>& pairs, std::uint32_t i, double dt, const Places& around,
                            double lack, double before) {
  const double kappa = pairs.bulkModulus(i), lambda = pairs.bulkViscosity(i);
  if (kappa == 0 || lambda == 0) return 0;
  const double kept = exp(-dt * kappa / (tensionTime * lambda));
  return sqrt(around.resists(i, pairs.restDensity)) * around.cover(i, pairs.restDensity).bears *
         fmax(kept * before + (1 - kept) * kappa * lack, -pairs.tensionLimit);
}

/// 2 kappa_j / (kappa_i + kappa_j), by the materials of a pair.
template <int D>
TREACLE_HD double tensionShare(const MphPairs<D>& pairs, Substance own, Substance other) {
  const double a = pairs.materials.bulkModulus[own], b = pairs.materials.bulkModulus[other];
  return own == other || a + b == 0 ? 1 : 2 * b / (a + b);
}

/// 2 P_ij = 2 (kappa_j P_i + kappa_i P_j) / (kappa_i + kappa_j). Tension is one on both sides of an interface.
/// Both sides find it from their density with the same relative error, so that the softer one knows it better.
template <class T>
TREACLE_HD T pairTension(const T& share, const T& own, double other) {
  return share * (own - other) + 2 * other;
}

/// The pressure of a particle as its neighbours find it [Pa]: that of the system by the root of f, which stands in
/// C, and the tension.
template <int D>
TREACLE_HD double actingPressureOf(const MphPairs<D>& pairs, std::uint32_t i, const Places& around, double tension,
                                   double pressure) {
  const double f = i < pairs.ownFluid() ? around.resists(i, pairs.restDensity) : 1;
  return sqrt(f) * pressure + tension;
}

/// The tension from which on particles are shifted as far as they are, in units of kappa.
inline constexpr double shiftedFrom = 0.002;
/// How far that is: mean rates of pairs times dt.
inline constexpr double shiftPerRate = 5;

/// A flow that strains the fluid brings its particles out of order. Pressures above zero put them back, and
/// tension does not. Particles under tension are therefore moved by
///
///   -5 dt a l^2 min(1, -P / 0.002 kappa) sum_j (-w'_ij) e_ij,   a = sum_j (-w'_ij) |u_ij . e_ij| / D.
///
/// a is a mean of |u_ij . e_ij| / r_ij, since the sum of -w'_ij r_ij is D. Nothing moves in an even lattice, in
/// fluid that turns like a rigid body, and at rest. (Pairs that count by their own rates would drive particles to
/// where the fluid is strained less.) `sums`: that of (-w') e [1/m], then D a [1/s].
template <int D>
TREACLE_HD Vec<D> spreadVelocityOf(const MphPairs<D>& pairs, std::uint32_t i, double dt, double tension,
                                   const double* sums, const Vec<D>& u) {
  const double kappa = pairs.bulkModulus(i);
  if (kappa == 0) return u;
  Vec<D> crowding;
  for (int k = 0; k < D; ++k) crowding[k] = sums[k];
  const double coefficient = shiftPerRate * dt * sums[D] / D * fmin(1.0, -tension / (shiftedFrom * kappa));
  return shiftedVelocity({coefficient, pairs.spacing, dt}, crowding, u);
}

}  // namespace treacle
