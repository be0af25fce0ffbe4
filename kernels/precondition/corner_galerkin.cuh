#pragma once

#include "core/launch.hpp"
#include "precondition/hat_corners.cuh"
#include "precondition/own_cells.cuh"
#include "treacle/linear/block_csr.hpp"
#include "treacle/linear/hat_nodes.hpp"
#include "treacle/search/sorted_particles.hpp"

namespace treacle {

/// Galerkin operators that couple the corners of a cell by what each fluid particle in it adds: what the kernels
/// read and write. `term(i, a, b)` is the block between two corners, which stand for themselves (CornerHat).
template <int D, int B, class T, class Term>
struct CornerGalerkin {
  static constexpr int corners = 1 << D, pairs = corners * corners;
  HatCells<D> cells;
  HatNodesView<D> nodes;
  OwnCellsView own;
  OwnRanges ranges;
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

  CornerHat() = default;
  __device__ CornerHat(const CellGrid<D>& grid, const Vec<D, T>& place, int corner_)
      : corner(corner_), value(cornerWeight(place, corner_)) {
    for (int k = 0; k < D; ++k) {
      gradient[k] = static_cast<T>(corner >> k & 1 ? grid.inverseEdge[k] : -grid.inverseEdge[k]);
      for (int other = 0; other < D; ++other)
        if (other != k) gradient[k] *= corner >> other & 1 ? place[other] : 1 - place[other];
    }
  }
};

/// One thread per cell and pair of its corners; reads what the term reads of the cell's fluid. The threads of a
/// cell make the hats of as many particles at a time as it has corners, one each. No atomics.
template <int D, int B, class T, class Term>
__global__ void __launch_bounds__(128) cornerPartsKernel(const __grid_constant__ CornerGalerkin<D, B, T, Term> g) {
  constexpr int corners = 1 << D, pairs = corners * corners;
  __shared__ CornerHat<D, T> hats[128];  // per particle and corner
  const std::uint32_t c = blockIdx.x * (blockDim.x / pairs) + threadIdx.x / pairs;
  const int own = static_cast<int>(threadIdx.x) % pairs, a = own / corners, b = own % corners;
  CornerHat<D, T>* const ofCell = hats + threadIdx.x - own;
  const std::uint32_t number = c < g.nodes.count ? g.own.at(c) : noNode;
  IndexRange fluid;
  Vec<D, int> cell{};
  if (c < g.nodes.count) {
    cell = g.nodes.pointOf(c);
    bool inside = true;  // the last nodes of an open axis are no lower corners
    for (int k = 0; k < D; ++k) inside = inside && cell[k] < g.cells.grid.count[k];
    if (inside) fluid = g.ranges.fluid(g.cells.grid.linear(cell));
  }
  Block<B> sum{};
  const std::uint32_t end = fluid.end;
  for (std::uint32_t begin = fluid.begin; __syncthreads_or(begin < end); begin += corners) {
    if (begin + a < end) {
      const Vec<D> f = g.cells.fraction(g.position[begin + a], cell);
      Vec<D, T> place;
      for (int k = 0; k < D; ++k) place[k] = static_cast<T>(f[k]);
      hats[threadIdx.x] = CornerHat<D, T>(g.cells.grid, place, b);
    }
    __syncthreads();
    for (std::uint32_t i = begin; i < min(begin + corners, end); ++i) {
      const CornerHat<D, T>* hat = ofCell + (i - begin) * corners;
      const Block<B, T> part = g.term(i, hat[a], hat[b]);
      for (int k = 0; k < B * B; ++k) sum.a[k] += part.a[k];
    }
  }
  if (number != noNode)
    for (int k = 0; k < B * B; ++k) g.parts[number * std::size_t{pairs} + own].a[k] = static_cast<T>(sum.a[k]);
}

/// A warp per row, one lane per adjacent node; adds up the parts of the cells that both are corners of. The cells
/// around the row's node are found once, one by each of the first lanes. No atomics.
template <int D, int B, class T, class Term>
__global__ void __launch_bounds__(128)
    cornerGalerkinKernel(const __grid_constant__ CornerGalerkin<D, B, T, Term> g) {
  constexpr int corners = 1 << D, pairs = corners * corners;
  const std::uint32_t row = blockIdx.x * (blockDim.x / 32) + threadIdx.x / 32;
  if (row >= g.nodes.count) return;
  const int lane = static_cast<int>(threadIdx.x) % 32;
  const std::uint64_t entry = g.rowStart[row] + lane;
  const bool used = entry < g.rowStart[row + 1];
  const Vec<D, int> node = g.nodes.pointOf(row), other = used ? g.nodes.pointOf(g.column[entry]) : node;
  Vec<D, int> cell = node;  // in the order of HatCells::forEachCellAround
  bool inside = lane < corners;
  for (int k = 0; k < D; ++k) {
    const int step = lane >> k & 1, n = g.cells.grid.count[k];
    cell[k] += step - 1;
    if (g.cells.grid.periodic[k] && cell[k] < 0) cell[k] += n;
    if (g.cells.grid.periodic[k] && n == 1 && step == 1) inside = false;  // the same one again
    inside = inside && cell[k] >= 0 && cell[k] < n;
  }
  const std::uint32_t number = inside ? g.own.at(g.nodes.at(cell)) : noNode;
  const int ownCorner = inside ? cornerOf(g.cells, node, cell) : 0;
  Block<B> sum{};
  for (int o = 0; o < corners; ++o) {
    const std::uint32_t c = __shfl_sync(~0u, number, o);
    const int corner = __shfl_sync(~0u, ownCorner, o);
    Vec<D, int> beside;
    for (int k = 0; k < D; ++k) beside[k] = __shfl_sync(~0u, cell[k], o);
    if (c == noNode || !used || !g.cells.isCorner(other, beside)) continue;
    const Block<B, T> part = g.parts[c * std::size_t{pairs} + corner * corners + cornerOf(g.cells, other, beside)];
    for (int k = 0; k < B * B; ++k) sum.a[k] += part.a[k];
  }
  if (used) g.block[entry] = sum;
}

/// `parts`: workspace, B^2 4^D numbers per node.
template <int D, int B, class T, class Term>
void cornerGalerkin(Context<Cuda>& context, const SortedParticles<D>& particles, const HatNodes<D, Cuda>& nodes,
                    const Term& term, Buffer<T, Cuda>& parts, BlockCsr<B, double, Cuda>& a) {
  constexpr int pairs = CornerGalerkin<D, B, T, Term>::pairs;
  const OwnCells<D> own(context, particles, nodes);
  parts.resize(context, std::size_t{B * B * pairs} * own.count());
  hatPattern(context, nodes, a, 1);
  const CornerGalerkin<D, B, T, Term> g{.cells = {particles.grid},
                                        .nodes = nodes.view(),
                                        .own = own.view(),
                                        .ranges = particles.ownRanges(),
                                        .position = particles.position.data(),
                                        .term = term,
                                        .parts = reinterpret_cast<Block<B, T>*>(parts.data()),
                                        .rowStart = a.rowStart.data(),
                                        .column = a.column.data(),
                                        .block = a.value.data()};
  launch(context, blocksFor(std::size_t{nodes.count()} * pairs, 128), 128, 0, cornerPartsKernel<D, B, T, Term>, g);
  launch(context, blocksFor(nodes.count(), 4), 128, 0, cornerGalerkinKernel<D, B, T, Term>, g);
  sumRows<D>(context, nodes, 1, a);
}

}  // namespace treacle
