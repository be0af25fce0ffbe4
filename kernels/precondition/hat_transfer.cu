#include "core/reduce.cuh"
#include "precondition/cell_sums.cuh"
#include "precondition/hat_corners.cuh"
#include "precondition/placed_sums.cuh"
#include "treacle/precondition/each_node.hpp"

namespace treacle {
namespace {

/// A warp per node, its lanes in groups, one group per cell around it: b = P^T r, for scalars per particle
/// (Numbers = 1) or vectors per fluid particle. No atomics.
template <int D, class T, int Numbers, class V>
__global__ void __launch_bounds__(128)
    restrictKernel(const __grid_constant__ HatCells<D> cells, const HatNodesView<D> nodes, const OwnRanges ranges,
                   const Vec<D, T>* place, const V* r, T* b) {
  constexpr int groups = 1 << D, lanes = 32 / groups, batch = 4;  // so many particles are on their way together
  const std::uint32_t n = blockIdx.x * (blockDim.x / 32) + threadIdx.x / 32;
  if (n >= nodes.count) return;
  const int corner = static_cast<int>(threadIdx.x % 32) / lanes, lane = static_cast<int>(threadIdx.x % lanes);
  Vec<D, int> cell = nodes.pointOf(n);
  T sum[Numbers] = {};
  const auto add = [&](std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t first = begin + lane; first < end; first += batch * lanes) {
      T weight[batch];
      Vec<Numbers, T> v[batch];
#pragma unroll
      for (int b = 0; b < batch; ++b) {
        const std::uint32_t i = min(first + b * lanes, end - 1);
        weight[b] = first + b * lanes < end ? cornerWeight(place[i], corner) : T(0);
        if constexpr (Numbers == 1)
          v[b][0] = r[i];
        else
          v[b] = fetch(&r[i]);
      }
#pragma unroll
      for (int b = 0; b < batch; ++b)
        for (int k = 0; k < Numbers; ++k) sum[k] = fma(weight[b], v[b][k], sum[k]);
    }
  };
  IndexRange fluid, walls;
  if (cellBeside(cells, cell, corner)) {
    const std::size_t c = cells.grid.linear(cell);
    fluid = ranges.fluid(c);
    if constexpr (Numbers == 1) walls = ranges.walls(c);
  }
  waitForEarlierKernels();  // none of them has made the cells
  add(fluid.begin, fluid.end);
  add(walls.begin, walls.end);
  for (int k = 0; k < Numbers; ++k) {
    const T total = warpSum(sum[k]);
    if (threadIdx.x % 32 == k) b[std::size_t{Numbers} * n + k] = total;
  }
}

/// Calls f(node, weight) for the corners of the cell of a particle.
template <int D, class T, class F>
__device__ inline void forEachCorner(const HatCells<D>& cells, const HatNodesView<D>& nodes, const Vec<D>& x,
                                     const Vec<D, T>& place, F&& f) {
  const Vec<D, int> cell = cells.grid.cellOf(x);
  for (int o = 0; o < 1 << D; ++o) {
    Vec<D, int> node = cell;
    for (int k = 0; k < D; ++k)
      if ((o >> k & 1) && ++node[k] == nodes.lattice.count[k]) node[k] = 0;  // only on periodic axes
    f(nodes.at(node), cornerWeight(place, o));
  }
}

}  // namespace

template <int D, class T>
void HatTransfer<D, T, Cuda>::prepare(Context<Cuda>& context, const SortedParticles<D>& pairs) {
  pairs_ = &pairs;
  place_.resize(context, pairs.activeCount);
  forEach(context, pairs.activeCount,
          [cells = HatCells<D>{pairs.grid}, x = pairs.position.data(),
           place = place_.data()] __device__(std::size_t i) {
            const Vec<D> f = cells.fraction(x[i], cells.grid.cellOf(x[i]));
            for (int k = 0; k < D; ++k) place[i][k] = static_cast<T>(f[k]);
          });
}

template <int D, class T>
void HatTransfer<D, T, Cuda>::restrictFluid(Context<Cuda>& context, const HatNodes<D, Cuda>& nodes,
                                            std::span<const T> r, Buffer<T, Cuda>& parts, std::span<T> b) const {
  constexpr unsigned corners = 1 << D;
  const HatCells<D> cells{pairs_->grid};
  launchEarly(context, blocksFor(nodes.count(), 128 / 16), 128, 0, cellSumsKernel<D, T>, cells, nodes.view(),
              pairs_->ownRanges(), place_.data(), r.data(), parts.data());
  launchEarly(context, blocksFor(nodes.count(), 128 / corners), 128, 0, nodeSumsKernel<D, T>, cells, nodes.view(),
              parts.data(), b.data());
  sumAtNodes<1>(context, nodes, b);
}

template <int D, class T>
void HatTransfer<D, T, Cuda>::restrict(Context<Cuda>& context, const HatNodes<D, Cuda>& nodes,
                                       std::span<const T> r, std::span<T> b) const {
  launchEarly(context, blocksFor(nodes.count(), 4), 128, 0, restrictKernel<D, T, 1, T>, HatCells<D>{pairs_->grid},
              nodes.view(), pairs_->ownRanges(), place_.data(), r.data(), b.data());
  sumAtNodes<1>(context, nodes, b);
}

template <int D, class T>
void HatTransfer<D, T, Cuda>::restrict(Context<Cuda>& context, const HatNodes<D, Cuda>& nodes,
                                       std::span<const Gathered<D, T>> r, std::span<T> b) const {
  launchEarly(context, blocksFor(nodes.count(), 4), 128, 0, restrictKernel<D, T, D, Gathered<D, T>>,
              HatCells<D>{pairs_->grid}, nodes.view(), pairs_->ownRanges(), place_.data(), r.data(), b.data());
  sumAtNodes<D>(context, nodes, b);
}

/// One thread per particle.
template <int D, class T>
void HatTransfer<D, T, Cuda>::prolong(Context<Cuda>& context, const HatNodes<D, Cuda>& nodes, std::span<const T> e,
                                      ScalarField<T, Cuda> z, std::span<T> x) const {
  forEach(context, pairs_->activeCount,
          [cells = HatCells<D>{pairs_->grid}, nodes = nodes.view(), position = pairs_->position.data(),
           place = place_.data(), e = e.data(), z, x = x.data()] __device__(std::size_t i) {
            T sum = 0;
            forEachCorner(cells, nodes, position[i], place[i],
                          [&](std::uint32_t n, T weight) { sum = fma(weight, e[n], sum); });
            z[i] = sum;
            x[i] += sum;
          });
}

/// One thread per particle.
template <int D, class T>
void HatTransfer<D, T, Cuda>::addProlonged(Context<Cuda>& context, const HatNodes<D, Cuda>& nodes,
                                           std::span<const T> e, std::span<T> x) const {
  forEach(context, pairs_->activeCount,
          [cells = HatCells<D>{pairs_->grid}, nodes = nodes.view(), position = pairs_->position.data(),
           place = place_.data(), e = e.data(), x = x.data()] __device__(std::size_t i) {
            T sum = x[i];
            forEachCorner(cells, nodes, position[i], place[i],
                          [&](std::uint32_t n, T weight) { sum = fma(weight, e[n], sum); });
            x[i] = sum;
          });
}

template <int D, class T>
void HatTransfer<D, T, Cuda>::prolong(Context<Cuda>& context, const HatNodes<D, Cuda>& nodes, std::span<const T> e,
                                      std::span<Gathered<D, T>> z, std::span<Gathered<D, T>> x) const {
  forEach(context, pairs_->fluidCount,
          [cells = HatCells<D>{pairs_->grid}, nodes = nodes.view(), position = pairs_->position.data(),
           place = place_.data(), e = e.data(), z = z.data(), x = x.data()] __device__(std::size_t i) {
            Vec<D, T> sum{};
            forEachCorner(cells, nodes, position[i], place[i], [&](std::uint32_t n, T weight) {
              for (int k = 0; k < D; ++k) sum[k] = fma(weight, e[std::size_t{D} * n + k], sum[k]);
            });
            z[i] = sum;
            x[i] = fetch(&x[i]) + sum;
          });
}

template void findHatNodes(Context<Cuda>&, const SortedParticles<2>&, HatsOn, HatNodes<2, Cuda>&, std::uint64_t);
template void findHatNodes(Context<Cuda>&, const SortedParticles<3>&, HatsOn, HatNodes<3, Cuda>&, std::uint64_t);
template class HatTransfer<2, double, Cuda>;
template class HatTransfer<3, double, Cuda>;
template class HatTransfer<2, float, Cuda>;
template class HatTransfer<3, float, Cuda>;

}  // namespace treacle
