#pragma once

#include "core/launch.hpp"
#include "precondition/hat_corners.cuh"
#include "treacle/linear/block_csr.hpp"
#include "treacle/linear/hat_nodes.hpp"
#include "treacle/search/sorted_particles.hpp"

namespace treacle {

/// Galerkin operators that couple the corners of a cell by what each fluid particle in it adds: what the kernels
/// read and write. `term(i, a, b)` is the block between two corners, which stand for themselves (CornerHat). Cells
/// are numbered by the node at their lower corner.
template <int D, int B, class T, class Term>
struct CornerGalerkin {
  static constexpr int corners = 1 << D, pairs = corners * corners;
  HatCells<D> cells;
  HatNodesView<D> nodes;
  CellRangesView ranges;
  const Vec<D>* position;
  Term term;
  Block<B, T>* parts;  // per cell: one block per pair of corners
  const std::uint64_t* rowStart;
  const std::uint32_t* column;
  Block<B>* block;
};

/// The hat of a corner at a particle of the cell.
template <int D, class T>
struct CornerHat {
  int corner;
  T value;
  Vec<D, T> gradient;  // [1/m]

  __device__ CornerHat(const CellGrid<D>& grid, const Vec<D, T>& place, int corner_)
      : corner(corner_), value(cornerWeight(place, corner_)) {
    for (int k = 0; k < D; ++k) {
      gradient[k] = static_cast<T>(corner >> k & 1 ? grid.inverseEdge[k] : -grid.inverseEdge[k]);
      for (int other = 0; other < D; ++other)
        if (other != k) gradient[k] *= corner >> other & 1 ? place[other] : 1 - place[other];
    }
  }
};

/// One thread per cell and pair of its corners; reads what the term reads of the cell's fluid. No atomics.
template <int D, int B, class T, class Term>
__global__ void __launch_bounds__(128) cornerPartsKernel(const __grid_constant__ CornerGalerkin<D, B, T, Term> g) {
  constexpr int corners = 1 << D, pairs = corners * corners;
  const int pair = static_cast<int>(threadIdx.x) % pairs, a = pair / corners, b = pair % corners;
  const std::uint32_t c = blockIdx.x * (blockDim.x / pairs) + threadIdx.x / pairs;
  if (c >= g.nodes.count) return;
  const Vec<D, int> cell = g.nodes.pointOf(c);
  for (int k = 0; k < D; ++k)
    if (cell[k] >= g.cells.grid.count[k]) return;  // the last nodes of an open axis are no lower corners
  Block<B> sum{};
  const std::size_t linear = g.cells.grid.linear(cell);
  for (std::uint32_t i = g.ranges.fluidBegin[linear]; i < g.ranges.fluidEnd[linear]; ++i) {
    const Vec<D> f = g.cells.fraction(g.position[i], cell);
    Vec<D, T> place;
    for (int k = 0; k < D; ++k) place[k] = static_cast<T>(f[k]);
    const Block<B, T> part =
        g.term(i, CornerHat<D, T>(g.cells.grid, place, a), CornerHat<D, T>(g.cells.grid, place, b));
    for (int k = 0; k < B * B; ++k) sum.a[k] += part.a[k];
  }
  for (int k = 0; k < B * B; ++k) g.parts[c * std::size_t{pairs} + pair].a[k] = static_cast<T>(sum.a[k]);
}

/// One thread per row and adjacent node, 32 to a row; adds up the parts of the cells that both are corners of. No
/// atomics.
template <int D, int B, class T, class Term>
__global__ void __launch_bounds__(128)
    cornerGalerkinKernel(const __grid_constant__ CornerGalerkin<D, B, T, Term> g) {
  constexpr int corners = 1 << D, pairs = corners * corners;
  const std::uint32_t row = blockIdx.x * (blockDim.x / 32) + threadIdx.x / 32;
  if (row >= g.nodes.count) return;
  const std::uint64_t entry = g.rowStart[row] + threadIdx.x % 32;
  if (entry >= g.rowStart[row + 1]) return;
  const Vec<D, int> node = g.nodes.pointOf(row), other = g.nodes.pointOf(g.column[entry]);
  Block<B> sum{};
  g.cells.forEachCellAround(node, 1, [&](const Vec<D, int>& cell) {
    const std::uint32_t c = g.nodes.at(cell);
    if (c == noNode || !g.cells.isCorner(other, cell)) return;
    const int pair = cornerOf(g.cells, node, cell) * corners + cornerOf(g.cells, other, cell);
    const Block<B, T> part = g.parts[c * std::size_t{pairs} + pair];
    for (int k = 0; k < B * B; ++k) sum.a[k] += part.a[k];
  });
  g.block[entry] = sum;
}

/// `parts`: workspace, B^2 4^D numbers per node.
template <int D, int B, class T, class Term>
void cornerGalerkin(Context<Cuda>& context, const SortedParticles<D>& particles, const HatNodes<D, Cuda>& nodes,
                    const Term& term, Buffer<T, Cuda>& parts, BlockCsr<B, double, Cuda>& a) {
  constexpr int pairs = CornerGalerkin<D, B, T, Term>::pairs;
  parts.resize(context, std::size_t{B * B * pairs} * nodes.count());
  hatPattern(context, nodes, a, 1);
  const CornerGalerkin<D, B, T, Term> g{.cells = {particles.grid},
                                        .nodes = nodes.view(),
                                        .ranges = particles.cells,
                                        .position = particles.position.data(),
                                        .term = term,
                                        .parts = reinterpret_cast<Block<B, T>*>(parts.data()),
                                        .rowStart = a.rowStart.data(),
                                        .column = a.column.data(),
                                        .block = a.value.data()};
  launch(context, blocksFor(std::size_t{nodes.count()} * pairs, 128), 128, 0, cornerPartsKernel<D, B, T, Term>, g);
  launch(context, blocksFor(nodes.count(), 4), 128, 0, cornerGalerkinKernel<D, B, T, Term>, g);
}

}  // namespace treacle
