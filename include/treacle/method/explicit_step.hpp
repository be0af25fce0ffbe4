#pragma once

#include "treacle/core/cuda.hpp"
#include "treacle/method/mph_pairs.hpp"

#include <cstdint>
#include <span>

namespace treacle {

/// What a step does particle by particle, without neighbours. Spans "per particle" have activeCount, "per fluid
/// particle" fluidCount elements.

/// kappa [n - n_0]_+ per particle [Pa]: the explicit part of Psi [K23 eq. (14)], cut at the free surface.
template <int D>
void elasticPressure(Context<Cpu>&, const MphPairs<D>&, std::span<const double> n, double restDensity,
                     std::span<double> elastic);
template <int D>
void elasticPressure(Context<Cuda>&, const MphPairs<D>&, std::span<const double> n, double restDensity,
                     std::span<double> elastic);

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

/// No particle.
inline constexpr std::uint32_t nobody = ~std::uint32_t{0};

/// moved_i = x_i + dt u_i [K23 eq. (15)] for all particles of the span, brought back into periodic domains.
/// Returns the first particle that left an open one (or is not finite), or `nobody`.
template <int D>
std::uint32_t moveParticles(Context<Cpu>&, const CellGrid<D>& grid, double dt, std::span<const Vec<D>> x,
                            std::span<const Vec<D>> u, std::span<Vec<D>> moved);
template <int D>
std::uint32_t moveParticles(Context<Cuda>&, const CellGrid<D>& grid, double dt, std::span<const Vec<D>> x,
                            std::span<const Vec<D>> u, std::span<Vec<D>> moved);

}  // namespace treacle
