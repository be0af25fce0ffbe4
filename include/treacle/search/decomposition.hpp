#pragma once

#include "treacle/core/halo.hpp"
#include "treacle/core/processes.hpp"
#include "treacle/model/particles.hpp"
#include "treacle/search/cell_owners.hpp"
#include "treacle/search/cell_sort.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace treacle {

/// The part of a simulation that is one process's. A process owns the fluid and the walls of its cells
/// (CellOwners). Beside them it holds ghosts, copies of the active particles in the cells of others that touch its
/// own: a cell is as long as any sum reaches, so sums over the neighbours of own particles find everything. Walls
/// are known to all processes; those that are neither own nor ghosts count as inactive.
template <int D>
class Decomposition {
 public:
  /// The work of a process may be so much more than the mean before cells change hands.
  static constexpr double mostImbalance = 1.1;

  /// Sorts by cell as sortByCell does, of each group the own particles first. Fluid that has left the own cells
  /// goes to the process that owns it now, with all its fields, and cells change hands where one process has too
  /// much to do. Ghosts have positions and materials; their other fields are not defined. The first time every
  /// process comes with all particles, and keeps its own ones. Collective. Errors: InputError the first time, if
  /// there are more processes than cells with fluid; RunError for positions that are not finite. Both at all
  /// processes.
  void sort(Context<Cpu>&, const CellGrid<D>& grid, Particles<D>& particles, CellRanges<>& ranges,
            SortWorkspace<>& workspace);

  const CellOwners<D>& owners() const { return owners_; }
  std::size_t bytes() const { return owners_.bytes() + fluidCells_.bytes(); }

 private:
  void assignFirst(const Communicator&, const CellGrid<D>&, const Particles<D>&);
  void balance(const Communicator&, const CellGrid<D>&, const Particles<D>&, const CellRanges<>&);
  void migrate(const Communicator&, const CellGrid<D>&, Particles<D>&);
  void keepOwn(const CellGrid<D>&, Particles<D>&);
  void findActiveCells(const Communicator&, const CellGrid<D>&, std::span<const Vec<D>> fluid, SortWorkspace<>&);
  void sortFluid(const CellGrid<D>&, Particles<D>&, CellRanges<>&, SortWorkspace<>&);
  void sortWalls(const CellGrid<D>&, Particles<D>&, CellRanges<>&, SortWorkspace<>&);
  /// Lists of the particles [begin, end) whose cells touch those of others.
  void listSent(const CellGrid<D>&, std::span<const Vec<D>> position, std::uint32_t begin, std::uint32_t end,
                Buffer<std::uint32_t>& sent, std::uint32_t Halo<Cpu>::Neighbour::*count);
  void countGhostFluid(const Communicator&);
  void countAll(const Communicator&);

  CellOwners<D> owners_;
  Halo<Cpu> halo_;
  Buffer<std::uint8_t> fluidCells_;  // per cell: some process has fluid in it
};

}  // namespace treacle
