#pragma once

#include "core/reduce.cuh"

namespace treacle {

/// One warp per row: x = M b. No atomics.
template <class T>
__global__ void denseKernel(int unknowns, const T* matrix, const T* b, T* x) {
  const int row = (blockIdx.x * blockDim.x + threadIdx.x) / 32;
  if (row >= unknowns) return;
  T sum = 0;
  const T* mine = matrix + static_cast<std::size_t>(row) * unknowns;
#pragma unroll 8
  for (int k = threadIdx.x % 32; k < unknowns; k += 32) sum += mine[k] * b[k];
  sum = warpSum(sum);
  if (threadIdx.x % 32 == 0) x[row] = sum;
}

}  // namespace treacle
