#pragma once

#include "treacle/core/block.hpp"
#include "treacle/mph/mph_pairs.hpp"

#include <span>

namespace treacle {

/// Sums over neighbours that make up one step. Spans "per particle" have activeCount, "per fluid particle"
/// fluidCount elements; results are overwritten unless the name says add, and set for own particles alone. What is
/// read of neighbours must be there for ghosts, too (fillGhosts).

/// What numberDensity() finds beside n, per particle, with v = [1-q^2]_+^3 (cover.hpp); empty: nothing.
struct PlaceSums {
  std::span<double> open;  // |sum_j v_ij d_ij| / (n_0 l): how open its place is
  std::span<double> wide;  // sum_j v_ij over that of a full lattice
};

/// n_i = sum_j w_ij^p, per particle [K23 eq. (7)].
///
/// `volume`: v by which the volumes of fluid particles, ghosts included, are multiplied [-], beside places only;
/// empty: 1. Then n_i = sum_j v_j w_ij + (v_i - 1) w(0), which is n_0 where the volumes fill the space, and places
/// likewise.
template <int D, class Backend>
void numberDensity(Context<Backend>&, const MphPairs<D>&, std::span<double> n, const PlaceSums& places = {},
                   std::span<const double> volume = {});

/// The part of n_i that wall particles make up, per fluid particle.
template <int D, class Backend>
void wallDensity(Context<Backend>&, const MphPairs<D>&, std::span<double> n);

/// y_i += factor (C q)_i = -factor sum_j (q_i B_i + q_j B_j) e_ij w'_ij^p per fluid particle; q per particle. B:
/// of the pairs (renormalisation.hpp), the unit matrix where they have none. Of a wall and fluid that slips along
/// it the part across the wall's surface counts (MphPairs::alongWall), here and in C^T.
template <int D, class Backend>
void addPressureGradient(Context<Backend>&, const MphPairs<D>&, std::span<const double> q, double factor,
                         std::span<Vec<D>> y);

/// (C^T u)_i = sum_j (u_j - u_i).B_i e_ij w'_ij^p per particle [K23 eq. (14)]; u per particle, walls included.
template <int D, class Backend>
void divergence(Context<Backend>&, const MphPairs<D>&, std::span<const Vec<D>> u, std::span<double> div);

/// How each own fluid particle sees walls along which it slips.
template <int D, class Backend>
void slipSides(Context<Backend>&, const MphPairs<D>& pairs, std::span<SlipSide<D>> side);

/// Per own fluid particle B, without what is along walls at which fluid slips, in place of the moment of all
/// neighbours (GradientMoment).
template <int D, class Backend>
void renormaliseAlongWalls(Context<Backend>&, const MphPairs<D>& pairs, std::span<SymmetricBlock<D>> b);

/// What is along walls at which fluid slips, for products that have it: y -= factor C q, div -= C^T u with the
/// velocities of all, q -= lambda C^T u with those of the fluid and walls at rest.
template <int D, class Backend>
void subtractGradientAlongWalls(Context<Backend>&, const MphPairs<D>& pairs, std::span<const double> q,
                                double factor, std::span<Vec<D>> y);
template <int D, class Backend>
void subtractDivergenceAlongWalls(Context<Backend>&, const MphPairs<D>& pairs, std::span<const Vec<D>> u,
                                  std::span<double> div);
template <int D, class Backend>
void subtractBulkStressAlongWalls(Context<Backend>&, const MphPairs<D>& pairs, std::span<const Vec<D>> u,
                                  std::span<double> q);

/// What the walls and the inertia put on a fluid particle's own velocity.
template <int D>
struct WallTerms {
  std::span<Block<D>> block;  // rho/dt I + sum over walls of the viscous pair blocks, per fluid particle
  // B times the sum over walls of -e w'^p [1/m], per fluid particle; may be empty on a device, where products take
  // it only for pairs without B.
  std::span<Vec<D>> gradient;
};
template <int D, class Backend>
void wallTerms(Context<Backend>&, const MphPairs<D>&, const WallTerms<D>&);

/// y_i += viscous force density of moving walls: sum over walls of the pair block times u_j, per fluid particle.
template <int D, class Backend>
void addWallDrag(Context<Backend>&, const MphPairs<D>&, std::span<const Vec<D>> u, std::span<Vec<D>> y);

}  // namespace treacle
