#pragma once

#include "core/launch.hpp"
#include "treacle/core/device_link.hpp"

namespace treacle {

/// Sum over the lanes of a warp, in every lane; the order is fixed.
template <class T>
__device__ inline T warpSum(T value) {
  for (int offset = 16; offset > 0; offset /= 2) value += __shfl_xor_sync(~0u, value, offset);
  return value;
}

/// Sum over a block of at most 1024 threads (a multiple of 32), in thread 0.
__device__ inline double blockSum(double value) {
  __shared__ double ofWarp[32];
  value = warpSum(value);
  __syncthreads();
  if (threadIdx.x % 32 == 0) ofWarp[threadIdx.x / 32] = value;
  __syncthreads();
  if (threadIdx.x < 32) value = warpSum(threadIdx.x < blockDim.x / 32 ? ofWarp[threadIdx.x] : 0.0);
  return value;
}

/// Adds up one value per block and calls finish(sum) once, in one thread of the block that comes last. Which block
/// that is may differ from run to run, the order of the sum does not. `partial`: gridDim.x values; `ticket`: zero
/// before and after.
template <class Finish>
__device__ void finishReduction(double blockValue, double* partial, unsigned* ticket, Finish&& finish) {
  __shared__ bool last;
  if (threadIdx.x == 0) {
    partial[blockIdx.x] = blockValue;
    __threadfence();
    last = atomicAdd(ticket, 1u) == gridDim.x - 1;
  }
  __syncthreads();
  if (!last) return;
  double sum = 0;
  for (unsigned b = threadIdx.x; b < gridDim.x; b += blockDim.x) sum += __ldcg(&partial[b]);
  sum = blockSum(sum);
  if (threadIdx.x == 0) {
    *ticket = 0;
    finish(sum);
  }
}

/// One thread per element, grid-stride: body(i) returns what element i adds; finish(sum) runs once at the end.
/// One atomic per block, for the count of blocks that are done.
template <class Body, class Finish>
__global__ void __launch_bounds__(256)
    reduceKernel(std::size_t count, Body body, Finish finish, double* partial, unsigned* ticket) {
  waitForEarlierKernels();
  double sum = 0;
  for (std::size_t i = blockIdx.x * 256ull + threadIdx.x; i < count; i += gridDim.x * 256ull) sum += body(i);
  finishReduction(blockSum(sum), partial, ticket, finish);
}

template <class Body, class Finish>
void reduceOwn(Context<Cuda>& context, std::size_t count, Body body, Finish finish) {
  constexpr unsigned maxBlocks = 132 * 8;
  const unsigned blocks = std::min(std::max(blocksFor(count, 512), 1u), maxBlocks);
  launchEarly(context, blocks, 256, 0, reduceKernel<Body, Finish>, count, body, finish, context.partialSums(),
              context.ticket());
}

/// The sum is that over all processes that share the simulation.
template <class Body, class Finish>
void reduce(Context<Cuda>& context, std::size_t count, Body body, Finish finish) {
  if (!context.link) return reduceOwn(context, count, body, finish);
  double* joint = context.jointSums();
  reduceOwn(context, count, body, [joint] __device__(double sum) { *joint = sum; });
  context.link->sum(joint, 1);
  forEach(context, 1, [joint, finish] __device__(std::size_t) { finish(*joint); });
}

}  // namespace treacle
