#include "treacle/search/neighbour_rows.hpp"

#include "treacle/core/parallel.hpp"

namespace treacle {

template <int D>
void findNeighbours(Context<Cpu>&, const SortedParticles<D>& particles, RowRadii radii, RowKind kind,
                    NeighbourRows<>& rows) {
  const RowSearch search = RowSearch::make(kind, particles);
  const auto forEach = [&](std::size_t row, auto&& f) {
    forEachNeighbour(particles, search.first + static_cast<std::uint32_t>(row), radii, search.walls, f);
  };
  const std::size_t count = search.count;
  rows.first = search.first;
  rows.count = search.count;
  rows.start.resize(2 * count + 1);
  rows.start[0] = 0;
  parallelFor(count, parallelGrain, [&](std::size_t row) {
    std::uint32_t near = 0, far = 0;
    forEach(row, [&](std::uint32_t, bool isNear) { ++(isNear ? near : far); });
    rows.start[row + 1] = near;
    rows.start[count + row + 1] = far;
  });
  for (std::size_t row = 0; row < 2 * count; ++row) rows.start[row + 1] += rows.start[row];
  rows.column.resize(rows.start[2 * count]);
  parallelFor(count, parallelGrain, [&](std::size_t row) {
    std::uint64_t near = rows.start[row], far = rows.start[count + row];
    forEach(row, [&](std::uint32_t j, bool isNear) { rows.column[isNear ? near++ : far++] = j; });
  });
}

template void findNeighbours<2>(Context<Cpu>&, const SortedParticles<2>&, RowRadii, RowKind, NeighbourRows<>&);
template void findNeighbours<3>(Context<Cpu>&, const SortedParticles<3>&, RowRadii, RowKind, NeighbourRows<>&);

}  // namespace treacle
