#pragma once

#include "treacle/mph/mph_pairs.hpp"

#include <cstdint>

namespace treacle {

/// Calls f(j, d) for every entry j of particle i's cluster list in the given segment; d = x_j - x_i [m].
/// Neighbours of the cluster that are not i's are among them, and so is i itself, but none that a thin sheet parts
/// from it.
template <int D, class F>
TREACLE_HD void forEachEntry(const MphPairs<D>& pairs, std::uint32_t i, ListSegment segment, F&& f) {
  const ClusterListView& list = i < pairs.fluidCount ? pairs.fluidList : pairs.wallList;
  const std::uint32_t cluster = (i - list.first) / clusterSize;
  const std::uint64_t* offset = list.offset + std::size_t{listSegments} * cluster + static_cast<int>(segment);
  for (std::uint64_t k = offset[0]; k < offset[1]; ++k)
    if (const std::uint32_t j = list.entry[k]; !pairs.areParted(i, j)) f(j, pairs.difference(i, j));
}

/// Calls f(j, d, g) for every neighbour j != i within h_p, fluid then walls; g = -e w'^p [1/m].
template <int D, class F>
TREACLE_HD void forEachNear(const MphPairs<D>& pairs, std::uint32_t i, F&& f) {
  const double h2 = pairs.terms.pressureRadius * pairs.terms.pressureRadius;
  for (const ListSegment s : {ListSegment::NearFluid, ListSegment::NearWall})
    forEachEntry(pairs, i, s, [&](std::uint32_t j, const Vec<D>& d) {
      const double r2 = fixedDot(d, d);
      if (j != i && r2 < h2 && r2 > 0) f(j, d, pairs.terms.gradient(ExactDistance(r2)) * d);
    });
}

}  // namespace treacle
