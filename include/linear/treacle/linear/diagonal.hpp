#pragma once

#include "treacle/core/backend.hpp"
#include "treacle/core/block.hpp"

#include <span>

namespace treacle {

/// z = K r for the preconditioners without coupling between particles. T is the precision of K; r and z stay
/// double. Spans of one element per unknown particle.

/// K = diag(inverse)
template <int D, class T, class Backend>
void applyDiagonal(Context<Backend>&, std::span<const Vec<D, T>> inverse, std::span<const Vec<D>> r,
                   std::span<Vec<D>> z);

/// K = block diagonal
template <int D, class T, class Backend>
void applyBlockDiagonal(Context<Backend>&, std::span<const Block<D, T>> inverse, std::span<const Vec<D>> r,
                        std::span<Vec<D>> z);

/// 1 / A_ii of the diagonal blocks.
template <int D, class T, class Backend>
void jacobiInverse(Context<Backend>&, std::span<const Block<D>> diagonal, std::span<Vec<D, T>> inverse);

/// Inverses of the diagonal blocks.
template <int D, class T, class Backend>
void blockInverse(Context<Backend>&, std::span<const Block<D>> diagonal, std::span<Block<D, T>> inverse);

}  // namespace treacle
