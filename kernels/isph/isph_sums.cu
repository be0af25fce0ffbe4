#include "treacle/isph/isph_sums.hpp"

#include "core/launch.hpp"
#include "core/scan.hpp"

#include <type_traits>

namespace treacle {
namespace {

/// Lanes that share a particle's neighbours.
constexpr int rowLanes = 8;
constexpr std::uint32_t noColumn = ~0u;

template <int Values>
__device__ inline void sumOverLanes(double* sum) {
  for (int n = 0; n < Values; ++n)
    for (int s = rowLanes / 2; s > 0; s /= 2) sum[n] += __shfl_xor_sync(~0u, sum[n], s);
}

/// visit(j, d, r) for this lane's share of a row; the positions of four neighbours are on their way at a time.
template <int D, class Visit>
__device__ inline void visitRow(const IsphPairs<D>& pairs, const NeighbourRowsView& rows, std::uint32_t row,
                                const Vec<D>& x, Visit&& visit) {
  constexpr int chunk = 4;
  for (const std::uint64_t section : {std::uint64_t{row}, std::uint64_t{rows.count} + row}) {
    const std::uint64_t begin = rows.start[section];
    const auto count = static_cast<std::uint32_t>(rows.start[section + 1] - begin);
    for (std::uint32_t first = threadIdx.x % rowLanes; first < count; first += chunk * rowLanes) {
      std::uint32_t column[chunk];
      Vec<D> other[chunk];
#pragma unroll
      for (int c = 0; c < chunk; ++c)
        column[c] = first + c * rowLanes < count ? __ldcs(rows.column + begin + first + c * rowLanes) : noColumn;
#pragma unroll
      for (int c = 0; c < chunk; ++c) other[c] = column[c] == noColumn ? x : pairs.position[column[c]];
#pragma unroll
      for (int c = 0; c < chunk; ++c) {
        if (column[c] == noColumn) break;
        const Vec<D> d = pairs.grid.difference(x, other[c]);
        visit(column[c], d, Distance(d));
      }
    }
  }
}

/// Eight lanes per fluid particle; reads its neighbours and what the term reads; writes what the term stores. The
/// bound leaves 72 registers, and up to 96 where there are many sums: with more too few threads wait for memory at
/// a time. `BesideWalls`: particles without walls only store. No atomics.
template <bool BesideWalls, int D, class Term>
__global__ void __launch_bounds__(128, Term::values > 20   ? 5
                                       : Term::values > 12 ? 6
                                                           : 7)
    fluidSumsKernel(const __grid_constant__ IsphPairs<D> pairs, Term term) {
  const std::uint32_t i = blockIdx.x * (blockDim.x / rowLanes) + threadIdx.x / rowLanes;
  bool used = i < pairs.ownFluid();
  if constexpr (BesideWalls)
    if (used && pairs.wallsOfFluid.isEmpty(i)) {
      if (threadIdx.x % rowLanes == 0) term.storeAway(pairs, i);
      used = false;
    }
  double sum[Term::values] = {};
  if (used) {
    const Vec<D> x = pairs.position[i];
    visitRow(pairs, pairs.fluidOfFluid, i, x,
             [&](std::uint32_t j, const Vec<D>& d, const Distance& r) { term.fluid(pairs, i, j, d, r, sum); });
    visitRow(pairs, pairs.wallsOfFluid, i, x,
             [&](std::uint32_t j, const Vec<D>& d, const Distance& r) { term.wall(pairs, i, j, d, r, sum); });
  }
  sumOverLanes<Term::values>(sum);
  if (used && threadIdx.x % rowLanes == 0) term.store(pairs, i, sum);
}

/// The same per active wall particle and its fluid neighbours.
template <int D, class Term>
__global__ void __launch_bounds__(128) wallSumsKernel(const __grid_constant__ IsphPairs<D> pairs, Term term) {
  const std::uint32_t row = blockIdx.x * (blockDim.x / rowLanes) + threadIdx.x / rowLanes,
                      i = pairs.fluidOfWalls.first + row;
  const bool used = row < pairs.fluidOfWalls.count;
  double sum[Term::values] = {};
  if (used)
    visitRow(pairs, pairs.fluidOfWalls, row, pairs.position[i],
             [&](std::uint32_t j, const Vec<D>& d, const Distance& r) { term.fluid(pairs, i, j, d, r, sum); });
  sumOverLanes<Term::values>(sum);
  if (used && threadIdx.x % rowLanes == 0) term.store(pairs, i, sum);
}

/// Place of a column in a block with runs.
__device__ inline std::uint32_t placeOf(const ColumnBlocksView::Run* run, std::uint32_t runs,
                                        std::uint32_t column) {
  std::uint32_t found = 0;
  for (std::uint32_t step = ColumnBlocksView::runs / 2; step > 0; step /= 2)
    if (found + step < runs && run[found + step].begin <= column) found += step;
  return run[found].place + (column - run[found].begin);
}

/// Eight lanes per fluid particle and row of the matrix, which they write. No atomics.
template <bool Packed, int D, class T, class Row>
__global__ void __launch_bounds__(128)
    isphMatrixKernel(const __grid_constant__ IsphPairs<D> pairs, Row row, IsphMatrixParts<D, T> parts) {
  using Blocks = ColumnBlocksView;
  constexpr std::uint32_t rowsOfThreads = 128 / rowLanes;
  static_assert(Blocks::rows % rowsOfThreads == 0, "all rows of a thread block are in one block of rows");
  __shared__ Blocks::Run run[Packed ? Blocks::runs : 1];
  std::uint32_t runs = 0;
  if constexpr (Packed) {
    const std::size_t block = blockIdx.x / (Blocks::rows / rowsOfThreads);
    runs = parts.packed.blocks.size[block].runs;
    if (threadIdx.x < runs) run[threadIdx.x] = parts.packed.blocks.run[block * Blocks::runs + threadIdx.x];
    __syncthreads();
  }
  const std::uint32_t i = blockIdx.x * (blockDim.x / rowLanes) + threadIdx.x / rowLanes,
                      lane = threadIdx.x % rowLanes;
  const bool used = i < pairs.ownFluid();
  const IsphMatrixRow<D, T, Row> filler{pairs, row, parts};
  double sum[filler.values] = {};
  if (used) {
    const Vec<D> x = pairs.position[i];
    const NeighbourRowsView& rows = pairs.fluidOfFluid;
    for (const std::uint64_t section : {std::uint64_t{i}, std::uint64_t{rows.count} + i}) {
      const std::uint64_t begin = rows.start[section], end = rows.start[section + 1];
      const std::uint64_t shift = Packed ? parts.packed.begin(section) - begin : 0;
      for (std::uint64_t k = begin + lane; k < end; k += rowLanes)
        filler.entry(i, x, k, section == i, sum, [&](std::uint32_t j, double c) {
          if constexpr (Packed)
            return parts.putPacked(k + shift, runs > 0 ? placeOf(run, runs, j) : 0, c);
          else
            return parts.put(k, c);
        });
      if constexpr (Packed)
        for (std::uint64_t k = end + shift + lane; k < parts.packed.begin(section + 1); k += rowLanes)
          parts.packed.word[k] = 0;
    }
    pairs.wallsOfFluid.forEachPlace(
        i, [&](std::uint64_t k) { filler.wall(i, x, k, sum); }, lane, rowLanes);
  }
  sumOverLanes<filler.values>(sum);
  if (used && lane == 0) filler.finish(i, sum);
}

}  // namespace

template <int D, class Term, class Backend>
void sumOnFluid(Context<Backend>& context, const IsphPairs<D>& pairs, const Term& term) {
  launch(context, blocksFor(std::size_t{pairs.ownFluid()} * rowLanes, 128), 128, 0,
         fluidSumsKernel<false, D, Term>, pairs, term);
}

template <int D, class Term, class Backend>
void sumBesideWalls(Context<Backend>& context, const IsphPairs<D>& pairs, const Term& term) {
  launch(context, blocksFor(std::size_t{pairs.ownFluid()} * rowLanes, 128), 128, 0, fluidSumsKernel<true, D, Term>,
         pairs, term);
}

template <int D, class Term, class Backend>
void sumOnWalls(Context<Backend>& context, const IsphPairs<D>& pairs, const Term& term) {
  launch(context, blocksFor(std::size_t{pairs.fluidOfWalls.count} * rowLanes, 128), 128, 0,
         wallSumsKernel<D, Term>, pairs, term);
}

/// Two threads per row count the fours of its sections.
template <int D>
void preparePacked(Context<Cuda>& context, const IsphPairs<D>& pairs, PackedEntries<Cuda>& packed) {
  findColumnBlocks<D>(context, pairs.grid, pairs.cells, pairs.position.first(pairs.ownFluid()), packed.blocks);
  const std::size_t sections = 2 * std::size_t{pairs.ownFluid()};
  packed.four.resize(context, sections + 1);
  forEach(context, sections,
          [start = pairs.fluidOfFluid.start, four = packed.four.data()] __device__(std::size_t k) {
            four[k] = static_cast<std::uint32_t>((start[k + 1] - start[k] + 3) / 4);
          });
  packed.word.resize(context, std::size_t{4} * startRows(context, packed.four));
}

template <int D, class T, class Row, class Backend>
void fillIsphMatrix(Context<Backend>& context, const IsphPairs<D>& pairs, const Row& row,
                    const IsphMatrixParts<D, T>& parts) {
  const unsigned blocks = blocksFor(std::size_t{pairs.ownFluid()} * rowLanes, 128);
  if constexpr (std::is_same_v<T, float>)
    if (parts.packed.word)
      return launch(context, blocks, 128, 0, isphMatrixKernel<true, D, T, Row>, pairs, row, parts);
  launch(context, blocks, 128, 0, isphMatrixKernel<false, D, T, Row>, pairs, row, parts);
}

TREACLE_ISPH_SUMS(2, Cuda)
TREACLE_ISPH_SUMS(3, Cuda)
template void preparePacked(Context<Cuda>&, const IsphPairs<2>&, PackedEntries<Cuda>&);
template void preparePacked(Context<Cuda>&, const IsphPairs<3>&, PackedEntries<Cuda>&);

}  // namespace treacle
