#pragma once

#include "treacle/core/block.hpp"
#include "treacle/core/cuda.hpp"
#include "treacle/model/motion/frame_force.hpp"
#include "treacle/mph/mph_pairs.hpp"
#include "treacle/mph/surface_tension.hpp"

#include <cmath>
#include <cstdint>
#include <span>

namespace treacle {

/// What a step of MPH-I does particle by particle, without neighbours. Spans "per particle" have activeCount, "per
/// fluid particle" fluidCount elements.

/// kappa [n - n_0]_+ per particle [Pa]: the explicit part of Psi [K23 eq. (14)], cut at the free surface. Where
/// there is a surface tension, `adhesion` says which particles bear pressures below zero; empty: none does.
template <int D, class Backend>
void elasticPressure(Context<Backend>&, const MphPairs<D>&, std::span<const double> n,
                     std::span<const Adhesion<D>> adhesion, std::span<double> elastic);

/// rho/dt u + rho g per fluid particle: b of [K23 eq. (16)] before the pair sums.
template <int D, class Backend>
void inertiaAndGravity(Context<Backend>&, const MphPairs<D>&, std::span<const Vec<D>> u,
                       const FrameForce<D>& frame, std::span<Vec<D>> b);

/// force_i = -(block_i - rho/dt) u_i per own fluid particle [N/m3]: the viscous force of walls that are at rest.
/// `block`: that of WallTerms.
template <int D, class Backend>
void wallFriction(Context<Backend>&, const MphPairs<D>&, std::span<const Block<D>> block,
                  std::span<const Vec<D>> u, std::span<Vec<D>> force);

/// pressure_i = lambda_i div_i + elastic_i per particle [Pa] [K23 eq. (14)]; an empty `elastic` counts as zero.
/// `pressure` may be `div`.
template <int D, class Backend>
void bulkPressure(Context<Backend>&, const MphPairs<D>&, std::span<const double> div,
                  std::span<const double> elastic, std::span<double> pressure);

/// The formulas, for particle i.
template <int D>
TREACLE_HD double elasticPressureOf(const MphPairs<D>& pairs, std::uint32_t i, double n,
                                    std::span<const Adhesion<D>> adhesion) {
  const double compressed = pairs.bulkModulus(i) * positivePart(n - pairs.densityWithoutPressure(i));
  if (adhesion.empty() || n >= pairs.restDensity) return compressed;
  return -pairs.bulkModulus(i) * adhesion[i].bears * positivePart(pairs.restDensity * adhesion[i].rest - n);
}

template <int D>
TREACLE_HD Vec<D> inertiaAndGravityOf(const MphPairs<D>& pairs, std::uint32_t i, const Vec<D>& u,
                                      const FrameForce<D>& frame) {
  return pairs.inertia(i) * frame.turned(u) + frame.on(pairs.position[i], pairs.density(i));
}
template <int D>
TREACLE_HD double bulkPressureOf(const MphPairs<D>& pairs, std::uint32_t i, double div, double elastic) {
  return pairs.bulkViscosity(i) * div + elastic;
}

}  // namespace treacle
