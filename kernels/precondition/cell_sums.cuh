#pragma once

#include "core/launch.hpp"
#include "precondition/hat_corners.cuh"
#include "treacle/linear/hat_nodes.hpp"
#include "treacle/search/sorted_particles.hpp"

namespace treacle {

/// Half a warp per cell, which the node at its lower corner stands for: the sums of its fluid for its corners,
/// each particle read once. No atomics.
template <int D, class T>
__global__ void __launch_bounds__(128)
    cellSumsKernel(const __grid_constant__ HatCells<D> cells, const HatNodesView<D> nodes, const OwnRanges ranges,
                   const Vec<D, T>* place, const T* r, T* parts) {
  waitForEarlierKernels();
  constexpr int corners = 1 << D, lanes = 16;
  const std::uint32_t c = (blockIdx.x * blockDim.x + threadIdx.x) / lanes, lane = threadIdx.x % lanes;
  T sum[corners] = {};
  const bool used = c < nodes.count;
  if (used) {
    const Vec<D, int> cell = nodes.pointOf(c);
    bool inside = true;  // the last nodes of an open axis are no lower corners
    for (int k = 0; k < D; ++k) inside = inside && cell[k] < cells.grid.count[k];
    const IndexRange own = inside ? ranges.fluid(cells.grid.linear(cell)) : IndexRange{};
    for (std::uint32_t i = own.begin + lane; i < own.end; i += lanes) {
      const Vec<D, T> at = place[i];
      const T value = r[i];
      for (int o = 0; o < corners; ++o) sum[o] = fma(cornerWeight(at, o), value, sum[o]);
    }
  }
  // In each step a lane hands half of its sums to its neighbour: lane l ends with the sum of corner l / (lanes /
  // corners).
  int size = corners;
#pragma unroll
  for (int away = lanes / 2; away > 0; away /= 2) {
    const bool upper = (lane & away) != 0;
    if (size > 1) {
      size /= 2;
#pragma unroll
      for (int o = 0; o < corners / 2; ++o) {
        if (o >= size) break;
        const T handed = upper ? sum[o] : sum[o + size];
        sum[o] = (upper ? sum[o + size] : sum[o]) + __shfl_xor_sync(~0u, handed, away);
      }
    } else {
      sum[0] += __shfl_xor_sync(~0u, sum[0], away);
    }
  }
  constexpr int lanesOfCorner = lanes / corners;
  if (used && lane % lanesOfCorner == 0) parts[std::size_t{c} * corners + lane / lanesOfCorner] = sum[0];
}

/// As many lanes per node as it has cells around it: b = P^T r from the cells' sums. No atomics.
template <int D, class T>
__global__ void __launch_bounds__(128)
    nodeSumsKernel(const __grid_constant__ HatCells<D> cells, const HatNodesView<D> nodes, const T* parts, T* b) {
  waitForEarlierKernels();
  constexpr int corners = 1 << D;
  const std::uint32_t n = (blockIdx.x * blockDim.x + threadIdx.x) / corners;
  const int corner = static_cast<int>(threadIdx.x % corners);
  T sum = 0;
  if (n < nodes.count) {
    Vec<D, int> cell = nodes.pointOf(n);
    if (cellBeside(cells, cell, corner)) {
      const std::uint32_t c = nodes.at(cell);
      if (c != noNode) sum = parts[std::size_t{c} * corners + corner];
    }
  }
  for (int away = corners / 2; away > 0; away /= 2) sum += __shfl_xor_sync(~0u, sum, away);
  if (n < nodes.count && corner == 0) b[n] = sum;
}

}  // namespace treacle
