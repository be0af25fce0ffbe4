#pragma once

#include "treacle/method/mph_pairs.hpp"

namespace treacle {

/// Calls f(entry, d) for every entry of particle i's cluster list in the given segment; d = x_j - x_i [m], at the
/// image that the list means. Neighbours of the cluster that are not i's are among them, and so is i itself.
template <int D, class F>
inline void forEachEntry(const MphPairs<D>& pairs, std::uint32_t i, ListSegment segment, F&& f) {
  const ClusterListView& list = i < pairs.fluidCount ? pairs.fluidList : pairs.wallList;
  const std::uint32_t cluster = (i - list.first) / clusterSize;
  // A list's images are seen from the cluster's first particle; i may stand across a periodic end from it.
  const Vec<D> xi = pairs.grid.beside(pairs.position[list.first + cluster * clusterSize], pairs.position[i]);
  for (ListEntry e : list.segment(cluster, segment)) f(e, pairs.positionOf(e) - xi);
}

/// Calls f(j, g) for every neighbour j != i within h_p, fluid then walls; g = -e w'^p [1/m].
template <int D, class F>
inline void forEachNear(const MphPairs<D>& pairs, std::uint32_t i, F&& f) {
  const double h2 = pairs.pressureWeight.radius * pairs.pressureWeight.radius;
  for (ListSegment s : {ListSegment::NearFluid, ListSegment::NearWall})
    forEachEntry(pairs, i, s, [&](ListEntry e, const Vec<D>& d) {
      const double r2 = norm2(d);
      if (e.index() == i || r2 >= h2 || r2 == 0) return;
      f(e.index(), pairs.pressure.factor * (1 / std::sqrt(r2) - pairs.pressure.inverseRadius) * d);
    });
}

}  // namespace treacle
