#pragma once

#include "treacle/core/cuda.hpp"
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
/// `held`, the pressures that particles hold, it is s kappa [n - n_0]_+ + held instead, s being promptShare.
template <int D>
void elasticPressure(Context<Cpu>&, const MphPairs<D>&, std::span<const double> n,
                     std::span<const Adhesion<D>> adhesion, std::span<double> elastic,
                     std::span<const double> held = {});
template <int D>
void elasticPressure(Context<Cuda>&, const MphPairs<D>&, std::span<const double> n,
                     std::span<const Adhesion<D>> adhesion, std::span<double> elastic,
                     std::span<const double> held = {});

/// What holdPressures() reads per particle.
template <int D>
struct VolumeChange {
  std::span<const double> n;              // number density
  std::span<const double> open;           // of numberDensity()
  std::span<const Adhesion<D>> adhesion;  // in place of Cover::of where there is a surface tension, else empty
  std::span<const double> divergence;     // C^T u^{k+1}, which is positive where fluid is compressed [1/s]
};

/// held_i at the end of a step of dt [s], per particle (heldPressureOf).
template <int D>
void holdPressures(Context<Cpu>&, const MphPairs<D>&, double dt, const VolumeChange<D>&, std::span<double> held);
template <int D>
void holdPressures(Context<Cuda>&, const MphPairs<D>&, double dt, const VolumeChange<D>&, std::span<double> held);

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

/// The share of the elastic pressure that follows the number density at once, where particles hold the rest. It
/// keeps particles evenly spread. It is cut at zero, so that noise of the density adds to its mean.
inline constexpr double promptShare = 0.5;

/// The formulas, for particle i.
template <int D>
TREACLE_HD double elasticPressureOf(const MphPairs<D>& pairs, std::uint32_t i, double n,
                                    std::span<const Adhesion<D>> adhesion, std::span<const double> held) {
  const double compressed = pairs.bulkModulus(i) * positivePart(n - pairs.restDensity);
  if (!held.empty()) return promptShare * compressed + held[i];
  if (adhesion.empty() || n >= pairs.restDensity) return compressed;
  return -pairs.bulkModulus(i) * adhesion[i].bears * positivePart(pairs.restDensity * adhesion[i].rest - n);
}

/// The time in which a held pressure follows the number density, in units of lambda / kappa.
inline constexpr double holdingTime = 3;

/// A particle's held pressure p changes with the volume that the flow takes from it, which is exact for velocities
/// that are linear in space and knows nothing of how particles stand; and it is drawn towards what its number
/// density says, so that errors do not add up and gaps close:
///
///   p^{k+1} = f p^k + kappa dt div + (1 - f) (1 - s) kappa (n - n_0),   f = exp(-dt / T),   T = 3 lambda / kappa
///
/// Where n < n_0, n_0 is that of fluid whose place is as open (Cover). Below zero p is not less than minus the
/// ambient pressure, and only covered particles have it. Walls, which may be too thin for densities, are not drawn
/// below zero.
template <int D>
TREACLE_HD double heldPressureOf(const MphPairs<D>& pairs, std::uint32_t i, double dt,
                                 const VolumeChange<D>& change, double held) {
  const double kappa = pairs.bulkModulus(i), lambda = pairs.bulkViscosity(i);
  if (kappa == 0 || lambda == 0) return 0;
  const double n = change.n[i], rest = pairs.restDensity;
  const Cover cover = change.adhesion.empty() ? Cover::of(change.open[i], n / rest)
                                              : Cover{change.adhesion[i].rest, change.adhesion[i].bears};
  const double lacks = i < pairs.fluidCount ? fmin(0.0, n - cover.rest * rest) : 0;
  const double excess = n > rest ? n - rest : lacks;
  const double kept = exp(-dt * kappa / (holdingTime * lambda));
  const double next =
      kept * held + kappa * dt * change.divergence[i] + (1 - kept) * (1 - promptShare) * kappa * excess;
  return next < 0 ? cover.bears * fmax(next, -pairs.ambientPressure) : next;
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
