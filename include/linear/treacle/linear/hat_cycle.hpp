#pragma once

#include "treacle/linear/chebyshev.hpp"
#include "treacle/linear/hat_nodes.hpp"

#include <cstdint>
#include <span>

namespace treacle {

/// What the smoother of a level reads and writes; B numbers per node, node after node, in the backend's memory. z
/// is read by neighbours while the next one is made, so there are two.
template <class T>
struct HatVectors {
  const T* inverseDiagonal;  // D^-1; zero: the unknown stays zero; null: the level has no smoother
  T *b, *res, *x;            // right-hand side, residual, iterate
  T* z[2];                   // last change of x
};

/// No eigenvalue of D^-1 A is larger, D being half the sums of the absolute values of A's rows.
inline constexpr int hatLambdaMax = 2;

// The operations that a V-cycle consists of; one kernel each. B numbers per node.

/// value = A in the cycle's precision, inverseDiagonal = 1 / A_ii, or 0 where A_ii, a number on the diagonal, is
/// not positive. Spans of a.value.size() and B a.rows(); an empty `value` is left alone.
template <class T, int B, class Backend>
void hatValues(Context<Backend>&, const BlockCsr<B, double, Backend>& a, std::span<Block<B, T>> value,
               std::span<T> inverseDiagonal);

/// y = A x; B a.rows numbers each.
template <class T, int B, class Backend>
void hatMultiply(Context<Backend>&, const BlockCsrView<B, T>& a, std::span<const T> x, std::span<T> y);

/// First smoothing step from zero: z[0] = x = gain / hatLambdaMax D^-1 b
template <class T, class Backend>
void hatFirstStep(Context<Backend>&, std::size_t unknowns, const HatVectors<T>& v);

/// res = from - A z[last] (`from` is b or res), then
/// z[1 - last] = previous z[last] + gain / hatLambdaMax D^-1 res and x += z[1 - last].
template <class T, int B, class Backend>
void hatStep(Context<Backend>&, const BlockCsrView<B, T>& a, ChebyshevStep<T> step, const HatVectors<T>& v,
             const T* from, int last);

/// res = from - A z[last]
template <class T, int B, class Backend>
void hatResidual(Context<Backend>&, const BlockCsrView<B, T>& a, const HatVectors<T>& v, const T* from, int last);

/// coarse.b = P^T res of own nodes, and there the first smoothing step unless the level has no smoother.
template <int D, int B, class T, class Backend>
void hatRestrict(Context<Backend>&, const HatNodes<D, Backend>& fine, const HatNodes<D, Backend>& coarse,
                 const T* res, const HatVectors<T>& coarseV);

/// z[0] = P e, x += z[0]
template <int D, int B, class T, class Backend>
void hatProlong(Context<Backend>&, const HatNodes<D, Backend>& fine, const HatNodes<D, Backend>& coarse,
                const T* e, const HatVectors<T>& v);

/// x = M b for a dense, exactly symmetric matrix.
template <class T, class Backend>
void denseMultiply(Context<Backend>&, std::uint32_t rows, const T* matrix, const T* b, T* x);

}  // namespace treacle
