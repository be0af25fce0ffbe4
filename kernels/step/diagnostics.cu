#include "treacle/step/diagnostics.hpp"

#include "core/launch.hpp"

#include <cub/block/block_reduce.cuh>

#include <algorithm>

namespace treacle {
namespace {

constexpr unsigned blockSize = 256, maxBlocks = 132 * 8;
constexpr std::size_t doubles = sizeof(Diagnostics) / sizeof(double);
static_assert(doubles * (maxBlocks + 1) <= Context<Cuda>::maxPartialSums);

struct Join {
  __device__ Diagnostics operator()(const Diagnostics& a, const Diagnostics& b) const { return joined(a, b); }
};

/// Past the first-level cache, which does not see what other blocks wrote.
__device__ Diagnostics loadShared(const Diagnostics* d) {
  return {__ldcg(&d->kineticEnergy), __ldcg(&d->potentialEnergy), __ldcg(&d->frontX), __ldcg(&d->top),
          __ldcg(&d->maxSpeed)};
}

/// One thread per particle, grid-stride; reads position, velocity and material, writes one partial result per
/// block and, in the block that comes last, all of them joined behind these; one atomic per block, for the count
/// of blocks that are done. The order of the sums is fixed.
template <int D>
__global__ void __launch_bounds__(blockSize)
    diagnosticsKernel(std::span<const Vec<D>> x, std::span<const Vec<D>> u, std::span<const std::uint8_t> material,
                      DiagnosticsTerm<D> term, Diagnostics* partial, unsigned* ticket) {
  using Reduce = cub::BlockReduce<Diagnostics, blockSize>;
  __shared__ typename Reduce::TempStorage temporary;
  __shared__ bool last;
  Diagnostics own = noDiagnostics();
  for (std::size_t i = blockIdx.x * std::size_t{blockSize} + threadIdx.x; i < x.size();
       i += gridDim.x * std::size_t{blockSize})
    own = joined(own, term(x[i], u[i], material[i]));
  own = Reduce(temporary).Reduce(own, Join{});
  if (threadIdx.x == 0) {
    partial[blockIdx.x] = own;
    __threadfence();
    last = atomicAdd(ticket, 1u) == gridDim.x - 1;
  }
  __syncthreads();
  if (!last) return;

  own = noDiagnostics();
  for (unsigned b = threadIdx.x; b < gridDim.x; b += blockSize) own = joined(own, loadShared(&partial[b]));
  own = Reduce(temporary).Reduce(own, Join{});
  if (threadIdx.x == 0) {
    partial[gridDim.x] = own;
    *ticket = 0;
  }
}

}  // namespace

template <int D>
Diagnostics computeDiagnostics(Context<Cuda>& context, const DiagnosticsInput<D>& in) {
  auto* partial = reinterpret_cast<Diagnostics*>(context.partialSums());
  const unsigned blocks = std::min(std::max(blocksFor(in.position.size(), 2 * blockSize), 1u), maxBlocks);
  launch(context, blocks, blockSize, 0, diagnosticsKernel<D>, in.position, in.velocity, in.material,
         DiagnosticsTerm<D>::make(in), partial, context.ticket());
  return valueOnHost(context, partial + blocks);
}

template Diagnostics computeDiagnostics<2>(Context<Cuda>&, const DiagnosticsInput<2>&);
template Diagnostics computeDiagnostics<3>(Context<Cuda>&, const DiagnosticsInput<3>&);

}  // namespace treacle
