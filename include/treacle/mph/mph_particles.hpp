#pragma once

#include "treacle/core/cuda.hpp"
#include "treacle/model/shifting.hpp"
#include "treacle/mph/cover.hpp"
#include "treacle/mph/mph_pairs.hpp"
#include "treacle/mph/surface_tension.hpp"

#include <cmath>
#include <cstdint>
#include <span>

namespace treacle {

/// What a step of MPH-I does particle by particle, without neighbours. Spans "per particle" have activeCount, "per
/// fluid particle" fluidCount elements.

/// kappa [n - n_0]_+ per particle [Pa]: the explicit part of Psi [K23 eq. (14)], cut at the free surface. Where
/// there is a surface tension, `adhesion` says which particles bear pressures below zero; empty: none does. With
/// `held`, the pressures that particles hold, it is kappa [n - n_0]_+ + held instead.
template <int D>
void elasticPressure(Context<Cpu>&, const MphPairs<D>&, std::span<const double> n,
                     std::span<const Adhesion<D>> adhesion, std::span<double> elastic,
                     std::span<const double> held = {});
template <int D>
void elasticPressure(Context<Cuda>&, const MphPairs<D>&, std::span<const double> n,
                     std::span<const Adhesion<D>> adhesion, std::span<double> elastic,
                     std::span<const double> held = {});

/// What particles that hold pressures know of the fluid around them.
struct Surroundings {
  std::span<const double> n;     // number density
  std::span<const double> open;  // of numberDensity()
};

/// held_i at the end of a step of dt [s], per particle (heldPressureOf). `divergence`: C^T u^{k+1} per particle,
/// which is positive where fluid is compressed [1/s].
template <int D>
void holdPressures(Context<Cpu>&, const MphPairs<D>&, double dt, const Surroundings&,
                   std::span<const double> divergence, std::span<double> held);
template <int D>
void holdPressures(Context<Cuda>&, const MphPairs<D>&, double dt, const Surroundings&,
                   std::span<const double> divergence, std::span<double> held);

/// What fluid particles go with in a step of dt [s] where particles hold pressures: u and a shift that spreads
/// them evenly (spreadVelocityOf). `crowding`: C 1 per fluid particle [1/m], which is overwritten by the result.
template <int D>
void spreadVelocities(Context<Cpu>&, const MphPairs<D>&, double dt, const Surroundings&, std::span<const Vec<D>> u,
                      std::span<Vec<D>> crowding);
template <int D>
void spreadVelocities(Context<Cuda>&, const MphPairs<D>&, double dt, const Surroundings&,
                      std::span<const Vec<D>> u, std::span<Vec<D>> crowding);

/// rho/dt u + rho g per fluid particle: b of [K23 eq. (16)] before the pair sums.
template <int D>
void inertiaAndGravity(Context<Cpu>&, const MphPairs<D>&, std::span<const Vec<D>> u, const Vec<D>& gravity,
                       std::span<Vec<D>> b);
template <int D>
void inertiaAndGravity(Context<Cuda>&, const MphPairs<D>&, std::span<const Vec<D>> u, const Vec<D>& gravity,
                       std::span<Vec<D>> b);

/// pressure_i = lambda_i div_i + elastic_i per particle [Pa] [K23 eq. (14)]; an empty `elastic` counts as zero.
/// `pressure` may be `div`.
template <int D>
void bulkPressure(Context<Cpu>&, const MphPairs<D>&, std::span<const double> div, std::span<const double> elastic,
                  std::span<double> pressure);
template <int D>
void bulkPressure(Context<Cuda>&, const MphPairs<D>&, std::span<const double> div, std::span<const double> elastic,
                  std::span<double> pressure);

/// The formulas, for particle i.
template <int D>
TREACLE_HD double elasticPressureOf(const MphPairs<D>& pairs, std::uint32_t i, double n,
                                    std::span<const Adhesion<D>> adhesion, std::span<const double> held) {
  const double compressed = pairs.bulkModulus(i) * positivePart(n - pairs.restDensity);
  if (!held.empty()) return compressed + held[i];
  if (adhesion.empty() || n >= pairs.restDensity) return compressed;
  return -pairs.bulkModulus(i) * adhesion[i].bears * positivePart(pairs.restDensity * adhesion[i].rest - n);
}

/// The time in which a held pressure follows the number density, in units of lambda / kappa.
inline constexpr double holdingTime = 3;
/// The share of kappa with which it follows the divergence: enough for closing gaps not to overshoot.
inline constexpr double divergenceShare = 0.5;

/// A particle's held pressure p changes with the volume that the flow takes from it, which knows nothing of how
/// particles stand; and it is drawn towards kappa (n - n_0) where that is below zero, to zero elsewhere, so that
/// errors do not add up and gaps close:
///
///   p^{k+1} = f p^k + s kappa dt div + (1 - f) kappa min(0, n - n_0),   f = exp(-dt / T),   T = 3 lambda / kappa
///
/// With kappa [n - n_0]_+ of elasticPressure() the mean of slow changes is kappa (n - n_0), whatever the noise of
/// n. Below n_0, n_0 is that of fluid whose place is as open (Cover). Below zero p is not less than minus the
/// ambient pressure, and only covered particles have it. Walls, which may be too thin for densities, are not drawn
/// below zero.
template <int D>
TREACLE_HD double heldPressureOf(const MphPairs<D>& pairs, std::uint32_t i, double dt, const Surroundings& around,
                                 double divergence, double held) {
  const double kappa = pairs.bulkModulus(i), lambda = pairs.bulkViscosity(i);
  if (kappa == 0 || lambda == 0) return 0;
  const double n = around.n[i], rest = pairs.restDensity;
  const Cover cover = Cover::of(around.open[i], n / rest);
  const double lacks = i < pairs.fluidCount ? fmin(0.0, n - cover.rest * rest) : 0;
  const double kept = exp(-dt * kappa / (holdingTime * lambda));
  const double next = kept * held + divergenceShare * kappa * dt * divergence + (1 - kept) * kappa * lacks;
  return next < 0 ? cover.bears * fmax(next, -pairs.ambientPressure) : next;
}

/// How far particles are shifted in the time lambda / kappa.
inline constexpr double shiftingShare = 0.2;

/// Pressures above zero keep particles evenly spread, and those below zero do not. Covered particles are therefore
/// moved to where neighbours lack, by 0.2 (kappa dt / lambda) l^2 C 1, which is nothing in a lattice.
template <int D>
TREACLE_HD Vec<D> spreadVelocityOf(const MphPairs<D>& pairs, std::uint32_t i, double dt,
                                   const Surroundings& around, const Vec<D>& u, const Vec<D>& crowding) {
  const double kappa = pairs.bulkModulus(i), lambda = pairs.bulkViscosity(i);
  if (lambda == 0) return u;
  const double bears = Cover::of(around.open[i], around.n[i] / pairs.restDensity).bears;
  return shiftedVelocity({shiftingShare * bears * kappa * dt / lambda, pairs.spacing, dt}, crowding, u);
}
template <int D>
TREACLE_HD Vec<D> inertiaAndGravityOf(const MphPairs<D>& pairs, std::uint32_t i, const Vec<D>& u,
                                      const Vec<D>& gravity) {
  return pairs.inertia(i) * u + pairs.density(i) * gravity;
}
template <int D>
TREACLE_HD double bulkPressureOf(const MphPairs<D>& pairs, std::uint32_t i, double div, double elastic) {
  return pairs.bulkViscosity(i) * div + elastic;
}

}  // namespace treacle
