#pragma once

#include "treacle/linear/block_csr.hpp"
#include "treacle/linear/hat_lattice.hpp"

#include <cstdint>
#include <span>

namespace treacle {

/// A lattice point without an unknown.
inline constexpr std::uint32_t noNode = ~0u;

/// What loops and kernels read of HatNodes.
template <int D>
struct HatNodesView {
  HatLattice<D> lattice;
  const std::uint32_t* nodeAt;
  const std::uint32_t* point;
  std::uint32_t count;

  TREACLE_HD std::uint32_t at(const Vec<D, int>& p) const { return nodeAt[lattice.linear(p)]; }
  TREACLE_HD Vec<D, int> pointOf(std::uint32_t node) const { return lattice.at(point[node]); }
};

/// The lattice points that carry unknowns (nodes), numbered in the order of the lattice.
template <int D, class Backend = Cpu>
struct HatNodes {
  HatLattice<D> lattice;
  Buffer<std::uint32_t, Backend> nodeAt;  // per lattice point: its node, or noNode
  Buffer<std::uint32_t, Backend> point;   // per node: its lattice point, ascending

  std::uint32_t count() const { return static_cast<std::uint32_t>(point.size()); }
  std::size_t bytes() const { return nodeAt.bytes() + point.bytes(); }
  HatNodesView<D> view() const { return {lattice, nodeAt.data(), point.data(), count()}; }
};

/// Nodes at the points where `active` is not zero, one value per lattice point.
template <int D>
void numberNodes(Context<Cpu>&, const HatLattice<D>& lattice, std::span<const std::uint8_t> active,
                 HatNodes<D>& nodes);
template <int D>
void numberNodes(Context<Cuda>&, const HatLattice<D>& lattice, std::span<const std::uint8_t> active,
                 HatNodes<D, Cuda>& nodes);

/// Nodes of the lattice of twice the edge: those whose hats do not vanish at all fine nodes.
template <int D>
void coarserNodes(Context<Cpu>&, const HatNodes<D>& fine, HatNodes<D>& coarse);
template <int D>
void coarserNodes(Context<Cuda>&, const HatNodes<D, Cuda>& fine, HatNodes<D, Cuda>& coarse);

/// Pattern that couples each node to all within `reach` (1 … hatReach), in the order of forEachNear on both
/// backends; the blocks, B numbers per node, are there, but not set.
template <int D, int B>
void hatPattern(Context<Cpu>&, const HatNodes<D>& nodes, BlockCsr<B>& a, int reach = hatReach);
template <int D, int B>
void hatPattern(Context<Cuda>&, const HatNodes<D, Cuda>& nodes, BlockCsr<B, double, Cuda>& a,
                int reach = hatReach);

/// Galerkin operator P^T A P on the coarser nodes, P being the interpolation by hats of each of the B numbers per
/// node; in the pattern of hatPattern with this reach, beyond which `a` must not reach either.
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
