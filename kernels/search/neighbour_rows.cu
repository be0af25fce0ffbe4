#include "treacle/search/neighbour_rows.hpp"

#include "core/scan.cuh"

namespace treacle {

/// Twice one thread per row: it counts its neighbours, then writes them. Reads the positions in the cells around
/// its particle. No atomics.
template <int D>
void findNeighbours(Context<Cuda>& context, const CellGrid<D>& grid, const CellRangesView& cells,
                    std::span<const Vec<D>> position, std::uint32_t fluidCount, std::uint32_t activeCount,
                    RowRadii radii, RowKind kind, NeighbourRows<Cuda>& rows) {
  const RowSearch search = RowSearch::make(kind, fluidCount, activeCount);
  const Vec<D>* x = position.data();
  rows.first = search.first;
  rows.nearCount.resize(context, search.count);
  rows.rowStart.resize(context, std::size_t{search.count} + 1);
  std::uint64_t* start = rows.rowStart.data();
  std::uint32_t* nearCount = rows.nearCount.data();
  forEach(context, search.count, [=] __device__(std::size_t row) {
    std::uint32_t all = 0, near = 0;
    forEachNeighbour(grid, cells, x, search.first + static_cast<std::uint32_t>(row), radii, search.walls,
                     [&](std::uint32_t, bool isNear) { ++all, near += isNear; });
    start[row] = all;
    nearCount[row] = near;
  });
  rows.column.resize(context, startRows(context, rows.rowStart));
  forEach(context, search.count, [=, column = rows.column.data()] __device__(std::size_t row) {
    std::uint64_t near = start[row], far = near + nearCount[row];
    forEachNeighbour(grid, cells, x, search.first + static_cast<std::uint32_t>(row), radii, search.walls,
                     [&](std::uint32_t j, bool isNear) { column[isNear ? near++ : far++] = j; });
  });
}

template void findNeighbours<2>(Context<Cuda>&, const CellGrid<2>&, const CellRangesView&, std::span<const Vec<2>>,
                                std::uint32_t, std::uint32_t, RowRadii, RowKind, NeighbourRows<Cuda>&);
template void findNeighbours<3>(Context<Cuda>&, const CellGrid<3>&, const CellRangesView&, std::span<const Vec<3>>,
                                std::uint32_t, std::uint32_t, RowRadii, RowKind, NeighbourRows<Cuda>&);

}  // namespace treacle
