#pragma once

#include "treacle/core/block.hpp"
#include "treacle/isph/isph_pairs.hpp"

#include <cmath>
#include <cstdint>

namespace treacle {

// Neighbouring rows of particles can move against each other without a change of the divergence or the velocity
// gradient: an hourglass mode. No solve for the pressure ends it, and under the pressure p it swings with a
// frequency of about c / l, c = sqrt(p / rho). HourglassTerm damps it in proportion to that frequency, by the part
// of the velocities of a pair that its gradients do not explain, as G. C. Ganzenmueller does with displacements
// (Comput. Methods Appl. Mech. Eng. 286, 2015).

/// sum += slope (v_j - v_i) (B_i d)^T, the velocity gradient by rows.
template <int D>
TREACLE_HD inline void addGradient(const IsphPairs<D>& pairs, const Vec<D>* velocity, std::uint32_t i,
                                   std::uint32_t j, const Vec<D>& d, const Distance& r, double* sum) {
  const Vec<D> b = pairs.renormalised(i, d), v = velocity[j] - velocity[i];
  const double slope = pairs.slope(r);
  for (int k = 0; k < D; ++k)
    for (int m = 0; m < D; ++m) sum[k * D + m] += slope * v[k] * b[m];
}

/// What HourglassTerm needs of each particle.
template <int D>
struct SmoothFlow {
  Block<D, float> gradient;  // L, without the velocities of walls; exact for linear ones away from walls [1/s]
  float speed;               // c, by the last pressure [m/s]
};

/// Finds it, for v* of fluid.
template <int D>
struct SmoothFlowTerm {
  static constexpr int values = D * D;
  const Vec<D>* velocity;  // [m/s]
  const double* pressure;  // of the last step [Pa]
  SmoothFlow<D>* flow;

  TREACLE_HD void fluid(const IsphPairs<D>& pairs, std::uint32_t i, std::uint32_t j, const Vec<D>& d,
                        const Distance& r, double* sum) const {
    addGradient(pairs, velocity, i, j, d, r, sum);
  }
  TREACLE_HD void wall(const IsphPairs<D>&, std::uint32_t, std::uint32_t, const Vec<D>&, const Distance&,
                       double*) const {}
  TREACLE_HD void store(const IsphPairs<D>& pairs, std::uint32_t i, const double* sum) const {
    for (int k = 0; k < D; ++k)
      for (int m = 0; m < D; ++m) flow[i].gradient(k, m) = static_cast<float>(sum[k * D + m]);
    flow[i].speed = static_cast<float>(std::sqrt(std::fabs(pressure[i]) / pairs.density(i)));
  }
};

/// v_i + sum w gamma (e.(v_j - v_i - (L_i + L_j) d / 2)) e [m/s] with e = d / |d|, the weights
/// w = slope 2 rho_j / (rho_i + rho_j) over the sum of the slopes in a full lattice, and gamma =
/// (c_i + c_j)/2 dt/l, at most `most`. It keeps momentum and, away from walls, linear velocities as they are. A
/// quarter of gamma is too little to end the swinging of a column of 60 rows, half of it does
/// (docs/notes/isph.md).
template <int D>
struct HourglassTerm {
  static constexpr int values = D;
  static constexpr double most = 0.5;  // more could turn such velocities around
  const Vec<D>* velocity;
  const SmoothFlow<D>* flow;
  Vec<D>* damped;

  TREACLE_HD void fluid(const IsphPairs<D>& pairs, std::uint32_t i, std::uint32_t j, const Vec<D>& d,
                        const Distance& r, double* sum) const {
    if (i == j) return;
    Block<D, float> gradients = flow[i].gradient;
    gradients += flow[j].gradient;
    const Vec<D> smooth = 0.5 * converted<double>(gradients * converted<float>(d));
    const double speed = 0.5 * (flow[i].speed + flow[j].speed);
    const double gamma = std::fmin(most, speed * pairs.timeStep / pairs.spacing);
    const double share = 2 * pairs.density(j) / (pairs.density(i) + pairs.density(j));
    const double jump = dot(velocity[j] - velocity[i] - smooth, d) / norm2(d);
    for (int k = 0; k < D; ++k) sum[k] += pairs.slope(r) * share * gamma * jump * d[k];
  }
  TREACLE_HD void wall(const IsphPairs<D>&, std::uint32_t, std::uint32_t, const Vec<D>&, const Distance&,
                       double*) const {}
  TREACLE_HD void store(const IsphPairs<D>& pairs, std::uint32_t i, const double* sum) const {
    for (int k = 0; k < D; ++k) damped[i][k] = velocity[i][k] + 2 / pairs.latticeLaplacian * sum[k];
  }
};

}  // namespace treacle
