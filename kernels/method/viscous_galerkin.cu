#include "method/hat_corners.cuh"
#include "method/pair_terms.cuh"
#include "treacle/method/hat_grid.hpp"

namespace treacle {
namespace {

/// Moments of the viscous pairs; as SelfSums in form.
template <int D, class T>
struct MomentSums {
  static constexpr int values = momentCount<D>;
  static constexpr bool uses(ListSegment s) { return isFluid(s); }
  using Own = std::uint8_t;  // material
  using Other = std::uint8_t;

  PairConstants<D, double> constants;
  ViscousMoments<D, T>* moments;

  __device__ Own loadOwn(const MphPairs<D>& pairs, std::uint32_t i) const { return pairs.material[i]; }
  __device__ Other loadOther(const MphPairs<D>& pairs, std::uint32_t j) const { return pairs.material[j]; }
  __device__ void add(const MphPairs<D>& pairs, double* sum, const Vec<D>& d, double inverseR, Own own,
                      Other other, ListSegment) const {
    const double f = pairs.materials.pairViscosity[own][other] * constants.viscosityReach(inverseR);
    forEachMoment<D>(d, [&](int m, double product) { sum[m] = fma(f, product, sum[m]); });
  }
  __device__ void store(const MphPairs<D>&, std::uint32_t i, int n, double sum) const {
    moments[i].m[n] = static_cast<T>(0.5 * viscousGalerkinFactor * constants.viscosityFactor * sum);
  }
};

/// What the kernels of the velocities' Galerkin operator read and write. Cells are numbered by the node at their
/// lower corner.
template <int D, class T>
struct ViscousGalerkin {
  static constexpr int corners = 1 << D, pairs = corners * corners;
  HatCells<D> cells;
  HatNodesView<D> nodes;
  CellRangesView ranges;
  const Vec<D>* position;
  const ViscousMoments<D, T>* moments;
  const Block<D>* own;  // inertia and walls
  Block<D, T>* parts;   // per cell: one block per pair of corners
  const std::uint64_t* rowStart;
  const std::uint32_t* column;
  Block<D>* block;
};

/// One thread per cell and pair of its corners; reads the moments and places of the cell's fluid. No atomics.
template <int D, class T>
__global__ void __launch_bounds__(128) viscousPartsKernel(const __grid_constant__ ViscousGalerkin<D, T> g) {
  constexpr int pairs = ViscousGalerkin<D, T>::pairs, corners = ViscousGalerkin<D, T>::corners;
  const std::uint32_t thread = blockIdx.x * blockDim.x + threadIdx.x, c = thread / pairs;
  if (c >= g.nodes.count) return;
  const int a = static_cast<int>(thread) % pairs / corners, b = static_cast<int>(thread) % corners;
  const Vec<D, int> cell = g.nodes.pointOf(c);
  for (int k = 0; k < D; ++k)
    if (cell[k] >= g.cells.grid.count[k]) return;  // the last nodes of an open axis are no lower corners
  const auto hat = [&](const Vec<D, T>& place, int corner, Vec<D, T>& gradient) {
    for (int k = 0; k < D; ++k) {
      gradient[k] = static_cast<T>(corner >> k & 1 ? g.cells.grid.inverseEdge[k] : -g.cells.grid.inverseEdge[k]);
      for (int other = 0; other < D; ++other)
        if (other != k) gradient[k] *= corner >> other & 1 ? place[other] : 1 - place[other];
    }
    return cornerWeight(place, corner);
  };
  Block<D> sum{};
  const std::size_t linear = g.cells.grid.linear(cell);
  for (std::uint32_t i = g.ranges.fluidBegin[linear]; i < g.ranges.fluidEnd[linear]; ++i) {
    const Vec<D> f = g.cells.fraction(g.position[i], cell);
    Vec<D, T> place, p, q;
    for (int k = 0; k < D; ++k) place[k] = static_cast<T>(f[k]);
    const T mass = hat(place, a, p) * hat(place, b, q);
    const Block<D, T> viscous = g.moments[i].between(p, q);
    for (int k = 0; k < D * D; ++k) sum.a[k] += viscous.a[k] + mass * static_cast<T>(g.own[i].a[k]);
  }
  for (int k = 0; k < D * D; ++k) g.parts[thread].a[k] = static_cast<T>(sum.a[k]);
}

/// One thread per row and adjacent node, 32 to a row; adds up the parts of the cells that both are corners of. No
/// atomics.
template <int D, class T>
__global__ void __launch_bounds__(128) viscousGalerkinKernel(const __grid_constant__ ViscousGalerkin<D, T> g) {
  const std::uint32_t row = blockIdx.x * (blockDim.x / 32) + threadIdx.x / 32;
  if (row >= g.nodes.count) return;
  const std::uint64_t entry = g.rowStart[row] + threadIdx.x % 32;
  if (entry >= g.rowStart[row + 1]) return;
  const Vec<D, int> node = g.nodes.pointOf(row), other = g.nodes.pointOf(g.column[entry]);
  Block<D> sum{};
  g.cells.forEachCellAround(node, 1, [&](const Vec<D, int>& cell) {
    const std::uint32_t c = g.nodes.at(cell);
    if (c == noNode || !g.cells.isCorner(other, cell)) return;
    const int pair =
        cornerOf(g.cells, node, cell) * ViscousGalerkin<D, T>::corners + cornerOf(g.cells, other, cell);
    const Block<D, T> part = g.parts[c * std::size_t{ViscousGalerkin<D, T>::pairs} + pair];
    for (int k = 0; k < D * D; ++k) sum.a[k] += part.a[k];
  });
  g.block[entry] = sum;
}

}  // namespace

template <int D, class T>
void viscousGalerkin(Context<Cuda>& context, const MphPairs<D>& pairs, const WallTerms<D>& terms,
                     const HatNodes<D, Cuda>& nodes, Buffer<ViscousMoments<D, T>, Cuda>& moments,
                     Buffer<T, Cuda>& parts, BlockCsr<D, double, Cuda>& a) {
  using Terms = MomentSums<D, T>;
  constexpr int cornerPairs = ViscousGalerkin<D, T>::pairs;
  moments.resize(context, pairs.fluidCount);
  const ListTask<Terms> task{pairs.fluidList, {PairConstants<D, double>::make(pairs, 1), moments.data()}};
  launchClusterSums<D, double, Sharing<2, 1>>(context, pairs, task, Places<D, double>::make(pairs));

  parts.resize(context, std::size_t{D * D * cornerPairs} * nodes.count());
  hatPattern(context, nodes, a, 1);
  const ViscousGalerkin<D, T> g{.cells = {pairs.grid},
                                .nodes = nodes.view(),
                                .ranges = pairs.cells,
                                .position = pairs.position.data(),
                                .moments = moments.data(),
                                .own = terms.block.data(),
                                .parts = reinterpret_cast<Block<D, T>*>(parts.data()),
                                .rowStart = a.rowStart.data(),
                                .column = a.column.data(),
                                .block = a.block.data()};
  launch(context, blocksFor(std::size_t{nodes.count()} * cornerPairs, 128), 128, 0, viscousPartsKernel<D, T>, g);
  launch(context, blocksFor(nodes.count(), 4), 128, 0, viscousGalerkinKernel<D, T>, g);
}

#define TREACLE_INSTANTIATE(D, T)                                                                    \
  template void viscousGalerkin<D, T>(Context<Cuda>&, const MphPairs<D>&, const WallTerms<D>&,       \
                                      const HatNodes<D, Cuda>&, Buffer<ViscousMoments<D, T>, Cuda>&, \
                                      Buffer<T, Cuda>&, BlockCsr<D, double, Cuda>&);
TREACLE_INSTANTIATE(2, double)
TREACLE_INSTANTIATE(3, double)
TREACLE_INSTANTIATE(2, float)
TREACLE_INSTANTIATE(3, float)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
