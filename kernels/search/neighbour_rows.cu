#include "treacle/search/neighbour_rows.hpp"

#include "core/launch.hpp"
#include "core/scan.hpp"
#include "search/rough_search.cuh"

namespace treacle {
namespace {

/// One thread per cell: whether it holds fluid and has walls in itself or beside it, as few cells do.
template <int D>
void markFluidNearWalls(const Context<Cuda>& context, const CellGrid<D>& grid, const CellRangesView& cells,
                        std::uint8_t* withEntry) {
  forEach(context, grid.cellCount(), [grid, cells, withEntry] __device__(std::size_t c) {
    bool any = false;
    if (cells.fluidEnd[c] > cells.fluidBegin[c])
      forEachAdjacentCell(grid, grid.cellAt(c), [&](const Vec<D, int>& cell) {
        const std::size_t other = grid.linear(cell);
        any = any || cells.wallEnd[other] > cells.wallBegin[other];
      });
    withEntry[c] = any;
  });
}

/// Places behind the last particle that are read, and mean nothing.
constexpr std::uint32_t placesBehind = 3;

/// One thread per particle. `side`: null where there are no thin sheets.
template <int D>
void findRoughPlaces(const Context<Cuda>& context, const CellGrid<D>& grid, std::span<const Vec<D>> x,
                     const std::uint32_t* side, float4* rough) {
  forEach(context, x.size() + placesBehind, [grid, x, side, rough] __device__(std::size_t i) {
    const Vec<D> p = i < x.size() ? x[i] - grid.origin : Vec<D>::filled(INFINITY);
    rough[i] = {static_cast<float>(p[0]), static_cast<float>(p[1]), D == 3 ? static_cast<float>(p[D - 1]) : 0.0f,
                __uint_as_float(side && i < x.size() ? side[i] : 0)};
  });
}

/// One thread per row: counts its neighbours and keeps a bit for each, per slot and row. Reads the positions in
/// the cells around. No atomics.
template <int D, bool General>
__global__ void __launch_bounds__(128)
    countNeighboursKernel(const __grid_constant__ RoughSearch<D, General> around, std::uint32_t first,
                          std::uint32_t count, std::uint32_t* found, std::uint64_t* start) {
  const std::uint32_t row = blockIdx.x * blockDim.x + threadIdx.x;
  if (row >= count) return;
  const Vec<D> x = around.exact[first + row];
  const float4 own = around.rough[first + row];
  std::uint32_t near = 0, far = 0;
  std::uint32_t* bits = found + row;
  around.template forEachCell<false>(
      x, [](int) {},
      [&](int, std::size_t cell) {
        *bits = cell == around.noCell ? 0 : around.inCell(cell, x, own, near, far);
        bits += count;
      });
  start[row] = near;
  start[std::size_t{count} + row] = far;
}

/// Rows of a block, and how many neighbours it can bring together before it writes them.
constexpr std::uint32_t rowsOfBlock = 128;
template <int D>
constexpr std::uint32_t neighboursOfBlock = rowsOfBlock*(D == 3 ? 72 : 32);

/// One thread per row: writes the neighbours that were counted. Those of a block follow each other, the near and
/// the far ones, and are brought together first, where they fit. No atomics.
template <int D, bool General>
__global__ void __launch_bounds__(rowsOfBlock)
    writeNeighboursKernel(const __grid_constant__ RoughSearch<D, General> around, std::uint32_t first,
                          std::uint32_t count, const std::uint32_t* found, const std::uint64_t* start,
                          std::uint32_t* column) {
  __shared__ std::uint32_t staged[neighboursOfBlock<D>];
  const std::uint32_t begin = blockIdx.x * rowsOfBlock, end = min(begin + rowsOfBlock, count);
  const std::uint64_t nearBegin = start[begin], farBegin = start[std::size_t{count} + begin];
  const auto near = static_cast<std::uint32_t>(start[end] - nearBegin);
  const auto far = static_cast<std::uint32_t>(start[std::size_t{count} + end] - farBegin);
  const bool fits = near + far <= neighboursOfBlock<D>;
  const std::uint32_t row = begin + threadIdx.x;
  if (row < end &&
      start[row] + start[count + std::size_t{row}] < start[row + 1] + start[count + std::size_t{row} + 1]) {
    const Vec<D> x = around.exact[first + row];
    const float4 own = around.rough[first + row];
    std::uint32_t* nearPlace = fits ? staged + (start[row] - nearBegin) : column + start[row];
    std::uint32_t* farPlace = fits ? staged + near + (start[count + std::size_t{row}] - farBegin)
                                   : column + start[count + std::size_t{row}];
    std::uint32_t bits[around.planeSlots];
    // A plane's bits are on their way together.
    around.template forEachCell<true>(
        x,
        [&](int slot) {
#pragma unroll
          for (int n = 0; n < around.planeSlots; ++n) bits[n] = found[(slot + n) * std::size_t{count} + row];
        },
        [&](int n, std::size_t cell) {
          if (bits[n] != 0)
            around.fromBits(cell, bits[n], x, own,
                            [&](std::uint32_t j, bool isNear) { *(isNear ? nearPlace++ : farPlace++) = j; });
        });
  }
  __syncthreads();
  if (!fits) return;
  for (std::uint32_t k = threadIdx.x; k < near; k += rowsOfBlock) column[nearBegin + k] = staged[k];
  for (std::uint32_t k = threadIdx.x; k < far; k += rowsOfBlock) column[farBegin + k] = staged[near + k];
}

template <int D, bool General>
void findRoughly(Context<Cuda>& context, const RoughSearch<D, General>& around, NeighbourRows<Cuda>& rows) {
  Buffer<std::uint32_t, Cuda> found(context, around.slots * std::size_t{rows.count});
  launch(context, blocksFor(rows.count, 128), 128, 0, countNeighboursKernel<D, General>, around, rows.first,
         rows.count, found.data(), rows.start.data());
  rows.column.resize(context, startRows(context, rows.start));
  launch(context, blocksFor(rows.count, rowsOfBlock), rowsOfBlock, 0, writeNeighboursKernel<D, General>, around,
         rows.first, rows.count, found.data(), rows.start.data(), rows.column.data());
}

}  // namespace

/// Candidates are looked at once: what is written after the counting are the bits of those that were found.
template <int D>
void findNeighbours(Context<Cuda>& context, const SortedParticles<D>& particles, RowRadii radii, RowKind kind,
                    NeighbourRows<Cuda>& rows) {
  const RowSearch search = RowSearch::make(kind, particles);
  const CellGrid<D>& grid = particles.grid;
  Buffer<float4, Cuda> rough(context, std::size_t{particles.activeCount} + placesBehind);
  findRoughPlaces(context, grid, particles.position.first(particles.activeCount), particles.side, rough.data());
  Buffer<std::uint8_t, Cuda> nearWalls;
  if (search.walls) {
    nearWalls.resize(context, grid.cellCount());
    markFluidNearWalls(context, grid, particles.cells, nearWalls.data());
  }
  rows.first = search.first;
  rows.count = search.count;
  rows.start.resize(context, 2 * std::size_t{search.count} + 1);
  const auto find = [&](auto around) {
    around.grid = grid;
    around.cells = particles.cells;
    around.exact = particles.position.data();
    around.rough = rough.data();
    around.hasSheets = particles.side != nullptr;
    around.walls = search.walls;
    around.used = nearWalls.data();
    around.setRadii(radii);
    findRoughly(context, around, rows);
  };
  bool general = particles.side != nullptr;
  for (int k = 0; k < D; ++k) general = general || grid.periodic[k];
  general ? find(RoughSearch<D, true>{}) : find(RoughSearch<D, false>{});
}

template void findNeighbours<2>(Context<Cuda>&, const SortedParticles<2>&, RowRadii, RowKind,
                                NeighbourRows<Cuda>&);
template void findNeighbours<3>(Context<Cuda>&, const SortedParticles<3>&, RowRadii, RowKind,
                                NeighbourRows<Cuda>&);

}  // namespace treacle
