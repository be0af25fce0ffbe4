#pragma once

#include "treacle/core/buffer.hpp"
#include "treacle/core/communicator.hpp"
#include "treacle/core/copy_values.hpp"
#include "treacle/core/cuda.hpp"
#include "treacle/core/macros.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

namespace treacle {

/// What a field has a value for: fluid, or fluid and active walls.
enum class Held { Fluid, Active };

/// The particles of other processes that a process needs the values of, its ghosts. Fields hold [0, ownFluid) own
/// fluid, [ownFluid, fluid) ghost fluid, [fluid, fluid + ownWalls) own walls and then ghost walls; ghosts stand in
/// the order of the ranks that own them. All this of the particles as they are sorted now.
struct HaloCounts {
  std::uint32_t ownFluid = 0, fluid = 0, ownWalls = 0;
  // Number of particles that the processes before this one own: with it, an index counts over all processes.
  std::uint64_t fluidBefore = 0, wallsBefore = 0, fluidOfAll = 0;
  bool someHaveNone = false;  // some process owns no fluid

  /// Place of an own particle among those of all processes, fluid first.
  TREACLE_HD std::uint64_t indexOfAll(std::uint32_t i) const {
    return i < fluid ? fluidBefore + i : fluidOfAll + wallsBefore + (i - fluid);
  }
  bool isGhost(std::uint32_t i) const { return i < fluid ? i >= ownFluid : i >= fluid + ownWalls; }
};

/// With those particles of its own that others need. The nodes of a grid that is divided between processes have
/// one, too (linear/hat_division.hpp): there they are what is called fluid here.
template <class Backend>
class Halo : public HaloCounts {
 public:
  struct Neighbour {
    int rank = 0;
    std::uint32_t sentFluid = 0, sentWalls = 0;  // how many of `sentFluid` and `sentWalls` are for that rank
    std::uint32_t fluid = 0, walls = 0;          // ghosts that are that rank's
  };
  std::vector<Neighbour> neighbours;                    // in the order of ranks
  Buffer<std::uint32_t, Backend> sentFluid, sentWalls;  // indices, for one neighbour after the other

  /// Brings the ghosts' values, `size` bytes each, from their owners.
  void fill(const Context<Backend>& context, Held held, void* field, std::size_t size);
  /// The way back: every owner's value of the fluid is added to by those that its ghosts have, in the order of
  /// ranks; `numbers` of a value. The ghosts keep theirs.
  template <class T>
  void addGhosts(const Context<Backend>& context, T* field, std::size_t numbers);
  /// Brings the ghost fluid's values, which stand in `ghosts` in their order, to their owners: into `arrived`, in
  /// the order of sentFluid.
  void returnGhosts(const Context<Backend>& context, const void* ghosts, std::size_t size, void* arrived);
  /// Makes room for values of up to so many bytes: neither filling them nor adding them will allocate.
  void reserve(const Context<Backend>& context, std::size_t size) {
    packed_.resize(context, (sentFluid.size() + sentWalls.size()) * size);
  }

  std::size_t bytes() const { return sentFluid.bytes() + sentWalls.bytes() + packed_.bytes(); }

 private:
  /// What goes where, once it is packed: for one neighbour after the other its fluid, then its walls.
  struct Messages {
    std::vector<Communicator::Message> sent, received;
  };
  Messages messages(Held held, void* field, std::size_t size);
  void messagesBack(const void* ghosts, std::size_t size, void* arrived, Messages& messages) const;
  bool exchangeGathered(const Context<Backend>& context, Held held, void* field, std::size_t size);
  std::size_t sentCount(Held held) const {
    return sentFluid.size() + (held == Held::Active ? sentWalls.size() : 0);
  }

  Buffer<std::byte, Backend> packed_;
};

/// Brings the ghosts of a field from the processes that own them. This is where computing on what needs no ghosts
/// could hide the time of the exchange: what follows waits for it.
template <class T, class Backend>
void fillGhosts(const Context<Backend>& context, Held held, T* field) {
  static_assert(std::is_trivially_copyable_v<T>);
  if (context.halo) context.halo->fill(context, held, field, sizeof(T));
}

/// A field of the own fluid with its ghosts behind, in `room`; the field itself where nobody has any.
template <class T, class Backend>
std::span<const T> withGhosts(Context<Backend>& context, std::span<const T> own, Buffer<T, Backend>& room) {
  if (!context.halo) return own;
  room.resize(context, context.halo->fluid);
  copyValues(context, own, room.data());
  fillGhosts(context, Held::Fluid, room.data());
  return room.span();
}

}  // namespace treacle
