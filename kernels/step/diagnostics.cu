#include "treacle/step/readings/diagnostics.hpp"

#include "core/launch.hpp"
#include "treacle/core/processes.hpp"

#include <cub/block/block_reduce.cuh>

#include <algorithm>
#include <functional>

namespace treacle {
namespace {

constexpr unsigned blockSize = 256, maxBlocks = 132 * 4;
constexpr std::size_t doubles = sizeof(Diagnostics) / sizeof(double);
static_assert(doubles * (maxBlocks + 1) <= Context<Cuda>::maxPartialSums);

struct Join {
  __device__ Diagnostics operator()(const Diagnostics& a, const Diagnostics& b) const { return joined(a, b); }
};

/// Past the first-level cache, which does not see what other blocks wrote.
__device__ Diagnostics loadShared(const Diagnostics* d) {
  Diagnostics copy;
  const auto* from = reinterpret_cast<const double*>(d);
  auto* to = reinterpret_cast<double*>(&copy);
  for (std::size_t k = 0; k < doubles; ++k) to[k] = __ldcg(from + k);
  return copy;
}

/// One thread per particle, grid-stride; reads position, velocity and material, writes one partial result per
/// block and, in the block that comes last, all of them joined behind these; one atomic per block, for the count
/// of blocks that are done. The order of the sums is fixed.
template <int D>
__global__ void __launch_bounds__(blockSize)
    diagnosticsKernel(const __grid_constant__ DiagnosticsInput<D> in,
                      const __grid_constant__ DiagnosticsTerm<D> term, Diagnostics* partial, unsigned* ticket) {
  using Reduce = cub::BlockReduce<Diagnostics, blockSize>;
  __shared__ typename Reduce::TempStorage temporary;
  __shared__ bool last;
  Diagnostics own = noDiagnostics();
  for (std::size_t i = blockIdx.x * std::size_t{blockSize} + threadIdx.x; i < in.position.size();
       i += gridDim.x * std::size_t{blockSize})
    own = joined(own, term(in, i));
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

template <int D, class Backend>
Diagnostics computeDiagnostics(Context<Backend>& context, const DiagnosticsInput<D>& in) {
  auto* partial = reinterpret_cast<Diagnostics*>(context.partialSums());
  const unsigned blocks = std::min(std::max(blocksFor(in.position.size(), 2 * blockSize), 1u), maxBlocks);
  launch(context, blocks, blockSize, 0, diagnosticsKernel<D>, in, DiagnosticsTerm<D>::make(in), partial,
         context.ticket());
  const Diagnostics all =
      joinedOverProcesses(context, valueOnHost(context, partial + blocks),
                          [](const Diagnostics& a, const Diagnostics& b) { return joined(a, b); });
  return averaged(all, joinedOverProcesses(context, in.position.size(), std::plus<>()), in.ownShare());
}

template Diagnostics computeDiagnostics(Context<Cuda>&, const DiagnosticsInput<2>&);
template Diagnostics computeDiagnostics(Context<Cuda>&, const DiagnosticsInput<3>&);

}  // namespace treacle
