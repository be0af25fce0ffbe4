#pragma once

#include "treacle/mph/mph_pairs.hpp"

#include <span>

namespace treacle {

/// Sums over neighbours that say where the energy of a step goes and what walls bear. u and pressure: per active
/// particle, walls included.

/// 2 (d+2) sum_j mu_ij (u_ij.e_ij)^2 (-w'_ij^v) / r_ij per fluid particle [W/m3], pairs of fluid shared by halves:
/// the sum over the particles has each pair once, but those of walls [K23 eq. (10), twice its second term].
template <int D, class Backend>
void shearDissipation(Context<Backend>&, const MphPairs<D>&, std::span<const Vec<D>> u,
                      std::span<double> dissipation);

/// The shear rate gamma_i per own fluid particle, from its part of the dissipation above [1/s]: that part is
/// mu gamma_i^2 m_i where all pairs have the viscosity mu, m_i being what the particle has of the sum of c_ij r^4
/// in a full neighbourhood (viscosity_scale.hpp). Inside the fluid it is sqrt(2 E:E) of velocities that are linear
/// in space. `share`: 1/m_i.
template <int D, class Backend>
void shearRate(Context<Backend>&, const MphPairs<D>&, std::span<const Vec<D>> u, std::span<const double> share,
               std::span<double> rate);

/// What wall particles meet of the fluid, per active wall particle.
template <int D>
struct FluidAtWalls {
  std::span<Vec<D>> force;       // pressure and viscosity on the wall [N/m3] [K23 eq. (4)]; q_i B_i of the fluid
  std::span<double> divergence;  // its part of C^T u [1/s]
  std::span<double> density;     // its part of n [-]
};

/// `walls`: the active wall particles with all fluid within reach as near; without entries where the pairs have
/// no lists.
template <int D, class Backend>
void fluidAtWalls(Context<Backend>&, const MphPairs<D>&, const ClusterListView& walls, std::span<const Vec<D>> u,
                  std::span<const double> pressure, const FluidAtWalls<D>&);

}  // namespace treacle
