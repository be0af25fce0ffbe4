#include "treacle/precondition/bucket_galerkin.hpp"

#include "core/launch.hpp"
#include "core/scan.hpp"
#include "precondition/galerkin_parts.cuh"
#include "precondition/restricted_columns.cuh"

namespace treacle {
namespace {

constexpr int warpsPerBlock = 4;

/// One warp per bucket; reads the ranges of the adjacent cells; writes their number to rowStart, or, with Fill,
/// their buckets. No atomics.
template <int D, bool Fill>
__global__ void __launch_bounds__(32 * warpsPerBlock)
    patternKernel(const __grid_constant__ MphPairs<D> pairs, const __grid_constant__ Galerkin<D> g) {
  const std::uint32_t b = blockIdx.x * warpsPerBlock + threadIdx.x / 32;
  if (b >= g.buckets) return;
  const int o = threadIdx.x % 32;
  const Vec<D, int> own = g.cellOf(pairs, b);
  const unsigned occupied = occupiedNeighbours(pairs.grid, g.ranges, own);
  if (!Fill && o == 0) g.rowStart[b] = __popc(occupied);
  if (Fill && (occupied >> o & 1)) {
    const AdjacentCell<D> cell(pairs.grid, own, adjacentOffset<D>(o));
    g.column[g.place(b, occupied, o)] = g.bucketOf[g.ranges.fluidBegin[cell.linear]];
  }
}

/// One warp per bucket and adjacent cell of the upper half; reads the particles around them; writes the block, and
/// its transpose in the other bucket's row. The viscous part of a block is added by the process that the bucket is
/// of. No atomics.
template <int D, class Mph>
__global__ void __launch_bounds__(32 * warpsPerBlock)
    offDiagonalKernel(const __grid_constant__ MphPairs<D> pairs, const __grid_constant__ Mph mph,
                      const __grid_constant__ Galerkin<D> g) {
  constexpr int self = Galerkin<D>::self;
  const std::uint64_t warp = blockIdx.x * std::uint64_t{warpsPerBlock} + threadIdx.x / 32;
  const auto b = static_cast<std::uint32_t>(warp / self);
  if (b >= g.buckets) return;
  const int o = self + 1 + static_cast<int>(warp % self);
  const Vec<D, int> own = g.cellOf(pairs, b), offset = adjacentOffset<D>(o);
  const AdjacentCell<D> adjacent(pairs.grid, own, offset);
  if (!adjacent.occupied(g.ranges)) return;

  const std::uint32_t firstJ = g.ranges.fluidBegin[adjacent.linear], lastJ = g.ranges.fluidEnd[adjacent.linear];
  Block<D> viscous{};
  if (g.isOwn(b))
    viscous = sumOfLanes(viscousPart(pairs, mph, g.begin[b], g.begin[b + 1], firstJ, lastJ, adjacent.shift));
  const Block<D> pressure = sumOfLanes(pressurePart(pairs, g, own, offset));

  const std::uint64_t here = g.place(b, occupiedNeighbours(pairs.grid, g.ranges, own), o);
  const std::uint64_t there = g.place(g.bucketOf[firstJ], occupiedNeighbours(pairs.grid, g.ranges, adjacent.cell),
                                      Galerkin<D>::neighbours - 1 - o);
  if (threadIdx.x % 32 != 0) return;
  for (int r = 0; r < D; ++r)
    for (int c = 0; c < D; ++c) {
      const double value = pressure(r, c) - viscous(r, c);
      g.block[here](r, c) = value;
      g.block[there](c, r) = value;
      g.cross[here](r, c) = g.cross[there](r, c) = viscous(r, c);
    }
}

/// One warp per bucket; reads the particles around it, its particles' own blocks and the viscous parts of its row;
/// writes the diagonal block. Viscous pairs within the bucket cancel in the sum. No atomics.
template <int D>
__global__ void __launch_bounds__(32 * warpsPerBlock)
    diagonalKernel(const __grid_constant__ MphPairs<D> pairs, const __grid_constant__ Galerkin<D> g) {
  const std::uint32_t b = blockIdx.x * warpsPerBlock + threadIdx.x / 32;
  if (b >= g.buckets) return;
  const std::uint32_t lane = threadIdx.x % 32;
  const Vec<D, int> own = g.cellOf(pairs, b);
  const std::uint64_t here = g.place(b, occupiedNeighbours(pairs.grid, g.ranges, own), Galerkin<D>::self);
  Block<D> sum = pressurePart(pairs, g, own, Vec<D, int>{});
  if (g.isOwn(b))
    for (std::uint32_t i = g.begin[b] + lane; i < g.begin[b + 1]; i += 32) sum += g.ownBlock[i];
  const std::uint64_t k = g.rowStart[b] + lane;
  if (k < g.rowStart[b + 1] && k != here) sum += g.cross[k];
  sum = sumOfLanes(sum);
  if (lane == 0) g.block[here] = sum;
}

}  // namespace

template <int D>
void bucketGalerkin(Context<Cuda>& context, const MphPairs<D>& pairs, const CellRanges<Cuda>& ranges,
                    const BucketLevels<Cuda>& levels, const WallTerms<D>& terms, Buffer<Vec<D>, Cuda>& columns,
                    BlockCsr<D, double, Cuda>& a0) {
  restrictedColumns(context, pairs, columns);
  Buffer<std::uint8_t, Cuda> lower(context, pairs.activeCount);
  forEach(context, pairs.activeCount,
          [grid = pairs.grid, x = pairs.position.data(), bits = lower.data()] __device__(std::size_t k) {
            const Vec<D, int> below = lowerCell(grid, x[k], grid.cellOf(x[k]));
            unsigned code = 0;
            for (int c = 0; c < D; ++c) code |= (below[c] < 0 ? 1u : 0u) << c;
            bits[k] = static_cast<std::uint8_t>(code);
          });

  const std::uint32_t rows = levels.count(0);
  a0.rowStart.resize(context, std::size_t{rows} + 1);
  Galerkin<D> g{.ranges = viewOf(ranges),
                .own = pairs.ownRanges(),
                .buckets = rows,
                .begin = levels.begin[0].data(),
                .bucketOf = levels.bucketOf.data(),
                .columns = columns.data(),
                .lower = lower.data(),
                .ownBlock = terms.block.data(),
                .rowStart = a0.rowStart.data(),
                .column = nullptr,
                .block = nullptr,
                .cross = nullptr};
  const unsigned blocks = blocksFor(rows, warpsPerBlock), threads = 32 * warpsPerBlock;
  launch(context, blocks, threads, 0, patternKernel<D, false>, pairs, g);
  const std::uint64_t entries = startRows(context, a0.rowStart);
  a0.column.resize(context, entries);
  a0.value.resize(context, entries);
  Buffer<Block<D>, Cuda> cross(context, entries);
  g.column = a0.column.data();
  g.block = a0.value.data();
  g.cross = cross.data();
  launch(context, blocks, threads, 0, patternKernel<D, true>, pairs, g);
  withScheme(pairs.terms, [&]<class Mph>(const Mph& mph) {
    launch(context, blocksFor(std::size_t{rows} * Galerkin<D>::self, warpsPerBlock), threads, 0,
           offDiagonalKernel<D, Mph>, pairs, mph, g);
  });
  launch(context, blocks, threads, 0, diagonalKernel<D>, pairs, g);
}

#define TREACLE_INSTANTIATE(D)                                                                           \
  template void bucketGalerkin<D>(Context<Cuda>&, const MphPairs<D>&, const CellRanges<Cuda>&,           \
                                  const BucketLevels<Cuda>&, const WallTerms<D>&, Buffer<Vec<D>, Cuda>&, \
                                  BlockCsr<D, double, Cuda>&);
TREACLE_INSTANTIATE(2)
TREACLE_INSTANTIATE(3)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
