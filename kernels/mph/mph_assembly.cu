#include "treacle/mph/mph_assembly.hpp"

#include "core/launch.hpp"
#include "core/scan.hpp"
#include "mph/row_assembler.cuh"

namespace treacle {
namespace {

constexpr int warpsPerBlock = 4;

/// One warp per fluid particle; reads the fluid entries of its cluster's list and positions; writes the number of
/// those within the coupling radius to rowStart[i], or, with Fill, their indices. No atomics.
template <int D, bool Fill>
__global__ void __launch_bounds__(32 * warpsPerBlock)
    patternKernel(const __grid_constant__ MphPairs<D> pairs, double radius2, std::uint64_t* rowStart,
                  std::uint32_t* column) {
  const std::uint32_t i = blockIdx.x * warpsPerBlock + threadIdx.x / 32;
  if (i >= pairs.fluidCount) return;
  const unsigned lane = threadIdx.x % 32;
  const ClusterListView& list = pairs.fluidList;
  const std::uint32_t cluster = (i - list.first) / clusterSize;
  const std::uint64_t* offset = list.offset + std::size_t{listSegments} * cluster;
  const std::uint64_t end = offset[static_cast<int>(ListSegment::FarFluid) + 1];
  std::uint64_t next = Fill ? rowStart[i] : 0;
  for (std::uint64_t first = offset[static_cast<int>(ListSegment::NearFluid)]; first < end; first += 32) {
    bool couples = false;
    std::uint32_t j = 0;
    if (first + lane < end) {
      j = list.entry[first + lane];
      couples = norm2(pairs.difference(i, j)) <= radius2;
    }
    const unsigned hits = __ballot_sync(~0u, couples);
    if (Fill && couples) column[next + __popc(hits & ((1u << lane) - 1))] = j;
    next += __popc(hits);
  }
  if (!Fill && lane == 0) rowStart[i] = next;
}

/// One warp per fluid particle; reads positions, its row of C and the pattern; writes its row's blocks. No
/// atomics.
template <int D, class Mph, bool Renormalised>
__global__ void __launch_bounds__(32 * warpsPerBlock)
    blocksKernel(const __grid_constant__ MphPairs<D> pairs, const __grid_constant__ Mph mph,
                 const __grid_constant__ Assembly<D> a) {
  using Assembler = RowAssembler<D, Mph, Renormalised>;
  __shared__ typename Assembler::Scratch scratch[warpsPerBlock];
  const std::uint32_t i = blockIdx.x * warpsPerBlock + threadIdx.x / 32;
  if (i < pairs.fluidCount) Assembler(pairs, mph, a, i, scratch[threadIdx.x / 32]).run();
}

}  // namespace

template <int D>
void assemble(Context<Cuda>& context, const MphPairs<D>& pairs, const WallTerms<D>& terms,
              const GradientRows<D, Cuda>& rows, BlockCsr<D, double, Cuda>& a) {
  const std::uint32_t n = pairs.fluidCount;
  const unsigned blocks = blocksFor(n, warpsPerBlock), threads = 32 * warpsPerBlock;
  const double radius2 = couplingRadius2(pairs);
  a.rowStart.resize(context, std::size_t{n} + 1);
  std::uint32_t* none = nullptr;
  launch(context, blocks, threads, 0, patternKernel<D, false>, pairs, radius2, a.rowStart.data(), none);
  const std::uint64_t entries = startRows(context, a.rowStart);
  a.column.resize(context, entries);
  a.value.resize(context, entries);
  launch(context, blocks, threads, 0, patternKernel<D, true>, pairs, radius2, a.rowStart.data(), a.column.data());

  Buffer<Vec<D>, Cuda> own(context, n);
  forEach(context, n,
          [start = rows.rowStart.data(), g = rows.value.data(), sums = own.data()] __device__(std::size_t i) {
            Vec<D> sum{};
            for (std::uint64_t m = start[i]; m < start[i + 1]; ++m) sum += g[m];
            sums[i] = sum;
          });
  const Assembly<D> assembly{rows.rowStart.data(), rows.column.data(), rows.value.data(), own.data(),
                             terms.block.data(),   a.rowStart.data(),  a.column.data(),   a.value.data()};
  withSchemeTerms(pairs, [&]<class Mph>(const Mph& mph, auto renormalised) {
    launch(context, blocks, threads, 0, blocksKernel<D, Mph, decltype(renormalised)::value>, pairs, mph, assembly);
  });
}

#define TREACLE_INSTANTIATE(D)                                                       \
  template void assemble<D>(Context<Cuda>&, const MphPairs<D>&, const WallTerms<D>&, \
                            const GradientRows<D, Cuda>&, BlockCsr<D, double, Cuda>&);
TREACLE_INSTANTIATE(2)
TREACLE_INSTANTIATE(3)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
