#pragma once

#include "core/reduce.cuh"
#include "precondition/bucket_cells.cuh"
#include "treacle/core/block.hpp"
#include "treacle/mph/mph_pairs.hpp"

namespace treacle {

/// What the kernels read besides the pairs, and what they write.
template <int D>
struct Galerkin {
  static constexpr int neighbours = power<D>(3), self = neighbours / 2;

  CellRangesView ranges;
  OwnRanges own;
  std::uint32_t buckets;
  const std::uint32_t* begin;     // first particle of every bucket, and the end
  const std::uint32_t* bucketOf;  // per particle
  const Vec<D>* columns;          // 2^D per particle
  const std::uint8_t* lower;      // per particle: bit k: the lower cell of axis k is the one below its own
  const Block<D>* ownBlock;       // inertia and walls per own fluid particle
  std::uint64_t* rowStart;
  std::uint32_t* column;
  Block<D>* block;
  Block<D>* cross;  // beside every block: its part of V, with the sign of the diagonal

  /// Whether it is the process's own, which then adds what all its particles have; if not, they are ghosts.
  __device__ bool isOwn(std::uint32_t bucket) const { return begin[bucket] < own.ownFluid; }
  __device__ Vec<D, int> cellOf(const MphPairs<D>& pairs, std::uint32_t bucket) const {
    return pairs.grid.cellOf(pairs.position[begin[bucket]]);
  }
  /// Place of neighbour o in a row whose occupied neighbours are given.
  __device__ std::uint64_t place(std::uint32_t bucket, unsigned occupied, int o) const {
    return rowStart[bucket] + __popc(occupied & ((1u << o) - 1));
  }
};

/// sum += lambda_k (R C)_{Ik} (R C)_{Jk}^T over these particles k, which the lanes take in turns. I
/// is the cell from which offsets count, J stands at `other`, the particles' cell at `at`.
template <int D>
__device__ void addColumns(const MphPairs<D>& pairs, const Galerkin<D>& g, const IndexRange& particles,
                           const Vec<D, int>& at, const Vec<D, int>& other, Block<D>& sum) {
  for (std::uint32_t k = particles.begin + threadIdx.x % 32; k < particles.end; k += 32) {
    const unsigned below = g.lower[k];
    Vec<D, int> lower = at;
    for (int c = 0; c < D; ++c) lower[c] -= below >> c & 1;
    const int slotI = columnSlot<D>(-lower), slotJ = columnSlot<D>(other - lower);
    if (slotI < 0 || slotJ < 0) continue;
    const Vec<D>* column = g.columns + std::size_t{power<D>(2)} * k;
    sum.addOuter(pairs.bulkViscosity(k), column[slotI], column[slotJ]);
  }
}

/// A lane's part of (R C Lambda C^T P)_{IJ}: over the own particles of the cells that are adjacent to both.
template <int D>
__device__ Block<D> pressurePart(const MphPairs<D>& pairs, const Galerkin<D>& g, const Vec<D, int>& own,
                                 const Vec<D, int>& other) {
  Block<D> sum{};
  for (int o = 0; o < Galerkin<D>::neighbours; ++o) {
    const Vec<D, int> at = adjacentOffset<D>(o);
    bool adjacent = true;
    for (int c = 0; c < D; ++c) adjacent = adjacent && abs(at[c] - other[c]) <= 1;
    if (!adjacent) continue;
    const AdjacentCell<D> cell(pairs.grid, own, at);
    if (!cell.inside) continue;
    addColumns(pairs, g, g.own.fluid(cell.linear), at, other, sum);
    addColumns(pairs, g, g.own.walls(cell.linear), at, other, sum);
  }
  return sum;
}

/// A lane's part of the viscous pair blocks between the particles of a bucket and those of an adjacent cell: eight
/// lanes side by side take a neighbour each, the four groups of them the bucket's particles in turns.
template <int D, class Mph>
__device__ Block<D> viscousPart(const MphPairs<D>& pairs, const Mph& mph, std::uint32_t firstI,
                                std::uint32_t lastI, std::uint32_t firstJ, std::uint32_t lastJ,
                                const Vec<D>& shift) {
  const int lane = threadIdx.x % 32;
  const double h2 = mph.viscosityRadius * mph.viscosityRadius;
  Block<D> sum{};
  for (std::uint32_t j = firstJ + lane % 8; j < lastJ; j += 8) {
    const Vec<D> xj = pairs.position[j] + shift;
    const ViscousSide side = pairs.viscousSide(j);
    for (std::uint32_t i = firstI + lane / 8; i < lastI; i += 4) {
      const Vec<D> d = xj - pairs.position[i];
      const double r2 = norm2(d);
      if (r2 >= h2 || r2 == 0) continue;
      const PairDistance<double> distance{r2, inverseSqrt(r2)};
      const double f = pairs.viscosityOf(pairs.viscousSide(i), side) * mph.viscousShape(distance);
      for (int r = 0; r < D; ++r)
        for (int c = r; c < D; ++c) sum(r, c) = fma(f * d[r], d[c], sum(r, c));
    }
  }
  for (int r = 0; r < D; ++r)
    for (int c = r; c < D; ++c) sum(c, r) = sum(r, c) *= mph.viscousFactor;
  return sum;
}

/// Sum over the lanes, in all of them.
template <int D>
__device__ Block<D> sumOfLanes(Block<D> m) {
  for (int e = 0; e < D * D; ++e) m.a[e] = warpSum(m.a[e]);
  return m;
}

}  // namespace treacle
