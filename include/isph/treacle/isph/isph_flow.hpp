#pragma once

#include "treacle/core/block.hpp"
#include "treacle/core/floored_inverse.hpp"
#include "treacle/isph/isph_pairs.hpp"

#include <cmath>
#include <cstdint>

namespace treacle {

/// The flow around a particle; a device loads it in few words.
template <int D>
struct alignas(16) SmoothFlow {
  Block<D, float> gradient;  // L of the fluid alone; exact for linear velocities [1/s]
  float speed;               // c, by the last pressure [m/s]
};

/// Finds it by the fluid, without walls: L = sum s (v_j - v_i) d^T (sum s d d^T)^-1, s = slope.
template <int D>
struct SmoothFlowTerm {
  static constexpr int values = D * D + D * (D + 1) / 2;
  enum { Gradient, Moments = D * D };  // places of the sums
  const Vec<D>* velocity;              // [m/s]
  const double* pressure;              // of the last step [Pa]
  SmoothFlow<D>* flow;

  TREACLE_HD void fluid(const IsphPairs<D>& pairs, std::uint32_t i, std::uint32_t j, const Vec<D>& d,
                        const Distance& r, double* sum) const {
    const double slope = pairs.slope(r);
    const Vec<D> v = velocity[j] - velocity[i];
    for (int k = 0; k < D; ++k)
      for (int m = 0; m < D; ++m) sum[Gradient + k * D + m] += slope * v[k] * d[m];
    addSquare(slope, d, sum + Moments);
  }
  TREACLE_HD void wall(const IsphPairs<D>&, std::uint32_t, std::uint32_t, const Vec<D>&, const Distance&,
                       double*) const {}
  TREACLE_HD void store(const IsphPairs<D>& pairs, std::uint32_t i, const double* sum) const {
    const SymmetricBlock<D> inverse = flooredInverse(squareOf<D>(sum + Moments), pairs.leastMoment, false);
    for (int k = 0; k < D; ++k) {
      Vec<D> row;
      for (int m = 0; m < D; ++m) row[m] = sum[Gradient + k * D + m];
      row = inverse * row;
      for (int m = 0; m < D; ++m) flow[i].gradient(k, m) = static_cast<float>(row[m]);
    }
    flow[i].speed = static_cast<float>(std::sqrt(std::fabs(pressure[i]) / pairs.density(i)));
  }
};

/// The damping of hourglass modes [N/m3]. Neighbouring rows of particles can move against each other without a
/// change of the divergence or the velocity gradient. No solve for the pressure ends that, and under the pressure
/// p it swings with a frequency of about c / l, c = sqrt(p / rho). The force is w 2 rho_i rho_j / (rho_i + rho_j)
/// gamma / dt (e.(v_j - v_i - (L_i + L_j) d / 2)) e with e = d / |d|, w = slope over the sum of the slopes in a
/// full lattice, and gamma = (c_i + c_j)/2 dt/l, at most a half: more could turn such velocities around. It keeps
/// momentum and leaves linear velocities as they are. A quarter of gamma is too little to end the swinging of a
/// column of 60 rows, half of it does (docs/notes/isph.md). G. C. Ganzenmueller (Comput. Methods Appl. Mech. Eng.
/// 286, 2015) damps displacements in such a way.
template <int D>
TREACLE_HD inline Vec<D> hourglassForce(const IsphPairs<D>& pairs, const Vec<D>* velocity,
                                        const SmoothFlow<D>* flow, std::uint32_t i, std::uint32_t j,
                                        const Vec<D>& d, const Distance& r) {
  if (i == j) return {};
  const SmoothFlow<D> mine = flow[i], other = flow[j];
  Block<D, float> gradients = mine.gradient;
  gradients += other.gradient;
  const Vec<D> smooth = 0.5 * converted<double>(gradients * converted<float>(d));
  const double most = 0.5 / pairs.timeStep, gamma = 0.5 * (mine.speed + other.speed) / pairs.spacing;
  const double jump = dot(velocity[j] - velocity[i] - smooth, d) * r.inverse * r.inverse;
  const double share = 2 / pairs.latticeLaplacian * pairs.slope(r) * pairs.inertiaBetween(i, j);
  return share * std::fmin(most, gamma) * jump * d;
}

/// mu slope (L_i + L_j)^T d [N/m3]: div(mu L^T), which mu lap v lacks of the divergence of the stress mu (L +
/// L^T). Walls show the gradient of the fluid particle. It is zero inside a fluid of one viscosity, but the free
/// surface needs it: without it waves decay half as fast as they do. It keeps momentum.
template <int D>
TREACLE_HD inline Vec<D> transposedForce(double viscosity, double slope, const SmoothFlow<D>& mine,
                                         const SmoothFlow<D>& other, const Vec<D>& d) {
  Vec<D> force{};
  for (int k = 0; k < D; ++k)
    for (int m = 0; m < D; ++m) force[m] += (mine.gradient(k, m) + other.gradient(k, m)) * d[k];
  return viscosity * slope * force;
}

}  // namespace treacle
