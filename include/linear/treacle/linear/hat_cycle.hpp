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
template <class T, int B>
void hatValues(Context<Cpu>&, const BlockCsr<B>& a, std::span<Block<B, T>> value, std::span<T> inverseDiagonal);
template <class T, int B>
void hatValues(Context<Cuda>&, const BlockCsr<B, double, Cuda>& a, std::span<Block<B, T>> value,
               std::span<T> inverseDiagonal);

/// y = A x; B a.rows numbers each.
template <class T, int B>
void hatMultiply(Context<Cpu>&, const BlockCsrView<B, T>& a, std::span<const T> x, std::span<T> y);
template <class T, int B>
void hatMultiply(Context<Cuda>&, const BlockCsrView<B, T>& a, std::span<const T> x, std::span<T> y);

/// First smoothing step from zero: z[0] = x = gain / hatLambdaMax D^-1 b
template <class T>
void hatFirstStep(Context<Cpu>&, std::size_t unknowns, const HatVectors<T>& v);
template <class T>
void hatFirstStep(Context<Cuda>&, std::size_t unknowns, const HatVectors<T>& v);

/// res = from - A z[last] (`from` is b or res), then
/// z[1 - last] = previous z[last] + gain / hatLambdaMax D^-1 res and x += z[1 - last].
template <class T, int B>
void hatStep(Context<Cpu>&, const BlockCsrView<B, T>& a, ChebyshevStep<T> step, const HatVectors<T>& v,
             const T* from, int last);
template <class T, int B>
void hatStep(Context<Cuda>&, const BlockCsrView<B, T>& a, ChebyshevStep<T> step, const HatVectors<T>& v,
             const T* from, int last);

/// res = from - A z[last]
template <class T, int B>
void hatResidual(Context<Cpu>&, const BlockCsrView<B, T>& a, const HatVectors<T>& v, const T* from, int last);
template <class T, int B>
void hatResidual(Context<Cuda>&, const BlockCsrView<B, T>& a, const HatVectors<T>& v, const T* from, int last);

/// coarse.b = P^T res of own nodes, and there the first smoothing step unless the level has no smoother.
template <int D, int B, class T>
void hatRestrict(Context<Cpu>&, const HatNodes<D>& fine, const HatNodes<D>& coarse, const T* res,
                 const HatVectors<T>& coarseV);
template <int D, int B, class T>
void hatRestrict(Context<Cuda>&, const HatNodes<D, Cuda>& fine, const HatNodes<D, Cuda>& coarse, const T* res,
                 const HatVectors<T>& coarseV);

/// z[0] = P e, x += z[0]
template <int D, int B, class T>
void hatProlong(Context<Cpu>&, const HatNodes<D>& fine, const HatNodes<D>& coarse, const T* e,
                const HatVectors<T>& v);
template <int D, int B, class T>
void hatProlong(Context<Cuda>&, const HatNodes<D, Cuda>& fine, const HatNodes<D, Cuda>& coarse, const T* e,
                const HatVectors<T>& v);

/// x = M b for a dense, exactly symmetric matrix.
template <class T>
void denseMultiply(Context<Cpu>&, std::uint32_t rows, const T* matrix, const T* b, T* x);
template <class T>
void denseMultiply(Context<Cuda>&, std::uint32_t rows, const T* matrix, const T* b, T* x);

}  // namespace treacle
