#include "sort_groups.hpp"
#include "treacle/search/decomposition.hpp"

#include <algorithm>
#include <vector>

// The particles that a process holds, once it is clear which are its own: their order, and who needs what of whom.

namespace treacle {
namespace {

/// Ghosts among the walls sort behind own walls, and before inactive ones.
constexpr std::uint64_t ghostKey = std::uint64_t{1} << 62;

/// By id where keys are the same: an order that does not depend on who had the particles before.
auto byKeyAndId(const Buffer<std::uint32_t>& id) {
  return [&id](const KeyedIndex& a, const KeyedIndex& b) {
    return a.key != b.key ? a.key < b.key : id[a.index] < id[b.index];
  };
}

}  // namespace

template <int D>
void Decomposition<D, Cpu>::sortFluid(const CellGrid<D>& grid, Particles<D>& p, CellRanges<>& ranges,
                                      SortWorkspace<>& workspace) {
  workspace.keyed.resize(p.fluidCount);
  KeyedIndex* keyed = workspace.keyed.data();
  parallelFor(p.fluidCount, parallelGrain, [&](std::size_t i) {
    keyed[i] = {grid.key(p.position[i]), static_cast<std::uint32_t>(i)};
  });
  sortGroup(p, 0, p.fluidCount, workspace, byKeyAndId(p.id));
  ranges.key.resize(p.fluidCount);
  for (std::uint32_t i = 0; i < p.fluidCount; ++i) ranges.key[i] = keyed[i].key;
}

/// Whether walls of a cell are active is for its owner to see as for all who have them as ghosts.
template <int D>
void Decomposition<D, Cpu>::findActiveCells(const Communicator& job, const CellGrid<D>& grid,
                                            const Particles<D>& p, SortWorkspace<>& workspace) {
  fluidCells_.resize(grid.cellCount());
  std::fill(fluidCells_.begin(), fluidCells_.end(), std::uint8_t{0});
  for (std::uint32_t i = 0; i < p.fluidCount; ++i) fluidCells_[cellAt(grid, p.position[i])] = 1;
  job.anyOf(fluidCells_);
  markActiveCells(
      grid, p, [&](std::size_t cell) { return fluidCells_[cell] != 0; }, workspace);
}

template <int D>
void Decomposition<D, Cpu>::sortWalls(const CellGrid<D>& grid, Particles<D>& p, CellRanges<>& ranges,
                                      SortWorkspace<>& workspace) {
  const std::uint32_t begin = p.wallBegin(), count = p.count;
  workspace.keyed.resize(count);
  KeyedIndex* keyed = workspace.keyed.data();
  parallelFor(count - begin, parallelGrain, [&](std::size_t wall) {
    const auto i = static_cast<std::uint32_t>(begin + wall);
    const std::size_t cell = cellAt(grid, p.position[i]);
    const std::uint64_t group = !workspace.active[cell]     ? inactiveKey
                                : owners_.isOwn(cell)       ? 0
                                : owners_.isBesideOwn(cell) ? ghostKey
                                                            : inactiveKey;
    keyed[i] = {grid.key(p.position[i]) | group, i};
  });
  // Ghosts in the order of the ranks that own them.
  const auto owner = [&](const KeyedIndex& k) { return owners_.owner(cellAt(grid, p.position[k.index])); };
  const auto isGhost = [](const KeyedIndex& k) { return k.key >= ghostKey && k.key < inactiveKey; };
  sortGroup(p, begin, count, workspace, [&](const KeyedIndex& a, const KeyedIndex& b) {
    if (isGhost(a) && isGhost(b) && owner(a) != owner(b)) return owner(a) < owner(b);
    return byKeyAndId(p.id)(a, b);
  });
  const auto endOf = [&](std::uint64_t key) {
    return static_cast<std::uint32_t>(
        std::partition_point(keyed + begin, keyed + count, [=](const KeyedIndex& k) { return k.key < key; }) -
        keyed);
  };
  const std::uint32_t ownEnd = endOf(ghostKey);
  ranges.activeCount = endOf(inactiveKey);
  ranges.ghostWalls = ranges.activeCount - ownEnd;
  halo_.ownWalls = ownEnd - begin;
  listSent(grid, p.position, begin, ownEnd, halo_.sentWalls, &Halo<Cpu>::Neighbour::sentWalls);
  for (std::uint32_t i = ownEnd; i < ranges.activeCount; ++i)
    ++halo_.neighbours[owners_.owner(cellAt(grid, p.position[i]))].walls;
}

template <int D>
void Decomposition<D, Cpu>::listSent(const CellGrid<D>& grid, std::span<const Vec<D>> position,
                                     std::uint32_t begin, std::uint32_t end, Buffer<std::uint32_t>& sent,
                                     std::uint32_t Halo<Cpu>::Neighbour::*count) {
  std::vector<std::vector<std::uint32_t>> lists(halo_.neighbours.size());
  std::vector<int> to;  // of the cell at hand
  for (std::uint32_t i = begin; i < end; ++i) {
    const Vec<D, int> cell = grid.cellOf(position[i]);
    if (i == begin || grid.linear(cell) != cellAt(grid, position[i - 1])) {
      to.clear();
      const int own = owners_.owner(grid.linear(cell));
      forEachAdjacentCell(grid, cell, [&](const Vec<D, int>& c) {
        const int other = owners_.owner(grid.linear(c));
        if (other != own && std::ranges::find(to, other) == to.end()) to.push_back(other);
      });
    }
    for (int r : to) lists[r].push_back(i);
  }
  std::vector<std::uint32_t> all;
  for (std::size_t r = 0; r < lists.size(); ++r) {
    halo_.neighbours[r].*count = static_cast<std::uint32_t>(lists[r].size());
    all.insert(all.end(), lists[r].begin(), lists[r].end());
  }
  sent.resize(all.size());
  std::ranges::copy(all, sent.begin());
}

#define TREACLE_INSTANTIATE(D)                                                                              \
  template void Decomposition<D, Cpu>::sortFluid(const CellGrid<D>&, Particles<D>&, CellRanges<>&,          \
                                                 SortWorkspace<>&);                                         \
  template void Decomposition<D, Cpu>::findActiveCells(const Communicator&, const CellGrid<D>&,             \
                                                       const Particles<D>&, SortWorkspace<>&);              \
  template void Decomposition<D, Cpu>::sortWalls(const CellGrid<D>&, Particles<D>&, CellRanges<>&,          \
                                                 SortWorkspace<>&);                                         \
  template void Decomposition<D, Cpu>::listSent(const CellGrid<D>&, std::span<const Vec<D>>, std::uint32_t, \
                                                std::uint32_t, Buffer<std::uint32_t>&,                      \
                                                std::uint32_t Halo<Cpu>::Neighbour::*);
TREACLE_INSTANTIATE(2)
TREACLE_INSTANTIATE(3)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
