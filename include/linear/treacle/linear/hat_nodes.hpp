#pragma once

#include "treacle/core/device_link.hpp"
#include "treacle/core/processes.hpp"
#include "treacle/linear/block_csr.hpp"
#include "treacle/linear/hat_division.hpp"
#include "treacle/linear/hat_lattice.hpp"

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <type_traits>

namespace treacle {

/// A lattice point without an unknown.
inline constexpr std::uint32_t noNode = ~0u;

/// What loops and kernels read of HatNodes.
template <int D>
struct HatNodesView {
  HatLattice<D> lattice;
  const std::uint32_t* nodeAt;
  const std::uint32_t* point;
  std::uint32_t count, own;    // nodes, and those of them that are not ghosts: the first ones
  const std::uint8_t* active;  // of a divided lattice

  /// Whether there is a node, be it another process's.
  TREACLE_HD bool isNode(const Vec<D, int>& p) const {
    const std::size_t k = lattice.linear(p);
    return active ? active[k] != 0 : nodeAt[k] != noNode;
  }
  TREACLE_HD std::uint32_t at(const Vec<D, int>& p) const { return nodeAt[lattice.linear(p)]; }
  TREACLE_HD Vec<D, int> pointOf(std::uint32_t node) const { return lattice.at(point[node]); }
};

/// The lattice points that carry unknowns (nodes), numbered in the order of the lattice. Where several processes
/// share a simulation each has all nodes, or they are divided: then a process's own ones come first, and the
/// ghosts after them, those of one process after the other. Of vectors, which have a value for every node, those
/// of own nodes count, and ghosts' after fillNodes().
template <int D, class Backend = Cpu>
struct HatNodes {
  HatLattice<D> lattice;
  Buffer<std::uint32_t, Backend> nodeAt;  // per lattice point: its node, or noNode
  Buffer<std::uint32_t, Backend> point;   // per node: its lattice point, ascending

  std::unique_ptr<HatDivision<Backend>> division;  // null: whole

  std::uint32_t count() const { return static_cast<std::uint32_t>(point.size()); }
  std::uint32_t own() const { return division ? division->own() : count(); }
  /// Of all processes together.
  std::uint64_t ofAll() const { return division ? division->ofAll() : count(); }
  std::size_t bytes() const { return nodeAt.bytes() + point.bytes() + (division ? division->bytes() : 0); }
  HatNodesView<D> view() const {
    return {lattice, nodeAt.data(), point.data(), count(), own(), division ? division->active.data() : nullptr};
  }
};

/// Brings the values of ghosts, B numbers per node, from their owners.
template <int B, int D, class T, class Backend>
void fillNodes(const Context<Backend>& context, const HatNodes<D, Backend>& nodes, T* values) {
  if (nodes.division) nodes.division->halo.fill(context, Held::Fluid, values, B * sizeof(T));
}

/// Sums what the processes that share the simulation have for each node, B numbers: then own nodes have the sum.
template <int B, int D, class T, class Backend>
void sumAtNodes(const Context<Backend>& context, const HatNodes<D, Backend>& nodes, std::span<T> values) {
  if (nodes.division) return nodes.division->halo.addGhosts(context, values.data(), B);
  sumOverSharing(context, values);
}

/// Nodes at the points where `active` is not zero, one value per lattice point.
template <int D>
void numberNodes(Context<Cpu>&, const HatLattice<D>& lattice, std::span<const std::uint8_t> active,
                 HatNodes<D>& nodes);
template <int D>
void numberNodes(Context<Cuda>&, const HatLattice<D>& lattice, std::span<const std::uint8_t> active,
                 HatNodes<D, Cuda>& nodes);

/// Number of values that are not zero.
std::uint32_t countNodes(Context<Cpu>&, std::span<const std::uint8_t> active);
std::uint32_t countNodes(Context<Cuda>&, std::span<const std::uint8_t> active);

/// The same, divided between processes. `owner`, `active`: per lattice point, the same at all processes;
/// `carried`: per lattice point, not zero where this process has nodes of a finer grid at which the point's hat
/// does not vanish, or empty. Collective.
template <int D>
void divideNodes(Context<Cpu>&, const HatLattice<D>& lattice, Buffer<std::int32_t> owner,
                 Buffer<std::uint8_t> active, std::span<const std::uint8_t> carried, HatNodes<D>& nodes);
template <int D>
void divideNodes(Context<Cuda>&, const HatLattice<D>& lattice, Buffer<std::int32_t, Cuda> owner,
                 Buffer<std::uint8_t, Cuda> active, std::span<const std::uint8_t> carried,
                 HatNodes<D, Cuda>& nodes);

/// So many nodes are never divided.
inline constexpr std::uint64_t anyNumber = std::numeric_limits<std::uint64_t>::max();

/// Nodes of the lattice of twice the edge: those whose hats do not vanish at all fine nodes. Where those are
/// divided these are, too, if there are more than `mostWhole`; then it is collective.
template <int D>
void coarserNodes(Context<Cpu>&, const HatNodes<D>& fine, HatNodes<D>& coarse,
                  std::uint64_t mostWhole = anyNumber);
template <int D>
void coarserNodes(Context<Cuda>&, const HatNodes<D, Cuda>& fine, HatNodes<D, Cuda>& coarse,
                  std::uint64_t mostWhole = anyNumber);

/// Pattern that couples each node to all within `reach` (1 … hatReach), in the order of forEachNear on both
/// backends; the blocks, B numbers per node, are there, but not set.
template <int D, int B>
void hatPattern(Context<Cpu>&, const HatNodes<D>& nodes, BlockCsr<B>& a, int reach = hatReach);
template <int D, int B>
void hatPattern(Context<Cuda>&, const HatNodes<D, Cuda>& nodes, BlockCsr<B, double, Cuda>& a,
                int reach = hatReach);

/// Sums what the processes that share the simulation have of each element, in the pattern of hatPattern with this
/// reach: then the rows of own nodes have the sums, and those of ghosts mean nothing.
template <int D, int B>
void sumRows(Context<Cpu>&, const HatNodes<D>& nodes, int reach, BlockCsr<B>& a);
template <int D, int B>
void sumRows(Context<Cuda>&, const HatNodes<D, Cuda>& nodes, int reach, BlockCsr<B, double, Cuda>& a);

/// Galerkin operator P^T A P on the coarser nodes, P being the interpolation by hats of each of the B numbers per
/// node; in the pattern of hatPattern with this reach, beyond which `a` must not reach either. Of divided nodes
/// the rows of own ones.
template <int D, int B>
void coarsenHats(Context<Cpu>&, const HatNodes<D>& fine, const BlockCsr<B>& a, const HatNodes<D>& coarse,
                 BlockCsr<B>& coarseA, int reach = hatReach);
template <int D, int B>
void coarsenHats(Context<Cuda>&, const HatNodes<D, Cuda>& fine, const BlockCsr<B, double, Cuda>& a,
                 const HatNodes<D, Cuda>& coarse, BlockCsr<B, double, Cuda>& coarseA, int reach = hatReach);

/// The fine points that a coarse row of coarsenHats sums over lie at most `reach` + 1 steps from its own: so many.
template <int D>
constexpr int hatGatherPlaces(int reach) {
  const int wide = 2 * (reach + 1) + 1;
  return D == 2 ? wide * wide : wide * wide * wide;
}

}  // namespace treacle
