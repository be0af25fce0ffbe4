#include "treacle/search/decomposition.hpp"

#include "migration.hpp"
#include "sort_groups.hpp"

#include <algorithm>
#include <string>
#include <vector>

namespace treacle {
namespace {

/// Ghosts among the walls sort behind own walls, and before inactive ones.
constexpr std::uint64_t ghostKey = std::uint64_t{1} << 62;

/// Work of a fluid particle and of an active wall particle. The products of a solve take the neighbours of both,
/// those of a wall particle the fluid among them and one of two products.
constexpr std::uint32_t fluidWork = 4, wallWork = 1;

/// By id where keys are the same: an order that does not depend on who had the particles before.
auto byKeyAndId(const Buffer<std::uint32_t>& id) {
  return [&id](const KeyedIndex& a, const KeyedIndex& b) {
    return a.key != b.key ? a.key < b.key : id[a.index] < id[b.index];
  };
}

template <int D>
std::size_t cellAt(const CellGrid<D>& grid, const Vec<D>& x) {
  return grid.linear(grid.cellOf(x));
}

template <int D>
void addWork(const CellGrid<D>& grid, std::span<const Vec<D>> position, std::uint32_t each,
             std::vector<std::uint32_t>& work) {
  for (const Vec<D>& x : position) work[cellAt(grid, x)] += each;
}

}  // namespace

template <int D>
void Decomposition<D>::sort(Context<Cpu>& context, const CellGrid<D>& grid, Particles<D>& p, CellRanges<>& ranges,
                            SortWorkspace<>& workspace) {
  const Communicator& job = *context.communicator;
  agreed(context, [&] {
    requireFinite<D>(p.position.span().first(p.fluidCount));
    requireFinite<D>(p.position.span().subspan(p.wallBegin()));
  });
  if (!owners_.areKnown()) {
    assignFirst(job, grid, p);
    keepOwn(grid, p);
  } else {
    balance(job, grid, p, ranges);
    migrate(job, grid, p);
  }
  sortFluid(grid, p, ranges, workspace);
  const std::uint32_t own = p.fluidCount;
  findActiveCells(job, grid, p.position.span().first(own), workspace);

  halo_ = {};
  halo_.ownFluid = halo_.fluid = own;
  halo_.neighbours.resize(job.size());
  for (int r = 0; r < job.size(); ++r) halo_.neighbours[r].rank = r;
  listSent(grid, p.position, 0, own, &Halo::Neighbour::sentFluid);
  countGhostFluid(job);
  resizeFluid(p, own, halo_.fluid - own);
  sortWalls(grid, p, ranges, workspace);
  countAll(job);
  if (halo_.someHaveNone) p.modes.drop();  // a process without fluid does not know how many there are
  context.halo = &halo_;
  fillGhosts(context, Held::Fluid, p.position.data());
  fillGhosts(context, Held::Fluid, p.material.data());
  fillRanges<D>(grid, p.position, 0, halo_.fluid, ranges.fluidBegin, ranges.fluidEnd);
  fillRanges<D>(grid, p.position, halo_.fluid, ranges.activeCount, ranges.wallBegin, ranges.wallEnd);
  giveUp(workspace.keyed, workspace.field);
}

/// What is done for all particles by each process, once.
template <int D>
void Decomposition<D>::assignFirst(const Communicator& job, const CellGrid<D>& grid, const Particles<D>& p) {
  std::vector<std::uint32_t> work(grid.cellCount());
  const auto fluid = p.position.span().first(p.fluidCount);
  addWork<D>(grid, fluid, fluidWork, work);
  const auto filled = std::ranges::count_if(work, [](std::uint32_t w) { return w > 0; });
  if (job.size() > filled)
    throw InputError(std::to_string(job.size()) + " processes, but the fluid fills only " +
                     std::to_string(filled) +
                     " cells of the search, the parts that it can be divided into; start fewer processes");
  std::vector<std::uint8_t> active(grid.cellCount());
  for (std::size_t cell = 0; cell < work.size(); ++cell)
    if (work[cell] > 0)
      forEachAdjacentCell(grid, grid.cellAt(cell), [&](const Vec<D, int>& c) { active[grid.linear(c)] = 1; });
  for (const Vec<D>& x : p.position.span().subspan(p.wallBegin()))
    if (const std::size_t cell = cellAt(grid, x); active[cell]) work[cell] += wallWork;
  owners_.assign(grid, work, job.rank(), job.size());
}

template <int D>
void Decomposition<D>::keepOwn(const CellGrid<D>& grid, Particles<D>& p) {
  std::vector<std::uint32_t> kept;
  for (std::uint32_t i = 0; i < p.fluidCount; ++i)
    if (owners_.isOwn(cellAt(grid, p.position[i]))) kept.push_back(i);
  keepFluid<D>(p, kept);
}

/// Once cells are as evenly given out as they can be, it is not tried again until that has become worse.
template <int D>
void Decomposition<D>::balance(const Communicator& job, const CellGrid<D>& grid, const Particles<D>& p,
                               const CellRanges<>& ranges) {
  const std::uint32_t wallBegin = p.wallBegin(), walls = ranges.activeCount - ranges.ghostWalls - wallBegin;
  const std::vector<std::uint64_t> all = job.all(std::uint64_t{fluidWork} * p.fluidCount + wallWork * walls);
  std::uint64_t most = 0, total = 0;
  for (std::uint64_t own : all) most = std::max(most, own), total += own;
  const double imbalance = total > 0 ? static_cast<double>(most) * job.size() / static_cast<double>(total) : 1;
  if (imbalance <= std::max(mostImbalance, 1.05 * owners_.imbalance())) return;
  std::vector<std::uint32_t> work(grid.cellCount());
  addWork<D>(grid, p.position.span().first(p.fluidCount), fluidWork, work);
  addWork<D>(grid, p.position.span().subspan(wallBegin, walls), wallWork, work);
  job.sum(std::span(work));
  owners_.assign(grid, work, job.rank(), job.size());
}

template <int D>
void Decomposition<D>::migrate(const Communicator& job, const CellGrid<D>& grid, Particles<D>& p) {
  std::vector<std::vector<std::uint32_t>> to(job.size());
  for (std::uint32_t i = 0; i < p.fluidCount; ++i) to[owners_.owner(cellAt(grid, p.position[i]))].push_back(i);
  std::vector<std::vector<std::byte>> sent(job.size());
  for (int r = 0; r < job.size(); ++r)
    if (r != job.rank()) sent[r] = packed<D>(p, to[r]);
  const std::size_t each = packedBytes(p);
  const std::vector<std::vector<std::byte>> received = job.swap(sent);
  keepFluid<D>(p, to[job.rank()]);
  const std::uint32_t kept = p.fluidCount;
  std::size_t incoming = 0;
  for (const auto& bytes : received) incoming += bytes.size() / each;
  if (incoming == 0) return;
  resizeFluid(p, kept + static_cast<std::uint32_t>(incoming), 0);
  std::uint32_t next = kept;
  for (const auto& bytes : received) {
    const auto count = static_cast<std::uint32_t>(bytes.size() / each);
    unpack<D>(bytes, p, next, count);
    next += count;
  }
}

template <int D>
void Decomposition<D>::sortFluid(const CellGrid<D>& grid, Particles<D>& p, CellRanges<>& ranges,
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
void Decomposition<D>::findActiveCells(const Communicator& job, const CellGrid<D>& grid,
                                       std::span<const Vec<D>> fluid, SortWorkspace<>& workspace) {
  fluidCells_.resize(grid.cellCount());
  std::fill(fluidCells_.begin(), fluidCells_.end(), std::uint8_t{0});
  for (const Vec<D>& x : fluid) fluidCells_[cellAt(grid, x)] = 1;
  job.anyOf(fluidCells_);
  workspace.hasFluid.resize(grid.cellCount());
  std::fill(workspace.hasFluid.begin(), workspace.hasFluid.end(), std::uint8_t{0});
  for (std::size_t cell = 0; cell < fluidCells_.size(); ++cell)
    if (fluidCells_[cell])
      forEachAdjacentCell(grid, grid.cellAt(cell),
                          [&](const Vec<D, int>& c) { workspace.hasFluid[grid.linear(c)] = 1; });
}

template <int D>
void Decomposition<D>::sortWalls(const CellGrid<D>& grid, Particles<D>& p, CellRanges<>& ranges,
                                 SortWorkspace<>& workspace) {
  const std::uint32_t begin = p.wallBegin(), count = p.count;
  workspace.keyed.resize(count);
  KeyedIndex* keyed = workspace.keyed.data();
  parallelFor(count - begin, parallelGrain, [&](std::size_t wall) {
    const auto i = static_cast<std::uint32_t>(begin + wall);
    const std::size_t cell = cellAt(grid, p.position[i]);
    const std::uint64_t group = !workspace.hasFluid[cell]   ? inactiveKey
                                : owners_.isOwn(cell)       ? 0
                                : owners_.isBesideOwn(cell) ? ghostKey
                                                            : inactiveKey;
    keyed[i] = {grid.key(p.position[i]) | group, i};
  });
  sortGroup(p, begin, count, workspace, byKeyAndId(p.id));
  const auto endOf = [&](std::uint64_t key) {
    return static_cast<std::uint32_t>(
        std::partition_point(keyed + begin, keyed + count, [=](const KeyedIndex& k) { return k.key < key; }) -
        keyed);
  };
  const std::uint32_t ownEnd = endOf(ghostKey);
  ranges.activeCount = endOf(inactiveKey);
  ranges.ghostWalls = ranges.activeCount - ownEnd;
  halo_.ownWalls = ownEnd - begin;
  listSent(grid, p.position, begin, ownEnd, &Halo::Neighbour::sentWalls);
  for (std::uint32_t i = ownEnd; i < ranges.activeCount; ++i)
    ++halo_.neighbours[owners_.owner(cellAt(grid, p.position[i]))].walls;
}

template <int D>
void Decomposition<D>::listSent(const CellGrid<D>& grid, std::span<const Vec<D>> position, std::uint32_t begin,
                                std::uint32_t end, std::vector<std::uint32_t> Halo::Neighbour::*list) {
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
    for (int r : to) (halo_.neighbours[r].*list).push_back(i);
  }
}

template <int D>
void Decomposition<D>::countGhostFluid(const Communicator& job) {
  const std::size_t size = job.size();
  std::vector<std::uint32_t> counts(size * size);  // [from][to]
  for (std::size_t r = 0; r < size; ++r)
    counts[job.rank() * size + r] = static_cast<std::uint32_t>(halo_.neighbours[r].sentFluid.size());
  job.sum(std::span(counts));
  for (std::size_t r = 0; r < size; ++r) halo_.fluid += halo_.neighbours[r].fluid = counts[r * size + job.rank()];
}

/// Processes that have nothing for each other are no neighbours.
template <int D>
void Decomposition<D>::countAll(const Communicator& job) {
  struct Owned {
    std::uint64_t fluid, walls;
  };
  const std::vector<Owned> all = job.all(Owned{halo_.ownFluid, halo_.ownWalls});
  for (int r = 0; r < job.size(); ++r) {
    if (r < job.rank()) halo_.fluidBefore += all[r].fluid, halo_.wallsBefore += all[r].walls;
    halo_.fluidOfAll += all[r].fluid;
    halo_.someHaveNone = halo_.someHaveNone || all[r].fluid == 0;
  }
  std::erase_if(halo_.neighbours, [](const Halo::Neighbour& n) {
    return n.sentFluid.empty() && n.sentWalls.empty() && n.fluid == 0 && n.walls == 0;
  });
}

template class Decomposition<2>;
template class Decomposition<3>;

}  // namespace treacle
