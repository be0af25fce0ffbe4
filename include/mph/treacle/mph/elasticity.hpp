#pragma once

#include "treacle/core/block.hpp"
#include "treacle/core/cuda.hpp"
#include "treacle/mph/mph_pairs.hpp"

#include <span>

namespace treacle {

/// Gradients of the velocity and forces of the stresses of elastic fluid, by a weight g d of the viscosity's
/// radius:
///   L_i = sum_j g (u_j - u_i) (B_i d)^T,   f_i = sum_j g (tau_i B_i + tau_j B_j) d,   B_i = (sum_j g d d^T)^-1,
/// of which one is minus the other's transpose, so that the power of the forces is that of the stresses. Momentum
/// is conserved. Walls' velocities are extrapolated through their surfaces (wallFactor), and a wall has the stress
/// of the fluid particle that meets it. Pairs are those of the accurate scheme. Spans are per own fluid particle
/// in the backend's memory unless told.

/// Eigenvalues of sum g d d^T below this one count as this one: a particle that has neighbours on a line knows
/// nothing of the gradient across.
inline constexpr double leastElasticMoment = 0.2;

/// B; `atMostOne`: reduced, so that no eigenvalue is above 1 (flooredInverse()).
template <int D, class Backend>
void gradientCorrection(Context<Backend>&, const MphPairs<D>&, std::span<SymmetricBlock<D>> b, bool atMostOne);

/// L(r, s) = du_r/dx_s [1/s]; u per active particle.
template <int D, class Backend>
void velocityGradient(Context<Backend>&, const MphPairs<D>&, std::span<const SymmetricBlock<D>> b,
                      std::span<const Vec<D>> u, std::span<Block<D>> gradient);

/// f [N/m3]; `carried`: tau B per fluid particle, ghosts included [Pa].
template <int D, class Backend>
void stressForces(Context<Backend>&, const MphPairs<D>&, std::span<const Block<D>> carried,
                  std::span<Vec<D>> force);

/// What walls bear of it, from the first wall particle on [N/m3], and the couple of moving these forces to the
/// walls' surface, where they act [N/m2], which is zero before. `walls`: their neighbours, as far as the viscosity
/// acts.
template <int D, class Backend>
void stressOnWalls(Context<Backend>&, const MphPairs<D>&, const ClusterListView& walls,
                   std::span<const Block<D>> carried, std::span<Vec<D>> force, std::span<Vec<3>> couple);

}  // namespace treacle
