#pragma once

#include "core/launch.hpp"
#include "treacle/method/mph_pairs.hpp"

namespace treacle {

/// d at the nearest periodic image; differences that matter are shorter than half the domain.
template <int D>
__device__ Vec<D> nearestImage(const CellGrid<D>& grid, Vec<D> d) {
  for (int k = 0; k < D; ++k)
    if (grid.periodic[k]) d[k] -= grid.length[k] * round(d[k] / grid.length[k]);
  return d;
}

/// Where particle i of a cluster stands as the cluster's list sees it: at the image nearest to the first particle.
template <int D>
__device__ Vec<D> positionInCluster(const MphPairs<D>& pairs, std::uint32_t first, std::uint32_t i) {
  return pairs.grid.beside(pairs.position[first], pairs.position[i]);
}

/// -e w'^p = g of a pair with difference d, r2 = |d|^2 in (0, h_p^2) [1/m].
template <int D>
__device__ Vec<D> pressureTerm(const MphPairs<D>& pairs, const Vec<D>& d, double r2) {
  return pairs.pressure.factor * (rsqrt(r2) - pairs.pressure.inverseRadius) * d;
}

/// Calls f(j, g) for every neighbour j != i within h_p, fluid then walls; g = -e w'^p [1/m].
template <int D, class F>
__device__ void forEachNear(const MphPairs<D>& pairs, std::uint32_t i, F&& f) {
  const ClusterListView& list = i < pairs.fluidCount ? pairs.fluidList : pairs.wallList;
  const std::uint32_t cluster = (i - list.first) / clusterSize;
  const Vec<D> xi = positionInCluster(pairs, list.first + cluster * clusterSize, i);
  const double h2 = pairs.pressureWeight.radius * pairs.pressureWeight.radius;
  const std::uint64_t* offset = list.offset + std::size_t{listSegments} * cluster;
  for (ListSegment s : {ListSegment::NearFluid, ListSegment::NearWall}) {
    const std::uint64_t end = offset[static_cast<int>(s) + 1];
    for (std::uint64_t k = offset[static_cast<int>(s)]; k < end; ++k) {
      const ListEntry e = list.entry[k];
      const Vec<D> d = pairs.positionOf(e) - xi;
      const double r2 = norm2(d);
      if (e.index() != i && r2 < h2 && r2 > 0) f(e.index(), pressureTerm(pairs, d, r2));
    }
  }
}

/// A cluster's entry as particle i itself sees it: where a periodic end runs between i and the cluster's first
/// particle, another image is meant.
template <int D>
__device__ ListEntry imageFrom(const MphPairs<D>& pairs, std::uint32_t i, std::uint32_t first, ListEntry e) {
  const Vec<D> d = pairs.positionOf(e) - positionInCluster(pairs, first, i);
  const Vec<D> direct = pairs.position[e.index()] - pairs.position[i];
  std::uint32_t image = 0;
  for (int k = D - 1; k >= 0; --k) {
    const double turns = round((d[k] - direct[k]) / pairs.grid.length[k]);
    image = 3 * image + (turns > 0 ? 1 : turns < 0 ? 2 : 0);
  }
  return ListEntry::make(e.index(), image);
}

}  // namespace treacle
