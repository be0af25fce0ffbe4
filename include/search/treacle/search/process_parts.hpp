#pragma once

#include "treacle/core/halo.hpp"
#include "treacle/core/processes.hpp"
#include "treacle/search/cell_owners.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace treacle {

/// What a process knows of the parts that it and the others have, wherever its particles are: who owns which
/// cells, and how many particles each has, or needs of whom.
template <int D, class Backend>
class ProcessParts {
 public:
  /// The work of a process may be so much more than the mean before cells change hands.
  static constexpr double mostImbalance = 1.1;

  const CellOwners<D>& owners() const { return owners_; }

 protected:
  /// Work of a fluid particle and of an active wall particle. The products of a solve take the neighbours of both,
  /// those of a wall particle the fluid among them and one of two products.
  static constexpr std::uint32_t fluidWork = 4, wallWork = 1;

  /// Gives the cells out for the first time; each process has some of the fluid, whichever, and all walls.
  void assignFirst(const Communicator&, const CellGrid<D>&, std::span<const Vec<D>> fluid,
                   std::span<const Vec<D>> walls);
  /// Whether cells are to change hands, now that this process has so many fluid particles. Once they are as evenly
  /// given out as they can be, it is not tried again until that has become worse, or much fluid has come in.
  /// Collective.
  bool isUneven(const Communicator&, std::uint32_t fluid) const;

  /// The halo's numbers: of own fluid; then, from what is sent to whom, of ghost fluid; then, once all else is
  /// known, of what all processes have.
  void startHalo(const Communicator&, std::uint32_t ownFluid);
  void countGhostFluid(const Communicator&);
  void countAll(const Communicator&);

  CellOwners<D> owners_;
  Halo<Backend> halo_;
};

}  // namespace treacle
