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
template <int D, class Backend>
void numberNodes(Context<Backend>&, const HatLattice<D>& lattice, std::span<const std::uint8_t> active,
                 HatNodes<D, Backend>& nodes);

/// Number of values that are not zero.
template <class Backend>
std::uint32_t countNodes(Context<Backend>&, std::span<const std::uint8_t> active);

/// The same, divided between processes. `owner`, `active`: per lattice point, the same at all processes;
/// `carried`: per lattice point, not zero where this process has nodes of a finer grid at which the point's hat
/// does not vanish, or empty. Collective.
template <int D, class Backend>
void divideNodes(Context<Backend>&, const HatLattice<D>& lattice, Buffer<std::int32_t, Backend> owner,
                 Buffer<std::uint8_t, Backend> active, std::span<const std::uint8_t> carried,
                 HatNodes<D, Backend>& nodes);

/// So many nodes are never divided.
inline constexpr std::uint64_t anyNumber = std::numeric_limits<std::uint64_t>::max();

/// Nodes of the lattice of twice the edge: those whose hats do not vanish at all fine nodes. Where those are
/// divided these are, too, if there are more than `mostWhole`; then it is collective.
template <int D, class Backend>
void coarserNodes(Context<Backend>&, const HatNodes<D, Backend>& fine, HatNodes<D, Backend>& coarse,
                  std::uint64_t mostWhole = anyNumber);

/// Pattern that couples each node to all within `reach` (1 … hatReach), in the order of forEachNear on both
/// backends; the blocks, B numbers per node, are there, but not set.
template <int D, int B, class Backend>
void hatPattern(Context<Backend>&, const HatNodes<D, Backend>& nodes, BlockCsr<B, double, Backend>& a,
                int reach = hatReach);

/// Sums what the processes that share the simulation have of each element, in the pattern of hatPattern with this
/// reach: then the rows of own nodes have the sums, and those of ghosts mean nothing.
template <int D, int B, class Backend>
void sumRows(Context<Backend>&, const HatNodes<D, Backend>& nodes, int reach, BlockCsr<B, double, Backend>& a);

/// Galerkin operator P^T A P on the coarser nodes, P being the interpolation by hats of each of the B numbers per
/// node; in the pattern of hatPattern with this reach, beyond which `a` must not reach either. Of divided nodes
/// the rows of own ones.
template <int D, int B, class Backend>
void coarsenHats(Context<Backend>&, const HatNodes<D, Backend>& fine, const BlockCsr<B, double, Backend>& a,
                 const HatNodes<D, Backend>& coarse, BlockCsr<B, double, Backend>& coarseA, int reach = hatReach);

/// The fine points that a coarse row of coarsenHats sums over lie at most `reach` + 1 steps from its own: so many.
template <int D>
constexpr int hatGatherPlaces(int reach) {
  const int wide = 2 * (reach + 1) + 1;
  return D == 2 ? wide * wide : wide * wide * wide;
}

/// For the sources of both backends: hat_nodes and hat_division.
#define TREACLE_HAT_NODES(D, Backend)                                                               \
  template void numberNodes(Context<Backend>&, const HatLattice<D>&, std::span<const std::uint8_t>, \
                            HatNodes<D, Backend>&);                                                 \
  template void coarserNodes(Context<Backend>&, const HatNodes<D, Backend>&, HatNodes<D, Backend>&, \
                             std::uint64_t);                                                        \
  TREACLE_HAT_MATRICES(D, 1, Backend)                                                               \
  TREACLE_HAT_MATRICES(D, D, Backend)
#define TREACLE_HAT_MATRICES(D, B, Backend)                                                                      \
  template void hatPattern(Context<Backend>&, const HatNodes<D, Backend>&, BlockCsr<B, double, Backend>&, int);  \
  template void coarsenHats(Context<Backend>&, const HatNodes<D, Backend>&, const BlockCsr<B, double, Backend>&, \
                            const HatNodes<D, Backend>&, BlockCsr<B, double, Backend>&, int);
#define TREACLE_HAT_DIVISION(D, Backend)                                                                          \
  template void divideNodes(Context<Backend>&, const HatLattice<D>&, Buffer<std::int32_t, Backend>,               \
                            Buffer<std::uint8_t, Backend>, std::span<const std::uint8_t>, HatNodes<D, Backend>&); \
  template void sumRows(Context<Backend>&, const HatNodes<D, Backend>&, int, BlockCsr<1, double, Backend>&);      \
  template void sumRows(Context<Backend>&, const HatNodes<D, Backend>&, int, BlockCsr<D, double, Backend>&);

}  // namespace treacle
