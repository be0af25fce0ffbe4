#pragma once

#include "treacle/mph/mph_pairs.hpp"

#include <cstdint>

namespace treacle {

/// Where particle i of a cluster stands as the cluster's list sees it: at the image nearest to the cluster's first
/// particle, across a periodic end if need be.
template <int D>
TREACLE_HD Vec<D> positionInCluster(const MphPairs<D>& pairs, std::uint32_t first, std::uint32_t i) {
  return pairs.grid.beside(pairs.position[first], pairs.position[i]);
}

/// Calls f(entry, d) for every entry of particle i's cluster list in the given segment; d = x_j - x_i [m], at the
/// image that the list means. Neighbours of the cluster that are not i's are among them, and so is i itself.
template <int D, class F>
TREACLE_HD void forEachEntry(const MphPairs<D>& pairs, std::uint32_t i, ListSegment segment, F&& f) {
  const ClusterListView& list = i < pairs.fluidCount ? pairs.fluidList : pairs.wallList;
  const std::uint32_t cluster = (i - list.first) / clusterSize;
  const Vec<D> xi = positionInCluster(pairs, list.first + cluster * clusterSize, i);
  const std::uint64_t* offset = list.offset + std::size_t{listSegments} * cluster + static_cast<int>(segment);
  for (std::uint64_t k = offset[0]; k < offset[1]; ++k) f(list.entry[k], pairs.positionOf(list.entry[k]) - xi);
}

/// Calls f(j, d, g) for every neighbour j != i within h_p, fluid then walls; g = -e w'^p [1/m].
template <int D, class F>
TREACLE_HD void forEachNear(const MphPairs<D>& pairs, std::uint32_t i, F&& f) {
  const double h2 = pairs.terms.pressureRadius * pairs.terms.pressureRadius;
  for (const ListSegment s : {ListSegment::NearFluid, ListSegment::NearWall})
    forEachEntry(pairs, i, s, [&](ListEntry e, const Vec<D>& d) {
      const double r2 = fixedDot(d, d);
      if (e.index() != i && r2 < h2 && r2 > 0) f(e.index(), d, pairs.terms.gradient(ExactDistance(r2)) * d);
    });
}

}  // namespace treacle
