#include "starting_part.hpp"

#include "moving_bodies.hpp"
#include "treacle/core/processes.hpp"
#include "treacle/model/particles_copy.hpp"
#include "treacle/search/particle_sort.hpp"
#include "treacle/step/near_blocks.hpp"
#include "treacle/step/shareable.hpp"
#include "walls_of_all.hpp"

#include <algorithm>
#include <functional>
#include <numeric>
#include <vector>

namespace treacle {
namespace {

std::uint64_t fluidIn(const CellRanges<>& ranges, std::size_t cell) {
  return ranges.fluidEnd[cell] - ranges.fluidBegin[cell];
}
std::uint64_t wallsIn(const CellRanges<>& ranges, std::size_t cell) {
  return ranges.wallEnd[cell] - ranges.wallBegin[cell];
}

}  // namespace

template <int D>
StartingWork<D>::StartingWork(const Case& c, const CellGrid<D>& grid, const CellRanges<>& ranges, int processes)
    : work_(grid.cellCount()), processes_(processes) {
  std::uint64_t filled = 0;
  for (std::size_t cell = 0; cell < work_.size(); ++cell) {
    filled += fluidIn(ranges, cell) > 0;
    work_[cell] = static_cast<std::uint32_t>(this->fluidWork * fluidIn(ranges, cell) +
                                             this->wallWork * wallsIn(ranges, cell));
  }
  requireCells(c, filled, processes);
}

/// By what particles take in three dimensions: a wall particle a third or so of what an own fluid particle takes,
/// a ghost, which has no list, an eighth.
template <int D>
std::vector<int> StartingWork<D>::fullest(const CellGrid<D>& grid, const CellRanges<>& ranges,
                                          std::size_t most) const {
  constexpr std::uint64_t ofFluid = 8, ofWall = 3, ofGhost = 1;
  CellOwners<D> owners;
  owners.assign(grid, work_, 0, processes_);
  std::vector<std::uint64_t> memory(processes_);
  std::vector<int> holders;
  for (std::size_t cell = 0; cell < work_.size(); ++cell) {
    if (work_[cell] == 0) continue;
    const int own = owners.owner(cell);
    memory[own] += ofFluid * fluidIn(ranges, cell) + ofWall * wallsIn(ranges, cell);
    holders.assign(1, own);
    forEachAdjacentCell(grid, grid.cellAt(cell), [&](const Vec<D, int>& at) {
      const int other = owners.owner(grid.linear(at));
      if (std::ranges::find(holders, other) != holders.end()) return;
      holders.push_back(other);
      memory[other] += ofGhost * fluidIn(ranges, cell);
    });
  }
  std::vector<int> ranks(processes_);
  std::iota(ranks.begin(), ranks.end(), 0);
  std::ranges::stable_sort(ranks, std::greater{}, [&](int r) { return memory[r]; });
  ranks.resize(std::min(most, ranks.size()));
  return ranks;
}

template <int D>
StartingPart<D>::StartingPart(const Case& c, const CellGrid<D>& grid, const Particles<D>& all)
    : has_(all.has), modes_(all.modeCount()), hasSurfaces_(!all.wallSurface.empty()) {
  NearBlocks<D> near(c, grid);
  near.add(all);
  particles_ = nearParticles(near, all);
  distant_ = all.wallCount() - particles_.wallCount();
  wallsMove_ = someWallMoves(c, particles_);
  sortByCell(context_, grid, particles_, ranges_, workspace_);
}

/// As DistantWalls and the first sort do it.
template <int D>
StartingPart<D>::StartingPart(const Case& c, const CellGrid<D>& grid, const Particles<D>& some,
                              const Communicator& processes)
    : has_(some.has), modes_(some.modeCount()), rank_(processes.rank()) {
  context_.communicator = &processes;
  requireCells(c, grid, some, processes);
  NearBlocks<D> near(c, grid);
  near.add(some);
  near.unite(processes);
  particles_ = nearParticles(near, some);
  distant_ = some.wallCount() - particles_.wallCount();
  hasSurfaces_ = sumOverProcesses(context_, !some.wallSurface.empty()) > 0;
  {
    Context<Cpu> host;
    Particles<D> own;
    copyWallsToHost(host, particles_, own);
    replaceWalls(host, wallsOfAll(processes, own, hasSurfaces_), particles_);
  }
  wallsMove_ = sumOverProcesses(context_, someWallMoves(c, particles_)) > 0;
  decomposition_.sort(context_, grid, particles_, ranges_, workspace_);
  owner_ = decomposition_.cellOwners();
  sharing_.processes = processes.size();
  sharing_.ghostWalls = ranges_.ghostWalls;
  sharing_.sentFluid = context_.halo->sentFluid.size();
  sharing_.sentWalls = context_.halo->sentWalls.size();
}

template <int D>
StartingPart<D>::StartingPart(const StartingPart& whole, const CellGrid<D>& grid, const StartingWork<D>& work,
                              int rank)
    : whole_(&whole),
      has_(whole.has_),
      modes_(whole.modes_),
      distant_((whole.distant_ + work.processes() - 1) / work.processes()),
      hasSurfaces_(whole.hasSurfaces_),
      rank_(rank),
      wallsMove_(whole.wallsMove_) {
  owners_.assign(grid, work.perCell(), rank, work.processes());
  owner_ = owners_.view().owner;
  sharing_.processes = static_cast<std::uint64_t>(work.processes());
  take(grid);
  countSent(grid);
}

/// Own fluid, ghost fluid, own walls, ghost walls and the other walls, each in the order that all are in.
template <int D>
void StartingPart<D>::take(const CellGrid<D>& grid) {
  const Particles<D>& all = whole_->particles_;
  const std::uint32_t fluid = all.fluidCount, active = whole_->ranges_.activeCount;
  std::vector<std::uint32_t> chosen;
  const auto choose = [&](std::uint32_t begin, std::uint32_t end, CellPlace place) {
    const std::size_t before = chosen.size();
    for (std::uint32_t i = begin; i < end; ++i)
      if (owners_.view().place[grid.linear(grid.cellOf(all.position[i]))] == place) chosen.push_back(i);
    return static_cast<std::uint32_t>(chosen.size() - before);
  };
  const std::uint32_t own = choose(0, fluid, CellPlace::Own), ghosts = choose(0, fluid, CellPlace::Beside);
  choose(fluid, active, CellPlace::Own);
  ranges_.ghostWalls = choose(fluid, active, CellPlace::Beside);
  ranges_.activeCount = static_cast<std::uint32_t>(chosen.size());
  sharing_.ghostWalls = ranges_.ghostWalls;

  particles_.fluidCount = own, particles_.ghostCount = ghosts;
  particles_.count = own + ghosts + all.wallCount();  // all hold all walls that are near
  particles_.position.resize(chosen.size());
  particles_.material.resize(chosen.size());
  for (auto* range : {&ranges_.fluidBegin, &ranges_.fluidEnd, &ranges_.wallBegin, &ranges_.wallEnd}) {
    range->resize(grid.cellCount());
    std::fill(range->begin(), range->end(), 0u);
  }
  ranges_.key.resize(own);
  for (std::uint32_t k = 0; k < chosen.size(); ++k) {
    const std::uint32_t i = chosen[k];
    particles_.position[k] = all.position[i];
    particles_.material[k] = all.material[i];
    if (k < own) ranges_.key[k] = whole_->ranges_.key[i];
    const std::size_t cell = grid.linear(grid.cellOf(particles_.position[k]));
    auto& begin = k < own + ghosts ? ranges_.fluidBegin : ranges_.wallBegin;
    auto& end = k < own + ghosts ? ranges_.fluidEnd : ranges_.wallEnd;
    if (end[cell] == 0) begin[cell] = k;
    end[cell] = k + 1;
  }
}

template <int D>
void StartingPart<D>::countSent(const CellGrid<D>& grid) {
  for (const std::vector<std::uint32_t>& cells : owners_.borders(grid, static_cast<int>(sharing_.processes)))
    for (const std::uint32_t cell : cells) {
      sharing_.sentFluid += fluidIn(ranges_, cell);
      sharing_.sentWalls += wallsIn(ranges_, cell);
    }
}

template <int D>
void StartingPart<D>::place(SortedParticles<D>& sorted) const {
  placeSorted(particles_, ranges_, sorted);
  sorted.owner = owner_;
}

template <int D>
void StartingPart<D>::count(MemoryCounts& counts) const {
  const std::uint64_t walls = particles_.wallCount();
  counts.particles = {particles_.fluidCount,
                      walls + distant_,
                      modes_,
                      hasSurfaces_ ? walls + distant_ : 0,
                      particles_.ghostCount,
                      has_};
  counts.nearWalls = walls;
  counts.active = ranges_.activeCount;
  counts.wallsMove = wallsMove_;
  counts.sharing = sharing_;
}

template class StartingWork<2>;
template class StartingWork<3>;
template class StartingPart<2>;
template class StartingPart<3>;

}  // namespace treacle
