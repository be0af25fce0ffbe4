#pragma once

#include "core/launch.hpp"
#include "treacle/mph/mph_pairs.hpp"

#include <cstdint>
#include <span>

namespace treacle {

/// One thread per element: to[i] = formula(pairs, i). The pairs are too large for a copy in every thread. No
/// atomics.
template <int D, class T, class Formula>
__global__ void fillKernel(const __grid_constant__ MphPairs<D> pairs, std::span<T> to, const Formula formula) {
  const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
  if (i < to.size()) to[i] = formula(pairs, i);
}
template <int D, class T, class Formula>
void fill(const Context<Cuda>& context, const MphPairs<D>& pairs, std::span<T> to, const Formula& formula) {
  launch(context, blocksFor(to.size(), 256), 256, 0, fillKernel<D, T, Formula>, pairs, to, formula);
}

}  // namespace treacle
