#include "precondition/hat_corners.cuh"
#include "precondition/own_cells.cuh"
#include "precondition/placed_sums.cuh"
#include "treacle/core/device_link.hpp"
#include "treacle/precondition/hat_grid.hpp"

namespace treacle {
namespace {

template <int D>
constexpr int slots = D == 2 ? 9 : 27;  // nodes that the neighbours of a particle touch

/// Products of the columns of C P are the same small matrix for all particles of a half cell: they touch the same
/// 3^D nodes.
template <int D, class T>
struct CellParts {
  static constexpr int halves = 1 << D, gram = slots<D> * slots<D>, corners = 1 << D, mass = corners * corners;
  T* grams;   // per cell and half: sum of w (C P)_n.(C P)_m over its fluid particles
  T* masses;  // per cell: sum of shift hat_a hat_b over its particles, a and b corners

  __host__ __device__ static constexpr std::size_t numbers() { return halves * gram + mass; }
};

/// What the kernels of the pressures' Galerkin operator read and write.
template <int D, class T>
struct PressureGalerkin {
  HatCells<D> cells;
  HatNodesView<D> nodes;
  OwnCellsView own;
  const SymmetricBlock<D>* renormalisation;  // per fluid particle; null: none
  Vec<D, T> toCells;                         // unit of length of the lists' view in cells
  ProjectionTable<double> table;
  OwnRanges ranges;
  const Vec<D>* position;
  const std::uint8_t* material;
  CellParts<D, T> parts;
  const std::uint64_t* rowStart;
  const std::uint32_t* column;
  double* value;
};

/// What the columns of C P need of a neighbour, the same for all nodes: where it is, in cells from the lowest of
/// the 3^D nodes, g d, and with B of the neighbour in between.
template <int D, class T>
struct StagedNeighbour {
  Gathered<D, T> at, plain, column;  // shared memory gives each in one piece
};

/// Where a particle at `place` in its cell is from the lowest of its 3^D nodes, in cells.
template <int D>
__device__ inline Vec<D> fromLowest(Vec<D> place) {
  for (int k = 0; k < D; ++k)
    if (place[k] < 0.5) place[k] += 1;
  return place;
}

template <bool Renormalised, int D, class T, class Scheme>
__device__ inline StagedNeighbour<D, T> stagedNeighbour(const PressureGalerkin<D, T>& g,
                                                        const NearView<D, T, Scheme>& near, std::uint32_t i,
                                                        const Vec<D>& from, std::uint32_t j) {
  const Vec<D, T> d = near.difference(near.other(j), near.own(i));
  StagedNeighbour<D, T> staged;
  for (int k = 0; k < D; ++k) staged.at[k] = fma(d[k], g.toCells[k], static_cast<T>(from[k]));
  const Vec<D, T> plain = gradientShape(near, d) * d;
  staged.plain = staged.column = plain;
  if constexpr (Renormalised)
    if (j < near.fluidCount) staged.column = converted<T>(g.renormalisation[j] * converted<double>(plain));
  return staged;
}

/// The hat of node n.
template <int D, class T>
__device__ inline T nodeHat(const Vec<D, T>& at, int n) {
  T weight = 1;
  for (int k = 0; k < D; ++k, n /= 3) weight *= positivePart(1 - fabs(at[k] - static_cast<T>(n % 3)));
  return weight;
}

/// One block per cell: the columns of C P of its fluid particles, a few at a time in shared memory, and from them
/// the matrices of its halves; then the corner hats of all its particles, and the mass matrix. Each thread owns
/// its entries. No atomics.
template <bool Renormalised, int D, class T, class Scheme>
__global__ void __launch_bounds__(D == 2 ? 96 : 256)
    cellPartsKernel(const __grid_constant__ PressureGalerkin<D, T> g,
                    const __grid_constant__ NearView<D, T, Scheme> near) {
  using Parts = CellParts<D, T>;
  constexpr int threads = D == 2 ? 96 : 256, batch = D == 2 ? 20 : 36, width = D * slots<D>;
  constexpr int mine = (Parts::gram + threads - 1) / threads;
  // So many particles at a time have their neighbours in shared memory, and so many rows of their lists.
  constexpr int together = threads / slots<D>, rows = D == 2 ? 12 : 24;
  __shared__ T columns[batch][width];
  __shared__ T weight[batch];
  __shared__ int half[batch];
  __shared__ StagedNeighbour<D, T> staged[rows][together];
  const Vec<D, int> cell = g.nodes.pointOf(blockIdx.x);
  for (int k = 0; k < D; ++k)
    if (cell[k] >= g.cells.grid.count[k]) return;  // the last nodes of an open axis are no lower corners
  const std::uint32_t number = g.own.at(blockIdx.x);
  if (number == noNode) return;
  const std::size_t c = g.cells.grid.linear(cell);
  const auto [begin, end] = g.ranges.fluid(c);
  T* grams = g.parts.grams + number * std::size_t{Parts::halves} * Parts::gram;
  const int own = threadIdx.x / slots<D>, n = threadIdx.x % slots<D>;
  const auto rowsOf = [&](std::uint32_t i) {
    return static_cast<int>(near.sliceStart[i / nearSlice + 1] - near.sliceStart[i / nearSlice]);
  };

  for (std::uint32_t first = begin; first < end || first == begin; first += batch) {
    const int count = static_cast<int>(min(end - first, std::uint32_t{batch}));
    for (int group = 0; group < count; group += together) {
      const int inGroup = min(together, count - group);
      int longest = 0;
      for (int p = 0; p < inGroup; ++p) longest = max(longest, rowsOf(first + group + p));
      Vec<D, T> sum{}, plain{};
      for (int row = 0; row < longest; row += rows) {
        __syncthreads();
        const int inChunk = min(rows, longest - row);
        for (int t = threadIdx.x; t < inChunk * inGroup; t += threads) {
          const int p = t % inGroup, r = row + t / inGroup;
          const std::uint32_t i = first + group + p;
          const Vec<D> from = fromLowest(g.cells.fraction(g.position[i], cell));
          const std::size_t at = (near.sliceStart[i / nearSlice] + r) * nearSlice + i % nearSlice;
          // The particle itself, where its list has ended, adds nothing.
          const std::uint32_t j = r < rowsOf(i) ? near.entry[at] : i;
          staged[t / inGroup][p] = stagedNeighbour<Renormalised>(g, near, i, from, j);
        }
        __syncthreads();
        if (own >= inGroup) continue;
        for (int r = 0; r < inChunk; ++r) {
          const StagedNeighbour<D, T>& other = staged[r][own];
          addScaled(&sum[0], nodeHat(fetch<D, T>(&other.at), n), fetch<D, T>(&other.column));
          plain += fetch<D, T>(&other.plain);
        }
      }
      if (own >= inGroup) continue;
      const int p = group + own;
      const std::uint32_t i = first + p;
      const Vec<D> place = g.cells.fraction(g.position[i], cell);
      if constexpr (Renormalised) plain = converted<T>(g.renormalisation[i] * converted<double>(plain));
      addScaled(&sum[0], nodeHat(converted<T>(fromLowest(place)), n), plain);
      for (int k = 0; k < D; ++k) columns[p][n * D + k] = near.mph.gradientFactor * sum[k];
      if (n > 0) continue;
      weight[p] = static_cast<T>(g.table.weight[g.material[i]]);
      int h = 0;
      for (int k = 0; k < D; ++k) h |= place[k] < 0.5 ? 0 : 1 << k;
      half[p] = h;
    }
    __syncthreads();
    for (int h = 0; h < Parts::halves; ++h) {
      T sum[mine] = {};
      for (int p = 0; p < count; ++p) {
        if (half[p] != h) continue;
#pragma unroll
        for (int m = 0; m < mine; ++m) {
          const int e = threadIdx.x + m * threads;
          if (e >= Parts::gram) break;
          const T *a = &columns[p][e / slots<D> * D], *b = &columns[p][e % slots<D> * D];
          T product = a[0] * b[0];
          for (int k = 1; k < D; ++k) product = fma(a[k], b[k], product);
          sum[m] = fma(weight[p], product, sum[m]);
        }
      }
#pragma unroll
      for (int m = 0; m < mine; ++m) {
        const int e = threadIdx.x + m * threads;
        if (e >= Parts::gram) break;
        T* target = grams + h * Parts::gram + e;
        *target = first == begin ? sum[m] : *target + sum[m];
      }
    }
  }

  if (threadIdx.x >= Parts::mass) return;
  const int a = static_cast<int>(threadIdx.x) / Parts::corners, b = static_cast<int>(threadIdx.x) % Parts::corners;
  double sum = 0;
  const auto add = [&](std::uint32_t from, std::uint32_t to) {
    for (std::uint32_t i = from; i < to; ++i) {
      const Vec<D> place = g.cells.fraction(g.position[i], cell);
      sum += g.table.shiftOf(i, g.material[i]) * cornerWeight(place, a) * cornerWeight(place, b);
    }
  };
  const IndexRange walls = g.ranges.walls(c);
  add(begin, end);
  add(walls.begin, walls.end);
  g.parts.masses[number * std::size_t{Parts::mass} + threadIdx.x] = static_cast<T>(sum);
}

/// Of the six half cells along an axis that touch a node: the cell, the node's place among the half's three nodes,
/// and the place of another node, -1 where it is not one of them. They go from two cells below the node to the one
/// above.
struct HalfCell {
  int cell, own, other;
};
template <int D>
__device__ inline HalfCell halfCellAt(const HatCells<D>& cells, const Vec<D, int>& node, const Vec<D, int>& other,
                                      int axis, int t) {
  const int count = cells.grid.count[axis], lowest = node[axis] - 2 + t / 2;
  int cell = node[axis] - 2 + (t + 1) / 2;
  bool exists = true;
  if (cells.grid.periodic[axis])
    cell = cell < 0 ? cell + count : cell >= count ? cell - count : cell;
  else
    exists = cell >= 0 && cell < count;
  const int place = cells.above(other[axis], lowest, axis);
  return {cell, 2 - t / 2, exists && place >= 0 && place <= 2 ? place : -1};
}

/// A warp per row and 32 of its entries, one lane each: adds up what the half cells and cells around have for the
/// two nodes. No atomics.
template <int D, class T>
__global__ void __launch_bounds__(128) pressureGalerkinKernel(const __grid_constant__ PressureGalerkin<D, T> g) {
  using Parts = CellParts<D, T>;
  constexpr std::uint32_t parts = D == 2 ? 1 : 4;
  const std::uint32_t warp = blockIdx.x * (blockDim.x / 32) + threadIdx.x / 32, row = warp / parts;
  if (row >= g.nodes.count) return;
  const std::uint64_t entry = g.rowStart[row] + 32 * (warp % parts) + threadIdx.x % 32;
  if (entry >= g.rowStart[row + 1]) return;
  const Vec<D, int> node = g.nodes.pointOf(row), other = g.nodes.pointOf(g.column[entry]);
  double sum = 0;
  for (int tz = 0; tz < (D == 3 ? 6 : 1); ++tz) {
    const HalfCell z = D == 3 ? halfCellAt(g.cells, node, other, D - 1, tz) : HalfCell{0, 0, 0};
    for (int ty = 0; ty < 6 && z.other >= 0; ++ty) {
      const HalfCell y = halfCellAt(g.cells, node, other, 1, ty);
      for (int tx = 0; tx < 6 && y.other >= 0; ++tx) {
        const HalfCell x = halfCellAt(g.cells, node, other, 0, tx);
        if (x.other < 0) continue;
        Vec<D, int> cell;
        cell[0] = x.cell, cell[1] = y.cell;
        if constexpr (D == 3) cell[2] = z.cell;
        const std::uint32_t c = g.own.at(g.nodes.at(cell));
        if (c == noNode) continue;
        // Every second half cell from the first one on is an upper half.
        const int half = (~tx & 1) | (~ty & 1) << 1 | (D == 3 ? (~tz & 1) << 2 : 0);
        const int n = x.own + 3 * (y.own + 3 * z.own), m = x.other + 3 * (y.other + 3 * z.other);
        sum += g.parts.grams[(c * std::size_t{Parts::halves} + half) * Parts::gram + n * slots<D> + m];
      }
    }
  }
  g.cells.forEachCellAround(node, 1, [&](const Vec<D, int>& cell) {
    const std::uint32_t c = g.own.at(g.nodes.at(cell));
    if (c == noNode || !g.cells.isCorner(other, cell)) return;
    sum += g.parts.masses[c * std::size_t{Parts::mass} + cornerOf(g.cells, node, cell) * Parts::corners +
                          cornerOf(g.cells, other, cell)];
  });
  g.value[entry] = sum;
}

}  // namespace

template <int D, class T>
void pressureGalerkin(Context<Cuda>& context, const MphPairs<D>& pairs, const NearProducts<D>& near,
                      const ProjectionTable<double>& table, const HatNodes<D, Cuda>& nodes, Buffer<T, Cuda>& parts,
                      BlockCsr<1, double, Cuda>& s) {
  using Parts = CellParts<D, T>;
  const double unit = LocalPositions<D, T>::unit(pairs);
  Vec<D, T> toCells;
  for (int k = 0; k < D; ++k) toCells[k] = static_cast<T>(unit * pairs.grid.inverseEdge[k]);
  const OwnCells<D> own(context, pairs, nodes);
  parts.resize(context, Parts::numbers() * own.count());
  hatPattern(context, nodes, s);
  const PressureGalerkin<D, T> g{
      .cells = {pairs.grid},
      .nodes = nodes.view(),
      .own = own.view(),
      .renormalisation = pairs.renormalisation,
      .toCells = toCells,
      .table = table,
      .ranges = pairs.ownRanges(),
      .position = pairs.position.data(),
      .material = pairs.classOf(),
      .parts = {parts.data(), parts.data() + std::size_t{Parts::halves} * Parts::gram * own.count()},
      .rowStart = s.rowStart.data(),
      .column = s.column.data(),
      .value = reinterpret_cast<double*>(s.value.data())};
  withSchemeTerms(pairs, [&]<class Scheme>(const MphTerms<D, double, Scheme>& terms, auto renormalised) {
    launch(context, nodes.count(), D == 2 ? 96 : 256, 0,
           cellPartsKernel<decltype(renormalised)::value, D, T, Scheme>, g,
           NearView<D, T, Scheme>::make(pairs, near, terms));
  });
  launch(context, D == 2 ? blocksFor(nodes.count(), 4) : nodes.count(), 128, 0, pressureGalerkinKernel<D, T>, g);
  sumRows<D>(context, nodes, hatReach, s);
}

#define TREACLE_INSTANTIATE(D, T)                                                                  \
  template void pressureGalerkin<D, T>(Context<Cuda>&, const MphPairs<D>&, const NearProducts<D>&, \
                                       const ProjectionTable<double>&, const HatNodes<D, Cuda>&,   \
                                       Buffer<T, Cuda>&, BlockCsr<1, double, Cuda>&);
TREACLE_INSTANTIATE(2, double)
TREACLE_INSTANTIATE(3, double)
TREACLE_INSTANTIATE(2, float)
TREACLE_INSTANTIATE(3, float)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
