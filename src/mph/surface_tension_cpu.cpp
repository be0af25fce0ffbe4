#include "treacle/mph/surface_tension.hpp"

#include "treacle/mph/mph_lanes.hpp"

namespace treacle {

template <int D>
void surfaceSlope(Context<Cpu>&, const MphPairs<D>& pairs, const SurfaceTerms<D>& terms, std::span<Vec<D>> m) {
  const double floor2 = distanceFloor2(pairs);
  const ClusterListView& list = pairs.fluidList;
  forEachCluster<D>(pairs, list, [&](const ClusterRange& range, const ClusterPlaces<D>& x, std::uint32_t c) {
    VecLanes<D> sum = {};
    for (ListSegment s :
         {ListSegment::NearFluid, ListSegment::FarFluid, ListSegment::NearWall, ListSegment::FarWall})
      for (std::uint32_t j : list.segment(c, s)) {
        const PairLanes<D> pair(pairs, j, x, floor2);
        const Lanes g = terms.gradient(pair.r.square);
        for (int k = 0; k < D; ++k) sum[k] += g * pair.d[k];
      }
    for (std::uint32_t lane = 0; lane < range.count; ++lane) {
      const std::uint32_t i = range.first + lane;
      Vec<D> g;
      for (int k = 0; k < D; ++k) g[k] = sum[k][lane];
      m[i] = terms.slope(pairs.material[i], g);
    }
  });
}

template <int D>
void addSurfaceTension(Context<Cpu>&, const MphPairs<D>& pairs, const SurfaceTerms<D>& terms,
                       std::span<const Vec<D>> m, std::span<Vec<D>> y) {
  const double floor2 = distanceFloor2(pairs);
  const ClusterListView& list = pairs.fluidList;
  forEachCluster<D>(pairs, list, [&](const ClusterRange& range, const ClusterPlaces<D>& x, std::uint32_t c) {
    const VecLanes<D> mi = loadLanes<D>(range, m);
    Lanes mi2 = {};
    for (int k = 0; k < D; ++k) mi2 += mi[k] * mi[k];
    VecLanes<D> sum = {};
    for (ListSegment s : {ListSegment::NearFluid, ListSegment::FarFluid})
      for (std::uint32_t j : list.segment(c, s)) {
        const PairLanes<D> pair(pairs, j, x, floor2);
        const Lanes g = terms.gradient(pair.r.square);
        const Vec<D>& mj = m[j];
        Lanes alongI = {}, alongJ = {};
        for (int k = 0; k < D; ++k) {
          alongI += mi[k] * pair.d[k];
          alongJ += mj[k] * pair.d[k];
        }
        const Lanes both = mi2 + norm2(mj), along = (g - terms.core(pair.r.inverse)) * both;
        for (int k = 0; k < D; ++k) sum[k] += along * pair.d[k] - g * (alongI * mi[k] + alongJ * mj[k]);
      }
    VecLanes<D> yi = loadLanes<D>(range, std::span<const Vec<D>>(y));
    for (int k = 0; k < D; ++k) yi[k] += sum[k];
    storeLanes<D>(range, yi, y);
  });
}

#define TREACLE_INSTANTIATE(D)                                                                                 \
  template void surfaceSlope<D>(Context<Cpu>&, const MphPairs<D>&, const SurfaceTerms<D>&, std::span<Vec<D>>); \
  template void addSurfaceTension<D>(Context<Cpu>&, const MphPairs<D>&, const SurfaceTerms<D>&,                \
                                     std::span<const Vec<D>>, std::span<Vec<D>>);
TREACLE_INSTANTIATE(2)
TREACLE_INSTANTIATE(3)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
