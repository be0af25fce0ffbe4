#include "treacle/search/decomposition.hpp"

#include "migration.hpp"
#include "sort_groups.hpp"

#include <algorithm>
#include <vector>

namespace treacle {
template <int D>
void Decomposition<D, Cpu>::sort(Context<Cpu>& context, const CellGrid<D>& grid, Particles<D>& p,
                                 CellRanges<>& ranges, SortWorkspace<>& workspace) {
  const Communicator& job = *context.communicator;
  agreed(context, [&] {
    requireFinite<D>(p.position.span().first(p.fluidCount));
    requireFinite<D>(p.position.span().subspan(p.wallBegin()));
  });
  if (!owners_.areKnown())
    this->assignFirst(job, grid, p.position.span().first(p.fluidCount), p.position.span().subspan(p.wallBegin()));
  else
    balance(job, grid, p);
  migrate(job, grid, p);
  sortFluid(grid, p, ranges, workspace);
  const std::uint32_t own = p.fluidCount;
  findActiveCells(job, grid, p, workspace);

  this->startHalo(job, own);
  listSent(grid, p.position, 0, own, halo_.sentFluid, &Halo<Cpu>::Neighbour::sentFluid);
  this->countGhostFluid(job);
  resizeFluid(p, own, halo_.fluid - own);
  sortWalls(grid, p, ranges, workspace);
  this->countAll(job);
  if (halo_.someHaveNone) p.modes.drop();  // a process without fluid does not know how many there are
  context.halo = &halo_;
  fillGhosts(context, Held::Fluid, p.position.data());
  fillGhosts(context, Held::Fluid, p.material.data());
  if (p.has.sides) fillGhosts(context, Held::Fluid, p.side.data());
  fillRanges<D>(grid, p.position, 0, halo_.fluid, ranges.fluidBegin, ranges.fluidEnd);
  fillRanges<D>(grid, p.position, halo_.fluid, ranges.activeCount, ranges.wallBegin, ranges.wallEnd);
  giveUp(workspace.keyed, workspace.field);
}

template <int D>
void Decomposition<D, Cpu>::balance(const Communicator& job, const CellGrid<D>& grid, const Particles<D>& p) {
  if (!this->isUneven(job, p.fluidCount)) return;
  std::vector<std::uint32_t> work(grid.cellCount());
  addWork<D>(grid, p.position.span().first(p.fluidCount), this->fluidWork, work);
  // Walls that were own ones; there may be others in their places now, and then this is an estimate.
  const std::uint32_t walls = std::min(halo_.ownWalls, p.wallCount());
  addWork<D>(grid, p.position.span().subspan(p.wallBegin(), walls), this->wallWork, work);
  job.sum(std::span(work));
  owners_.assign(grid, work, job.rank(), job.size());
}

template <int D>
void Decomposition<D, Cpu>::migrate(const Communicator& job, const CellGrid<D>& grid, Particles<D>& p) {
  std::vector<std::vector<std::uint32_t>> to(job.size());
  for (std::uint32_t i = 0; i < p.fluidCount; ++i) to[owners_.owner(cellAt(grid, p.position[i]))].push_back(i);
  std::vector<std::vector<std::byte>> sent(job.size());
  for (int r = 0; r < job.size(); ++r)
    if (r != job.rank()) sent[r] = packed<D>(p, to[r]);
  const std::size_t each = packedBytes(p);
  const std::vector<std::vector<std::byte>> received = job.swap(sent);
  std::size_t incoming = 0;
  for (const auto& bytes : received) incoming += bytes.size() / each;
  keepFluid<D>(p, to[job.rank()], static_cast<std::uint32_t>(incoming));
  auto next = static_cast<std::uint32_t>(to[job.rank()].size());
  for (const auto& bytes : received) {
    const auto count = static_cast<std::uint32_t>(bytes.size() / each);
    unpack<D>(bytes, p, next, count);
    next += count;
  }
}

#define TREACLE_INSTANTIATE(D)                                                                               \
  template void Decomposition<D, Cpu>::sort(Context<Cpu>&, const CellGrid<D>&, Particles<D>&, CellRanges<>&, \
                                            SortWorkspace<>&);
TREACLE_INSTANTIATE(2)
TREACLE_INSTANTIATE(3)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
