#include "treacle/search/column_blocks.hpp"

#include "core/launch.hpp"

namespace treacle {
namespace {

using Blocks = ColumnBlocksView;
using CellRun = std::uint64_t;  // the first particle of a cell above the one behind its last

/// Cells that a block may gather: some seventy in three dimensions. The table has room for those that its threads
/// are about to add, too.
constexpr std::uint32_t mostCells = 512, tableSize = 1024;
constexpr CellRun noCell = ~CellRun{0};

__device__ inline std::uint32_t beginOf(CellRun cell) { return static_cast<std::uint32_t>(cell >> 32); }
__device__ inline std::uint32_t endOf(CellRun cell) { return static_cast<std::uint32_t>(cell); }

/// Sorts cells[0 … count), count a power of two, by all threads of a block.
__device__ inline void sortCells(CellRun* cells, std::uint32_t count) {
  for (std::uint32_t size = 2; size <= count; size *= 2)
    for (std::uint32_t away = size / 2; away > 0; away /= 2) {
      __syncthreads();
      for (std::uint32_t t = threadIdx.x; t < count / 2; t += blockDim.x) {
        const std::uint32_t a = 2 * t - (t & (away - 1)), b = a + away;
        const CellRun low = min(cells[a], cells[b]), high = max(cells[a], cells[b]);
        const bool ascending = (a & size) == 0;
        cells[a] = ascending ? low : high;
        cells[b] = ascending ? high : low;
      }
    }
  __syncthreads();
}

/// Joins sorted cells to runs; by one warp.
__device__ inline Blocks::Size joinCells(const CellRun* cells, std::uint32_t count, Blocks::Run* run) {
  const std::uint32_t lane = threadIdx.x % 32, before = (1u << lane) - 1;
  Blocks::Size size{0, 0};
  for (std::uint32_t k = lane; k - lane < count; k += 32) {
    const bool used = k < count;
    const CellRun own = used ? cells[k] : 0, last = used && k > 0 ? cells[k - 1] : 0;
    const bool repeated = !used || (k > 0 && own == last);
    const bool starts = !repeated && (k == 0 || beginOf(own) != endOf(last));
    const std::uint32_t length = repeated ? 0 : endOf(own) - beginOf(own);
    std::uint32_t upTo = length;
    for (std::uint32_t step = 1; step < 32; step *= 2) {
      const std::uint32_t other = __shfl_up_sync(~0u, upTo, step);
      if (lane >= step) upTo += other;
    }
    const unsigned starting = __ballot_sync(~0u, starts);
    const std::uint32_t place = size.runs + __popc(starting & before);
    if (starts && place < Blocks::runs) run[place] = {beginOf(own), size.columns + upTo - length};
    size.runs += __popc(starting);
    size.columns += __shfl_sync(~0u, upTo, 31);
  }
  return size.runs <= Blocks::runs && size.columns <= Blocks::columns ? size : Blocks::Size{0, 0};
}

/// Puts a cell into the table, once; counts those that are in it.
__device__ inline void addCell(CellRun* table, CellRun cell, std::uint32_t* count) {
  std::uint32_t place = beginOf(cell) * 2654435761u / (~0u / tableSize + 1);
  while (true) {
    const CellRun before = atomicCAS(reinterpret_cast<unsigned long long*>(table + place), noCell, cell);
    if (before == noCell) atomicAdd(count, 1u);
    if (before == noCell || before == cell) return;
    place = (place + 1) % tableSize;
  }
}

/// The particles of the cell with number `offset` of those around one and itself; noCell without any.
template <int D>
__device__ inline CellRun besideCell(const CellGrid<D>& grid, const CellRangesView& ranges, Vec<D, int> cell,
                                     std::uint32_t offset) {
  for (int k = 0; k < D; ++k, offset /= 3) {
    cell[k] += static_cast<int>(offset % 3) - 1;
    if (grid.periodic[k]) cell[k] = (cell[k] + grid.count[k]) % grid.count[k];
    if (cell[k] < 0 || cell[k] >= grid.count[k]) return noCell;
  }
  const std::size_t c = grid.linear(cell);
  const std::uint32_t begin = ranges.fluidBegin[c], end = ranges.fluidEnd[c];
  return begin < end ? CellRun{begin} << 32 | end : noCell;
}

/// One thread per row, one block per block of rows; reads positions and cell ranges. Atomics put the cells into a
/// table, in no order; then they are sorted.
template <int D>
__global__ void __launch_bounds__(Blocks::rows)
    columnBlocksKernel(const __grid_constant__ CellGrid<D> grid, const CellRangesView ranges, const Vec<D>* fluid,
                       std::uint32_t fluidCount, Blocks::Run* run, Blocks::Size* size) {
  constexpr std::uint32_t around = D == 3 ? 27 : 9;
  __shared__ CellRun table[tableSize], cells[mostCells];
  __shared__ Vec<D, int> own[Blocks::rows];
  __shared__ std::uint32_t ownCount, count, places;
  for (std::uint32_t k = threadIdx.x; k < tableSize; k += Blocks::rows) table[k] = noCell;
  if (threadIdx.x == 0) ownCount = count = places = 0;
  __syncthreads();
  const std::uint32_t i = blockIdx.x * Blocks::rows + threadIdx.x;
  if (i < fluidCount) {
    const Vec<D, int> cell = grid.cellOf(fluid[i]);
    // The first of a cell in this block speaks for all.
    if (threadIdx.x == 0 || ranges.fluidBegin[grid.linear(cell)] == i) own[atomicAdd(&ownCount, 1u)] = cell;
  }
  __syncthreads();
  for (std::uint32_t k = threadIdx.x; k < ownCount * around; k += Blocks::rows) {
    const CellRun cell = besideCell(grid, ranges, own[k / around], k % around);
    if (cell != noCell && *static_cast<volatile std::uint32_t*>(&count) <= mostCells) addCell(table, cell, &count);
  }
  __syncthreads();
  if (count > mostCells) {
    if (threadIdx.x == 0) size[blockIdx.x] = {0, 0};
    return;
  }
  for (std::uint32_t k = threadIdx.x; k < tableSize; k += Blocks::rows)
    if (table[k] != noCell) cells[atomicAdd(&places, 1u)] = table[k];
  std::uint32_t power = 2;
  while (power < count) power *= 2;
  for (std::uint32_t k = count + threadIdx.x; k < power; k += Blocks::rows) cells[k] = noCell;
  sortCells(cells, power);
  if (threadIdx.x >= 32) return;
  const Blocks::Size joined = joinCells(cells, count, run + std::size_t{blockIdx.x} * Blocks::runs);
  if (threadIdx.x == 0) size[blockIdx.x] = joined;
}

}  // namespace

template <int D>
void findColumnBlocks(Context<Cuda>& context, const CellGrid<D>& grid, const CellRangesView& cells,
                      std::span<const Vec<D>> fluid, ColumnBlocks<Cuda>& blocks) {
  const std::size_t count = blocksFor(fluid.size(), Blocks::rows);
  blocks.run.resize(context, count * Blocks::runs);
  blocks.size.resize(context, count);
  launch(context, static_cast<unsigned>(count), Blocks::rows, 0, columnBlocksKernel<D>, grid, cells, fluid.data(),
         static_cast<std::uint32_t>(fluid.size()), blocks.run.data(), blocks.size.data());
}

template void findColumnBlocks<2>(Context<Cuda>&, const CellGrid<2>&, const CellRangesView&,
                                  std::span<const Vec<2>>, ColumnBlocks<Cuda>&);
template void findColumnBlocks<3>(Context<Cuda>&, const CellGrid<3>&, const CellRangesView&,
                                  std::span<const Vec<3>>, ColumnBlocks<Cuda>&);

}  // namespace treacle
