#include "sort_groups.hpp"

namespace treacle {

template <int D>
void sortByCell(Context<Cpu>&, const CellGrid<D>& grid, Particles<D>& particles, CellRanges<>& ranges,
                SortWorkspace<>& workspace) {
  const std::uint32_t fluid = particles.fluidCount, count = particles.count;
  requireFinite<D>(particles.position);
  workspace.keyed.resize(count);
  KeyedIndex* keyed = workspace.keyed.data();
  const auto before = [](const KeyedIndex& a, const KeyedIndex& b) {
    return a.key != b.key ? a.key < b.key : a.index < b.index;
  };

  parallelFor(fluid, parallelGrain, [&](std::size_t i) {
    keyed[i] = {grid.key(particles.position[i]), static_cast<std::uint32_t>(i)};
  });
  sortGroup(particles, 0, fluid, workspace, before);
  ranges.key.resize(fluid);
  for (std::uint32_t i = 0; i < fluid; ++i) ranges.key[i] = keyed[i].key;
  fillRanges<D>(grid, particles.position, 0, fluid, ranges.fluidBegin, ranges.fluidEnd);
  markActiveCells(
      grid, particles, [&](std::size_t cell) { return ranges.fluidEnd[cell] > 0; }, workspace);

  parallelFor(count - fluid, parallelGrain, [&](std::size_t wall) {
    const auto i = static_cast<std::uint32_t>(fluid + wall);
    const Vec<D>& x = particles.position[i];
    const bool active = workspace.active[grid.linear(grid.cellOf(x))];
    keyed[i] = {grid.key(x) | (active ? 0 : inactiveKey), i};
  });
  sortGroup(particles, fluid, count, workspace, before);
  ranges.activeCount = static_cast<std::uint32_t>(
      std::partition_point(keyed + fluid, keyed + count, [](const KeyedIndex& k) { return k.key < inactiveKey; }) -
      keyed);
  fillRanges<D>(grid, particles.position, fluid, ranges.activeCount, ranges.wallBegin, ranges.wallEnd);
  giveUp(workspace.keyed, workspace.field);
}

template void sortByCell<2>(Context<Cpu>&, const CellGrid<2>&, Particles<2>&, CellRanges<>&, SortWorkspace<>&);
template void sortByCell<3>(Context<Cpu>&, const CellGrid<3>&, Particles<3>&, CellRanges<>&, SortWorkspace<>&);

}  // namespace treacle
