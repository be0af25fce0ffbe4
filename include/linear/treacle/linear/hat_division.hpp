#pragma once

#include "treacle/core/buffer.hpp"
#include "treacle/core/cuda.hpp"
#include "treacle/core/halo.hpp"
#include "treacle/linear/hat_lattice.hpp"

#include <cstddef>
#include <cstdint>

namespace treacle {

/// How the nodes of a lattice are divided between the processes of a simulation. A process owns the nodes at its
/// points: it has the rows of a matrix for them, and values. Behind those it has copies of other processes' nodes,
/// ghosts, which its rows and its transfers between grids read.
template <class Backend>
struct HatDivision {
  Buffer<std::int32_t, Backend> owner;   // per lattice point: the process whose it is
  Buffer<std::uint8_t, Backend> active;  // per lattice point: whether it is a node, be it of another process
  Halo<Backend> halo;                    // of the nodes, which it calls fluid

  std::uint32_t own() const { return halo.ownFluid; }
  std::uint64_t ofAll() const { return halo.fluidOfAll; }
  std::size_t bytes() const { return owner.bytes() + active.bytes() + halo.bytes(); }
};

/// A divided lattice as loops read it; host or device memory.
template <int D>
struct DividedLattice {
  HatLattice<D> lattice;
  const std::int32_t* owner;
  const std::uint8_t* active;
  std::int32_t rank;

  /// Whether the row of a node at an own point may have a node at this point as its column. Own points without a
  /// node count, too: of a cell that touches an empty own one a process has the particles, and then their nodes.
  TREACLE_HD bool isNearOwn(const Vec<D, int>& point) const {
    const HatBox<D> box = HatBox<D>::around(lattice, point, hatReach);
    for (int n = 0, end = box.size(); n < end; ++n)
      if (owner[lattice.linear(box.at(n))] == rank) return true;
    return false;
  }
};

/// What a process has of a point: nothing, a node of its own, or a copy of another process's.
enum class NodePlace : std::uint8_t { None, Own, Ghost };

/// `isCarried`: whether the process has nodes of the finer grid at which the hat of this point does not vanish.
template <int D>
TREACLE_HD NodePlace nodePlace(const DividedLattice<D>& divided, std::size_t point, bool isCarried) {
  if (!divided.active[point]) return NodePlace::None;
  if (divided.owner[point] == divided.rank) return NodePlace::Own;
  return isCarried || divided.isNearOwn(divided.lattice.at(point)) ? NodePlace::Ghost : NodePlace::None;
}

/// Points of the lattice of twice the edge are those of the processes that own the points they stand on; one that
/// stands beyond the end is the last one's.
template <int D>
TREACLE_HD std::size_t pointBelow(const HatLattice<D>& fine, const Vec<D, int>& coarsePoint) {
  Vec<D, int> p{};
  for (int k = 0; k < D; ++k) {
    const int last = fine.count[k] - 1;
    p[k] = 2 * coarsePoint[k] < last ? 2 * coarsePoint[k] : last;
  }
  return fine.linear(p);
}

}  // namespace treacle
