#include "core/launch.hpp"
#include "core/scan.hpp"
#include "treacle/mph/mph_assembly.hpp"
#include "treacle/mph/mph_neighbours.hpp"

namespace treacle {
namespace {

/// One thread per active particle; reads its cluster's list and positions; writes the number of its neighbours to
/// rowStart[i]. No atomics.
template <int D>
__global__ void countKernel(const __grid_constant__ MphPairs<D> pairs, std::uint64_t* rowStart) {
  const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
  if (i >= pairs.activeCount) return;
  std::uint32_t count = 0;
  forEachNear(pairs, i, [&](std::uint32_t, const Vec<D>&, const Vec<D>&) { ++count; });
  rowStart[i] = count;
}

/// One thread per active particle; reads its cluster's list and positions; writes its row. No atomics.
template <int D>
__global__ void fillKernel(const __grid_constant__ MphPairs<D> pairs, const std::uint64_t* rowStart,
                           std::uint32_t* neighbour, Vec<D>* g) {
  const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
  if (i >= pairs.activeCount) return;
  std::uint64_t next = rowStart[i];
  forEachNear(pairs, i, [&](std::uint32_t j, const Vec<D>&, const Vec<D>& gij) {
    neighbour[next] = j;
    g[next++] = gij;
  });
}

}  // namespace

template <int D>
void gradientRows(Context<Cuda>& context, const MphPairs<D>& pairs, GradientRows<D, Cuda>& rows) {
  constexpr unsigned threads = 128;
  const unsigned blocks = blocksFor(pairs.activeCount, threads);
  rows.rowStart.resize(context, std::size_t{pairs.activeCount} + 1);
  launch(context, blocks, threads, 0, countKernel<D>, pairs, rows.rowStart.data());
  const std::uint64_t entries = startRows(context, rows.rowStart);
  rows.column.resize(context, entries);
  rows.value.resize(context, entries);
  launch(context, blocks, threads, 0, fillKernel<D>, pairs, rows.rowStart.data(), rows.column.data(),
         rows.value.data());
}

template void gradientRows<2>(Context<Cuda>&, const MphPairs<2>&, GradientRows<2, Cuda>&);
template void gradientRows<3>(Context<Cuda>&, const MphPairs<3>&, GradientRows<3, Cuda>&);

}  // namespace treacle
