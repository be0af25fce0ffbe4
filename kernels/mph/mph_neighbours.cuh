#pragma once

#include "core/launch.hpp"
#include "treacle/mph/mph_neighbours.hpp"

namespace treacle {

/// d at the nearest periodic image; differences that matter are shorter than half the domain.
template <int D>
__device__ Vec<D> nearestImage(const CellGrid<D>& grid, Vec<D> d) {
  for (int k = 0; k < D; ++k)
    if (grid.periodic[k]) d[k] -= grid.length[k] * round(d[k] / grid.length[k]);
  return d;
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
