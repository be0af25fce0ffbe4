#pragma once

#include "treacle/linear/block_csr.hpp"
#include "treacle/mph/mph_sums.hpp"

#include <algorithm>
#include <span>

namespace treacle {

/// Square of the distance up to which V and C Lambda C^T couple particles [m2].
template <int D>
double couplingRadius2(const MphPairs<D>& pairs) {
  const double r = std::max(pairs.terms.viscosityRadius, 2 * pairs.terms.pressureRadius);
  return r * r * (1 + 1e-12);
}

/// Per particle its neighbours within h_p, with g = -e w'^p [1/m] seen from the row's particle, without B of the
/// pairs. With it they are the rows of C: C_ij = B_j g_ij, C_ii = B_i sum_j g_ij, and C_ji = -B_i g_ij.
template <int D, class Backend = Cpu>
using GradientRows = Csr<Vec<D>, Backend>;

template <int D>
void gradientRows(Context<Cpu>&, const MphPairs<D>&, GradientRows<D>& rows);
template <int D>
void gradientRows(Context<Cuda>&, const MphPairs<D>&, GradientRows<D, Cuda>& rows);

/// A = rho/dt I + V + C Lambda C^T over the fluid particles, walls at rest [K23 eq. (16)].
template <int D>
void assemble(Context<Cpu>&, const MphPairs<D>&, const WallTerms<D>&, const GradientRows<D>&, BlockCsr<D>& a);
template <int D>
void assemble(Context<Cuda>&, const MphPairs<D>&, const WallTerms<D>&, const GradientRows<D, Cuda>&,
              BlockCsr<D, double, Cuda>& a);

/// The diagonal blocks of A, per fluid particle.
template <int D>
void diagonalBlocks(Context<Cpu>&, const MphPairs<D>&, const WallTerms<D>&, std::span<Block<D>> diagonal);
template <int D>
void diagonalBlocks(Context<Cuda>&, const MphPairs<D>&, const WallTerms<D>&, std::span<Block<D>> diagonal);

}  // namespace treacle
