#pragma once

#include "treacle/core/backend.hpp"
#include "treacle/model/particles/particles.hpp"
#include "treacle/search/cell_sort.hpp"
#include "treacle/search/process_parts.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace treacle {

/// The part of a simulation that is one process's. A process owns the fluid and the walls of its cells
/// (CellOwners). Beside them it holds ghosts, copies of the active particles in the cells of others that touch its
/// own: a cell is as long as any sum reaches, so sums over the neighbours of own particles find everything. Walls
/// are known to all processes; those that are neither own nor ghosts count as inactive.
///
/// sort() sorts by cell as sortByCell does, of each group the own particles first, and by id where keys are the
/// same. Fluid that has left the own cells goes to the process that owns it now, with all its fields, and cells
/// change hands where one process has too much to do. Ghosts have positions, materials and sides of thin sheets;
/// their other fields are not defined. The first time every process comes with some of the fluid, whichever, and
/// all walls. Where there are more processes than cells with fluid some of them have none. Collective. Errors:
/// RunError, at all processes, for positions that are not finite.
template <int D, class Backend = Cpu>
class Decomposition;

template <int D>
class Decomposition<D, Cpu> : public ProcessParts<D, Cpu> {
 public:
  void sort(Context<Cpu>&, const CellGrid<D>& grid, Particles<D>& particles, CellRanges<>& ranges,
            SortWorkspace<>& workspace);

  /// Per cell, in the backend's memory; null before the first sort.
  const std::int32_t* cellOwners() const { return owners_.view().owner; }
  std::size_t bytes() const { return owners_.bytes() + halo_.bytes() + fluidCells_.bytes(); }

 private:
  using ProcessParts<D, Cpu>::owners_, ProcessParts<D, Cpu>::halo_;

  void balance(const Communicator&, const CellGrid<D>&, const Particles<D>&);
  void migrate(const Communicator&, const CellGrid<D>&, Particles<D>&);
  void findActiveCells(const Communicator&, const CellGrid<D>&, const Particles<D>&, SortWorkspace<>&);
  void sortFluid(const CellGrid<D>&, Particles<D>&, CellRanges<>&, SortWorkspace<>&);
  void sortWalls(const CellGrid<D>&, Particles<D>&, CellRanges<>&, SortWorkspace<>&);
  /// Lists of the particles [begin, end) whose cells touch those of others.
  void listSent(const CellGrid<D>&, std::span<const Vec<D>> position, std::uint32_t begin, std::uint32_t end,
                Buffer<std::uint32_t>& sent, std::uint32_t Halo<Cpu>::Neighbour::*count);

  Buffer<std::uint8_t> fluidCells_;  // per cell: some process has fluid in it
};

/// Needs the context's link. The host waits four times in a sort, and once more for each exchange of a link by way
/// of its memory. Where memory gives out, particles may be left with the values of others: there is no room for
/// all of their fields twice.
template <int D>
class Decomposition<D, Cuda> : public ProcessParts<D, Cuda> {
 public:
  void sort(Context<Cuda>&, const CellGrid<D>& grid, Particles<D, Cuda>& particles, CellRanges<Cuda>& ranges,
            SortWorkspace<Cuda>& workspace);

  const std::int32_t* cellOwners() const { return owner_.data(); }
  std::size_t bytes() const {
    return owners_.bytes() + halo_.bytes() + owner_.bytes() + place_.bytes() + borderCell_.bytes() +
           borderBegin_.bytes() + borderStart_.bytes() + fluidCells_.bytes();
  }

 private:
  using ProcessParts<D, Cuda>::owners_, ProcessParts<D, Cuda>::halo_;
  using Neighbour = typename Halo<Cuda>::Neighbour;

  void divide(Context<Cuda>&, const CellGrid<D>&, const Particles<D, Cuda>&);
  void adoptOwners(Context<Cuda>&, const CellGrid<D>&);
  /// Returns whether any process has other fluid now.
  bool migrate(Context<Cuda>&, const CellGrid<D>&, Particles<D, Cuda>&, SortWorkspace<Cuda>&);
  void findActiveCells(Context<Cuda>&, const CellGrid<D>&, const Particles<D, Cuda>&, const CellRanges<Cuda>&,
                       SortWorkspace<Cuda>&);
  void listSentFluid(Context<Cuda>&, const CellRanges<Cuda>&, SortWorkspace<Cuda>&);
  void sortWalls(Context<Cuda>&, const CellGrid<D>&, const Particles<D, Cuda>&, CellRanges<Cuda>&,
                 SortWorkspace<Cuda>&);
  /// How many particles of the ranges are for whom: `starts`, per rank and the end, in device memory.
  void countSent(Context<Cuda>&, const Buffer<std::uint32_t, Cuda>& rangeBegin,
                 const Buffer<std::uint32_t, Cuda>& rangeEnd, std::uint32_t* starts);
  /// The particles that were counted; `starts`: in host memory.
  void listSent(Context<Cuda>&, const Buffer<std::uint32_t, Cuda>& rangeBegin,
                const Buffer<std::uint32_t, Cuda>& rangeEnd, std::span<const std::uint32_t> starts,
                Buffer<std::uint32_t, Cuda>& sent, std::uint32_t Neighbour::*count);

  CellOwnersView view() const { return {owner_.data(), place_.data()}; }

  // Of owners_, for kernels.
  Buffer<std::int32_t, Cuda> owner_;
  Buffer<CellPlace, Cuda> place_;
  Buffer<std::uint32_t, Cuda> borderCell_;   // CellOwners::borders, one rank after the other
  Buffer<std::uint32_t, Cuda> borderBegin_;  // where those of each rank begin, and the end
  Buffer<std::uint32_t, Cuda> borderStart_;  // of each border's particles among all that are sent, and the end
  Buffer<std::uint8_t, Cuda> fluidCells_;    // per cell: some process has fluid in it
};

}  // namespace treacle
