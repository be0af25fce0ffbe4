#include "treacle/mph/mph_lanes.hpp"
#include "treacle/mph/renormalisation.hpp"

namespace treacle {

template <int D>
void renormalisation(Context<Cpu>&, const MphPairs<D>& pairs, std::span<SymmetricBlock<D>> b) {
  const double floor2 = distanceFloor2(pairs);
  const ClusterListView& list = pairs.fluidList;
  forEachCluster<D>(pairs, list, [&](const ClusterRange& range, const ClusterPlaces<D>& x, std::uint32_t c) {
    Lanes moment[SymmetricBlock<D>::size] = {};
    for (ListSegment s : {ListSegment::NearFluid, ListSegment::NearWall})
      for (std::uint32_t j : list.segment(c, s)) {
        const PairLanes<D> pair(pairs, j, x, floor2);
        const Lanes g = pairs.terms.gradient(pair.r);
        for (int r = 0, at = 0; r < D; ++r)
          for (int k = r; k < D; ++k) moment[at++] += g * pair.d[r] * pair.d[k];
      }
    for (std::uint32_t lane = 0; lane < range.count; ++lane) {
      SymmetricBlock<D> m;
      for (int at = 0; at < m.size; ++at) m.a[at] = moment[at][lane];
      b[range.first + lane] = renormalisationOf(m);
    }
  });
}

template void renormalisation<2>(Context<Cpu>&, const MphPairs<2>&, std::span<SymmetricBlock<2>>);
template void renormalisation<3>(Context<Cpu>&, const MphPairs<3>&, std::span<SymmetricBlock<3>>);

}  // namespace treacle
