#include "treacle/mph/mph_lanes.hpp"
#include "treacle/mph/viscosity_scale.hpp"

namespace treacle {

template <int D>
void viscosityScale(Context<Cpu>&, const MphPairs<D>& pairs, double correction, std::span<double> scale) {
  const double floor2 = distanceFloor2(pairs);
  const ClusterListView& list = pairs.fluidList;
  forEachCluster<D>(pairs, list, [&](const ClusterRange& range, const ClusterPlaces<D>& x, std::uint32_t c) {
    Lanes sum = {};
    for (ListSegment s :
         {ListSegment::NearFluid, ListSegment::FarFluid, ListSegment::NearWall, ListSegment::FarWall})
      for (std::uint32_t j : list.segment(c, s)) {
        const PairLanes<D> pair(pairs, j, x, floor2);
        Lanes r2 = {};
        for (int k = 0; k < D; ++k) r2 += pair.d[k] * pair.d[k];
        sum += pairs.terms.resistanceShape(pair.r) * r2;
      }
    for (std::uint32_t lane = 0; lane < range.count; ++lane)
      scale[range.first + lane] = viscosityScaleOf<D>(pairs.terms.viscousFactor * sum[lane], correction);
  });
}

template void viscosityScale<2>(Context<Cpu>&, const MphPairs<2>&, double, std::span<double>);
template void viscosityScale<3>(Context<Cpu>&, const MphPairs<3>&, double, std::span<double>);

}  // namespace treacle
