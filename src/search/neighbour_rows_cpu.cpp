#include "treacle/search/neighbour_rows.hpp"

#include "treacle/core/parallel.hpp"

namespace treacle {

template <int D>
void findNeighbours(Context<Cpu>&, const CellGrid<D>& grid, const CellRangesView& cells,
                    std::span<const Vec<D>> position, std::uint32_t fluidCount, std::uint32_t activeCount,
                    RowRadii radii, RowKind kind, NeighbourRows<>& rows) {
  const RowSearch search = RowSearch::make(kind, fluidCount, activeCount);
  const auto forEach = [&](std::size_t row, auto&& f) {
    forEachNeighbour(grid, cells, position.data(), search.first + static_cast<std::uint32_t>(row), radii,
                     search.walls, f);
  };
  rows.first = search.first;
  rows.nearCount.resize(search.count);
  rows.rowStart.resize(std::size_t{search.count} + 1);
  rows.rowStart[0] = 0;
  parallelFor(search.count, parallelGrain, [&](std::size_t row) {
    std::uint32_t all = 0, near = 0;
    forEach(row, [&](std::uint32_t, bool isNear) { ++all, near += isNear; });
    rows.rowStart[row + 1] = all;
    rows.nearCount[row] = near;
  });
  for (std::size_t row = 0; row < search.count; ++row) rows.rowStart[row + 1] += rows.rowStart[row];
  rows.column.resize(rows.rowStart[search.count]);
  parallelFor(search.count, parallelGrain, [&](std::size_t row) {
    std::uint64_t near = rows.rowStart[row], far = near + rows.nearCount[row];
    forEach(row, [&](std::uint32_t j, bool isNear) { rows.column[isNear ? near++ : far++] = j; });
  });
}

template void findNeighbours<2>(Context<Cpu>&, const CellGrid<2>&, const CellRangesView&, std::span<const Vec<2>>,
                                std::uint32_t, std::uint32_t, RowRadii, RowKind, NeighbourRows<>&);
template void findNeighbours<3>(Context<Cpu>&, const CellGrid<3>&, const CellRangesView&, std::span<const Vec<3>>,
                                std::uint32_t, std::uint32_t, RowRadii, RowKind, NeighbourRows<>&);

}  // namespace treacle
