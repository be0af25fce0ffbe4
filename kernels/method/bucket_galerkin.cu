#include "treacle/method/bucket_galerkin.hpp"

#include "core/reduce.cuh"
#include "core/scan.cuh"
#include "method/restricted_columns.cuh"

namespace treacle {
namespace {

constexpr int warpsPerBlock = 4;

/// What the kernels read besides the pairs, and what they write.
template <int D>
struct Galerkin {
  static constexpr int neighbours = power<D>(3), self = neighbours / 2;

  CellRangesView ranges;
  std::uint32_t buckets;
  const std::uint32_t* begin;     // first particle of every bucket, and the end
  const std::uint32_t* bucketOf;  // per particle
  const Vec<D>* columns;          // 2^D per particle
  const std::uint8_t* lower;      // per particle: bit k: the lower cell of axis k is the one below its own
  const Block<D>* ownBlock;       // inertia and walls per fluid particle
  std::uint64_t* rowStart;
  std::uint32_t* column;
  Block<D>* block;
  Block<D>* cross;  // beside every block: its part of V, with the sign of the diagonal

  __device__ Vec<D, int> cellOf(const MphPairs<D>& pairs, std::uint32_t bucket) const {
    return pairs.grid.cellOf(pairs.position[begin[bucket]]);
  }
  /// Place of neighbour o in a row whose occupied neighbours are given.
  __device__ std::uint64_t place(std::uint32_t bucket, unsigned occupied, int o) const {
    return rowStart[bucket] + __popc(occupied & ((1u << o) - 1));
  }
};

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

/// sum += lambda_k (R C)_{Ik} (R C)_{Jk}^T over the particles k of [first, last), which the lanes take in turns. I
/// is the cell from which offsets count, J stands at `other`, the particles' cell at `at`.
template <int D>
__device__ void addColumns(const MphPairs<D>& pairs, const Galerkin<D>& g, std::uint32_t first, std::uint32_t last,
                           const Vec<D, int>& at, const Vec<D, int>& other, Block<D>& sum) {
  for (std::uint32_t k = first + threadIdx.x % 32; k < last; k += 32) {
    const unsigned below = g.lower[k];
    Vec<D, int> lower = at;
    for (int c = 0; c < D; ++c) lower[c] -= below >> c & 1;
    const int slotI = columnSlot<D>(-lower), slotJ = columnSlot<D>(other - lower);
    if (slotI < 0 || slotJ < 0) continue;
    const Vec<D>* column = g.columns + std::size_t{power<D>(2)} * k;
    sum.addOuter(pairs.materials.bulkViscosity[pairs.material[k]], column[slotI], column[slotJ]);
  }
}

/// A lane's part of (R C Lambda C^T P)_{IJ}: over the cells that are adjacent to both.
template <int D>
__device__ Block<D> pressurePart(const MphPairs<D>& pairs, const Galerkin<D>& g, const Vec<D, int>& own,
                                 const Vec<D, int>& other) {
  Block<D> sum{};
  for (int o = 0; o < Galerkin<D>::neighbours; ++o) {
    const Vec<D, int> at = adjacentOffset<D>(o);
    bool adjacent = true;
    for (int c = 0; c < D; ++c) adjacent = adjacent && abs(at[c] - other[c]) <= 1;
    if (!adjacent) continue;
    const AdjacentCell<D> cell(pairs.grid, own, at);
    if (!cell.inside) continue;
    addColumns(pairs, g, g.ranges.fluidBegin[cell.linear], g.ranges.fluidEnd[cell.linear], at, other, sum);
    addColumns(pairs, g, g.ranges.wallBegin[cell.linear], g.ranges.wallEnd[cell.linear], at, other, sum);
  }
  return sum;
}

/// A lane's part of the viscous pair blocks between the particles of a bucket and those of an adjacent cell: eight
/// lanes side by side take a neighbour each, the four groups of them the bucket's particles in turns.
template <int D>
__device__ Block<D> viscousPart(const MphPairs<D>& pairs, std::uint32_t firstI, std::uint32_t lastI,
                                std::uint32_t firstJ, std::uint32_t lastJ, const Vec<D>& shift) {
  const int lane = threadIdx.x % 32;
  const double h2 = pairs.viscosityWeight.radius * pairs.viscosityWeight.radius;
  Block<D> sum{};
  for (std::uint32_t j = firstJ + lane % 8; j < lastJ; j += 8) {
    const Vec<D> xj = pairs.position[j] + shift;
    const int material = pairs.material[j];
    for (std::uint32_t i = firstI + lane / 8; i < lastI; i += 4) {
      const Vec<D> d = xj - pairs.position[i];
      const double r2 = norm2(d);
      if (r2 >= h2 || r2 == 0) continue;
      const double inverseR = rsqrt(r2);
      const double f = pairs.materials.pairViscosity[pairs.material[i]][material] *
                       (inverseR - pairs.viscosity.inverseRadius) * (inverseR * inverseR);
      for (int r = 0; r < D; ++r)
        for (int c = r; c < D; ++c) sum(r, c) = fma(f * d[r], d[c], sum(r, c));
    }
  }
  for (int r = 0; r < D; ++r)
    for (int c = r; c < D; ++c) sum(c, r) = sum(r, c) *= pairs.viscosity.factor;
  return sum;
}

/// Sum over the lanes, in all of them.
template <int D>
__device__ Block<D> sumOfLanes(Block<D> m) {
  for (int e = 0; e < D * D; ++e) m.a[e] = warpSum(m.a[e]);
  return m;
}

/// One warp per bucket and adjacent cell of the upper half; reads the particles around them; writes the block, and
/// its transpose in the other bucket's row. No atomics.
template <int D>
__global__ void __launch_bounds__(32 * warpsPerBlock)
    offDiagonalKernel(const __grid_constant__ MphPairs<D> pairs, const __grid_constant__ Galerkin<D> g) {
  constexpr int self = Galerkin<D>::self;
  const std::uint64_t warp = blockIdx.x * std::uint64_t{warpsPerBlock} + threadIdx.x / 32;
  const auto b = static_cast<std::uint32_t>(warp / self);
  if (b >= g.buckets) return;
  const int o = self + 1 + static_cast<int>(warp % self);
  const Vec<D, int> own = g.cellOf(pairs, b), offset = adjacentOffset<D>(o);
  const AdjacentCell<D> adjacent(pairs.grid, own, offset);
  if (!adjacent.occupied(g.ranges)) return;

  const std::uint32_t firstJ = g.ranges.fluidBegin[adjacent.linear], lastJ = g.ranges.fluidEnd[adjacent.linear];
  const Block<D> viscous =
      sumOfLanes(viscousPart(pairs, g.begin[b], g.begin[b + 1], firstJ, lastJ, adjacent.shift));
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
  a0.block.resize(context, entries);
  Buffer<Block<D>, Cuda> cross(context, entries);
  g.column = a0.column.data();
  g.block = a0.block.data();
  g.cross = cross.data();
  launch(context, blocks, threads, 0, patternKernel<D, true>, pairs, g);
  launch(context, blocksFor(std::size_t{rows} * Galerkin<D>::self, warpsPerBlock), threads, 0,
         offDiagonalKernel<D>, pairs, g);
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
