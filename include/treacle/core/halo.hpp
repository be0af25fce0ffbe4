#pragma once

#include "treacle/core/communicator.hpp"
#include "treacle/core/cuda.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

namespace treacle {

/// What a field has a value for: fluid, or fluid and active walls.
enum class Held { Fluid, Active };

/// The particles of other processes that a process needs the values of, its ghosts, and those of its own that
/// others need. Fields hold [0, ownFluid) own fluid, [ownFluid, fluid) ghost fluid, [fluid, fluid + ownWalls) own
/// walls and then ghost walls; ghosts stand in the order of the ranks that own them.
class Halo {
 public:
  struct Neighbour {
    int rank = 0;
    std::vector<std::uint32_t> sentFluid, sentWalls;  // indices
    std::uint32_t fluid = 0, walls = 0;               // ghosts that are that rank's
  };

  /// Of the particles of this process as they are sorted now.
  std::vector<Neighbour> neighbours;  // in the order of ranks
  std::uint32_t ownFluid = 0, fluid = 0, ownWalls = 0;
  // Number of particles that the processes before this one own: with it, an index counts over all processes.
  std::uint64_t fluidBefore = 0, wallsBefore = 0, fluidOfAll = 0;
  bool someHaveNone = false;  // some process owns no fluid

  /// Brings the ghosts' values, `size` bytes each, from their owners.
  void fill(const Communicator& communicator, Held held, void* field, std::size_t size);

  /// Place of an own particle among those of all processes, fluid first.
  std::uint64_t indexOfAll(std::uint32_t i) const {
    return i < fluid ? fluidBefore + i : fluidOfAll + wallsBefore + (i - fluid);
  }
  bool isGhost(std::uint32_t i) const { return i < fluid ? i >= ownFluid : i >= fluid + ownWalls; }

 private:
  std::vector<std::byte> packed_;
};

/// Brings the ghosts of a field from the processes that own them. This is where computing on what needs no ghosts
/// could hide the time of the exchange: what follows waits for it.
template <class T>
void fillGhosts(const Context<Cpu>& context, Held held, T* field) {
  static_assert(std::is_trivially_copyable_v<T>);
  if (context.halo) context.halo->fill(*context.communicator, held, field, sizeof(T));
}
/// A simulation on a device is alone.
template <class T>
void fillGhosts(const Context<Cuda>&, Held, T*) {}

}  // namespace treacle
