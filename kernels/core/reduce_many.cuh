#pragma once

#include "core/reduce.cuh"

namespace treacle {

/// Several sums at once, each in a fixed order. One thread per element, grid-stride: body(i, sums) adds what
/// element i adds to each of the N; finish(sums, lane) runs once at the end, in all lanes of one warp. One atomic
/// per block, for the count of blocks that are done. `partial`: N gridDim.x values.
template <int N, class Body, class Finish>
__global__ void __launch_bounds__(256)
    reduceManyKernel(std::size_t count, Body body, Finish finish, double* partial, unsigned* ticket) {
  waitForEarlierKernels();
  __shared__ double total[N];
  __shared__ bool last;
  double sums[N] = {};
  for (std::size_t i = blockIdx.x * 256ull + threadIdx.x; i < count; i += gridDim.x * 256ull) body(i, sums);
#pragma unroll
  for (int j = 0; j < N; ++j) {
    const double ofBlock = blockSum(sums[j]);
    if (threadIdx.x == 0) partial[j * gridDim.x + blockIdx.x] = ofBlock;
  }
  if (threadIdx.x == 0) {
    __threadfence();
    last = atomicAdd(ticket, 1u) == gridDim.x - 1;
  }
  __syncthreads();
  if (!last) return;
  // A warp adds up every eighth of the sums.
  const int lane = threadIdx.x % 32;
  for (int j = threadIdx.x / 32; j < N; j += 8) {
    double sum = 0;
    for (unsigned b = lane; b < gridDim.x; b += 32) sum += __ldcg(&partial[j * gridDim.x + b]);
    sum = warpSum(sum);
    if (lane == 0) total[j] = sum;
  }
  __syncthreads();
  if (threadIdx.x == 0) *ticket = 0;
  if (threadIdx.x < 32) finish(static_cast<const double*>(total), lane);
}

template <int N, class Body, class Finish>
void reduceManyOwn(Context<Cuda>& context, std::size_t count, Body body, Finish finish) {
  constexpr unsigned maxBlocks = std::min<unsigned>(132 * 4, Context<Cuda>::maxPartialSums / N);
  const unsigned blocks = std::min(std::max(blocksFor(count, 512), 1u), maxBlocks);
  launchEarly(context, blocks, 256, 0, reduceManyKernel<N, Body, Finish>, count, body, finish,
              context.partialSums(), context.ticket());
}

/// The sums are those over all processes that share the simulation.
template <int N, class Body, class Finish>
void reduceMany(Context<Cuda>& context, std::size_t count, Body body, Finish finish) {
  static_assert(N <= Context<Cuda>::maxJointSums);
  if (!context.link) return reduceManyOwn<N>(context, count, body, finish);
  double* joint = context.jointSums();
  reduceManyOwn<N>(context, count, body, [joint] __device__(const double* sums, int lane) {
    for (int j = lane; j < N; j += 32) joint[j] = sums[j];
  });
  context.link->sum(joint, N);
  forEach(context, 32, [joint, finish] __device__(std::size_t lane) { finish(joint, static_cast<int>(lane)); });
}

}  // namespace treacle
