#pragma once

#include "treacle/linear/block_csr.hpp"

#include <span>

namespace treacle {

/// Inverse of a small symmetric positive definite matrix of n = B a.rows() unknowns, block after block: n x n
/// numbers, row-major, exactly symmetric. Reads the lower triangle. Computed in double precision with an addition
/// to the diagonal (regularisation), which makes semidefinite matrices invertible; unknowns where a pivot still is
/// not positive get zeros.
template <class T, int B>
void denseInverse(Context<Cpu>&, const BlockCsr<B>& a, std::span<T> inverse);
template <class T, int B>
void denseInverse(Context<Cuda>&, const BlockCsr<B, double, Cuda>& a, std::span<T> inverse);

/// What is added to a diagonal element. Coarse operators of bodies with rough edges are singular, and there the
/// inverse becomes 1 / relative; rounded to T, its errors must stay small beside the inverse of everything else.
template <class T>
TREACLE_HD constexpr double regularisation(double diagonal, double largest) {
  constexpr double relative = sizeof(T) == sizeof(double) ? 1e-10 : 1e-5;
  return relative * (diagonal > 1e-6 * largest ? diagonal : 1e-6 * largest);
}

}  // namespace treacle
