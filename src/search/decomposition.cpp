#include "treacle/search/decomposition.hpp"

#include "migration.hpp"
#include "sort_groups.hpp"

#include <algorithm>
#include <string>
#include <vector>

namespace treacle {
namespace {

/// Work of a fluid particle and of an active wall particle. The products of a solve take the neighbours of both,
/// those of a wall particle the fluid among them and one of two products.
constexpr std::uint32_t fluidWork = 4, wallWork = 1;

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
  listSent(grid, p.position, 0, own, halo_.sentFluid, &Halo<Cpu>::Neighbour::sentFluid);
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

#define TREACLE_INSTANTIATE(D)                                                                          \
  template void Decomposition<D>::sort(Context<Cpu>&, const CellGrid<D>&, Particles<D>&, CellRanges<>&, \
                                       SortWorkspace<>&);
TREACLE_INSTANTIATE(2)
TREACLE_INSTANTIATE(3)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
