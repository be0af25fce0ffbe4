#pragma once

#include "treacle/core/communicator.hpp"
#include "treacle/core/halo.hpp"
#include "treacle/model/case.hpp"
#include "treacle/model/particles.hpp"
#include "treacle/search/cell_sort.hpp"
#include "treacle/search/decomposition.hpp"
#include "treacle/search/sorted_particles.hpp"
#include "treacle/step/memory_counts.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace treacle {

/// The work that the cells are given out by at the start, as ProcessParts does it, where all particles are in this
/// process.
template <int D>
class StartingWork : private ProcessParts<D, Cpu> {
 public:
  /// `ranges`: of all particles. Errors: InputError if there are more processes than cells with fluid.
  StartingWork(const Case& c, const CellGrid<D>& grid, const CellRanges<>& ranges, int processes);

  int processes() const { return processes_; }
  std::span<const std::uint32_t> perCell() const { return work_; }
  /// Those that hold the most particles, `most` of them or all: a guess of who needs the most memory.
  std::vector<int> fullest(const CellGrid<D>& grid, const CellRanges<>& ranges, std::size_t most) const;

 private:
  std::vector<std::uint32_t> work_;
  int processes_;
};

/// What the first step of a simulation has, or that of one of the processes that share it: its particles without
/// distant walls, sorted, with ghosts where there are other processes. Positions, materials and ranges alone.
template <int D>
class StartingPart {
 public:
  /// Of a simulation that is alone.
  StartingPart(const Case& c, const CellGrid<D>& grid, const Particles<D>& all);
  /// Of this process; each has some of the particles. Collective. Errors: InputError if there are more of them
  /// than cells with fluid; those of Decomposition::sort.
  StartingPart(const Case& c, const CellGrid<D>& grid, const Particles<D>& some, const Communicator& processes);
  /// Of one of several processes, where this one has all; `whole` must outlive it.
  StartingPart(const StartingPart& whole, const CellGrid<D>& grid, const StartingWork<D>& work, int rank);

  Context<Cpu>& context() { return context_; }
  const CellRanges<>& ranges() const { return ranges_; }
  /// Of the fluid and the walls of all processes, or of what this one has where it cannot know.
  const CellRanges<>& rangesOfAll() const { return whole_ ? whole_->ranges_ : ranges_; }
  /// Per cell; null where there is one process.
  const std::int32_t* owners() const { return owner_; }
  int rank() const { return rank_; }

  /// Makes `sorted` look at them.
  void place(SortedParticles<D>& sorted) const;
  /// All of MemoryCounts that is a number of particles.
  void count(MemoryCounts& counts) const;

 private:
  void take(const CellGrid<D>& grid);
  void countSent(const CellGrid<D>& grid);

  Context<Cpu> context_;
  Particles<D> particles_;
  const StartingPart* whole_ = nullptr;
  Decomposition<D, Cpu> decomposition_;  // of processes that are there
  CellOwners<D> owners_;                 // of those that are not
  CellRanges<> ranges_;
  SortWorkspace<> workspace_;
  FluidExtras has_{};
  std::uint64_t modes_ = 0;
  std::uint64_t distant_ = 0;  // walls of this process's part
  bool hasSurfaces_ = false;
  const std::int32_t* owner_ = nullptr;
  int rank_ = 0;
  bool wallsMove_ = false;
  MemoryCounts::Sharing sharing_;
};

}  // namespace treacle
