#pragma once

#include "treacle/isph/isph_flow.hpp"

#include <cstdint>

namespace treacle {

/// The viscous step of ISPH, explicit and implicit (isph_terms.hpp).

/// v* = v + dt (nu lap v + g) [O23 eq. (7)] with the Laplacian of [O23 eq. (6)], and with the forces of
/// isph_flow.hpp where there is a `flow`. A no-slip wall is met with its velocity at its
/// surface (IsphPairs::viscosityAtWall).
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
    add(2 * pairs.slope(r) * viscosity, i, velocity[j], sum);
    if (!flow) return;
    const Vec<D> force = hourglassForce(pairs, velocity, flow, i, j, d, r) +
                         transposedForce(viscosity, pairs.slope(r), flow[i], flow[j], d);
    for (int k = 0; k < D; ++k) sum[k] += force[k];
  }
  TREACLE_HD void wall(const IsphPairs<D>& pairs, std::uint32_t i, std::uint32_t j, const Vec<D>& d,
                       const Distance& r, double* sum) const {
    add(2 * pairs.slope(r) * pairs.viscosityAtWall(i, j, d), i, pairs.velocityAtSurface(j, d, velocity[j]), sum);
    if (!flow || !viscous) return;
    const Vec<D> force = transposedForce(pairs.viscosityBetween(i, i), pairs.slope(r), flow[i], flow[i], d);
    for (int k = 0; k < D; ++k) sum[k] += force[k];
  }
  TREACLE_HD void add(double c, std::uint32_t i, const Vec<D>& other, double* sum) const {
    if (!viscous) return;
    for (int k = 0; k < D; ++k) sum[k] += c * (other[k] - velocity[i][k]);
  }
  TREACLE_HD void store(const IsphPairs<D>& pairs, std::uint32_t i, const double* sum) const {
    const double density = pairs.density(i);
    const Vec<D> u = pairs.frame.turned(velocity[i]), f = pairs.frame.on(pairs.position[i], density);
    for (int k = 0; k < D; ++k) predicted[i][k] = u[k] + pairs.timeStep * (sum[k] + f[k]) / density;
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
    const double c = 2 * pairs.slope(r) * pairs.viscosityAtWall(i, j, d);
    Vec<D> force = c * pairs.velocityAtSurface(j, d, velocity[j]);
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
  TREACLE_HD void wall(const IsphPairs<D>& pairs, std::uint32_t i, std::uint32_t j, const Vec<D>& d,
                       const Distance& r, double* sum) const {
    const double c = 2 * pairs.slope(r) * pairs.viscosityAtWall(i, j, d);
    const Vec<D> u = pairs.velocityAtSurface(j, d, velocity[j]);
    for (int k = 0; k < D; ++k) sum[k] += c * (u[k] - velocity[i][k]);
  }
  TREACLE_HD void store(const IsphPairs<D>&, std::uint32_t i, const double* sum) const {
    for (int k = 0; k < D; ++k) force[i][k] = sum[k];
  }
};

/// Row i of the matrix of the implicit viscous step, rho/dt I - mu lap; all fluid is unknown (PressureRow).
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
  TREACLE_HD double wall(const IsphPairs<D>& pairs, std::uint32_t i, std::uint32_t j, const Vec<D>& d,
                         const Distance& r) const {
    return 2 * pairs.slope(r) * pairs.viscosityAtWall(i, j, d);
  }
  TREACLE_HD double own(const IsphPairs<D>& pairs, std::uint32_t i) const {
    return pairs.density(i) / pairs.timeStep;
  }
};

}  // namespace treacle
