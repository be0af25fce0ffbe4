#include "treacle/mph/surface_tension.hpp"

#include "treacle/mph/mph_lanes.hpp"

namespace treacle {

template <int D>
void surfaceSlope(Context<Cpu>&, const MphPairs<D>& pairs, const SurfaceTerms<D>& terms,
                  std::span<SurfaceSums<D>> sums, std::span<Vec<D>> m, std::span<Vec<D>> free) {
  const double floor2 = distanceFloor2(pairs);
  const ClusterListView& list = pairs.fluidList;
  forEachCluster<D>(pairs, list, [&](const ClusterRange& range, const ClusterPlaces<D>& x, std::uint32_t c) {
    VecLanes<D> fluid = {}, wall = {};
    Lanes filled = {}, walls = {}, pull = {};
    for (ListSegment s : {ListSegment::NearFluid, ListSegment::FarFluid})
      for (std::uint32_t j : list.segment(c, s)) {
        const PairLanes<D> pair(pairs, j, x, floor2);
        const Lanes g = terms.gradient(pair.r.square);
        filled += terms.share(g, pair.r.square);
        for (int k = 0; k < D; ++k) fluid[k] += g * pair.d[k];
      }
    for (ListSegment s : {ListSegment::NearWall, ListSegment::FarWall})
      for (std::uint32_t j : list.segment(c, s)) {
        const PairLanes<D> pair(pairs, j, x, floor2);
        const Lanes g = terms.gradient(pair.r.square), share = terms.share(g, pair.r.square);
        walls += share;
        pull += terms.pull[pairs.material[j]] * share;
        for (int k = 0; k < D; ++k) wall[k] += g * pair.d[k];
      }
    for (std::uint32_t lane = 0; lane < range.count; ++lane) {
      const std::uint32_t i = range.first + lane;
      SurfaceSums<D>& sum = sums[i];
      for (int k = 0; k < D; ++k) sum.fluid[k] = fluid[k][lane], sum.wall[k] = wall[k][lane];
      sum.filled = filled[lane], sum.walls = walls[lane], sum.pull = pull[lane];
      m[i] = terms.slope(pairs.material[i], sum);
      free[i] = terms.sharing(pairs.material[i], sum, m[i]);
    }
  });
}

template <int D>
void surfaceForces(Context<Cpu>&, const MphPairs<D>& pairs, const SurfaceTerms<D>& terms,
                   std::span<const SurfaceSums<D>> sums, std::span<const Vec<D>> m, std::span<Vec<D>> force,
                   std::span<Vec<D>> apart, std::span<Vec<D>> ofWalls) {
  const double floor2 = distanceFloor2(pairs);
  const ClusterListView& list = pairs.fluidList;
  forEachCluster<D>(pairs, list, [&](const ClusterRange& range, const ClusterPlaces<D>& x, std::uint32_t c) {
    const VecLanes<D> mi = loadLanes<D>(range, m);
    Lanes mi2 = {};
    for (int k = 0; k < D; ++k) mi2 += mi[k] * mi[k];
    VecLanes<D> sum = {}, away = {};
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
        const Lanes both = mi2 + norm2(mj), core = terms.core(pair.r.inverse) * both;
        for (int k = 0; k < D; ++k) {
          sum[k] += g * (both * pair.d[k] - alongI * mi[k] - alongJ * mj[k]);
          away[k] -= core * pair.d[k];
        }
      }
    storeLanes<D>(range, away, apart);
    for (std::uint32_t lane = 0; lane < range.count; ++lane) {
      const std::uint32_t i = range.first + lane;
      Vec<D> ofFluid;
      for (int k = 0; k < D; ++k) ofFluid[k] = sum[k][lane];
      const Vec<D> wall = terms.ofWalls(sums[i], m[i], ofFluid);
      force[i] = ofFluid + wall;
      if (!ofWalls.empty()) ofWalls[i] = sums[i].walls > 0 ? wall * (1 / sums[i].walls) : Vec<D>{};
    }
  });
}

template <int D>
void evenAlongSurface(Context<Cpu>&, const MphPairs<D>& pairs, const SurfaceTerms<D>& terms,
                      std::span<const Vec<D>> free, std::span<const Vec<D>> f, std::span<Vec<D>> y,
                      std::span<const Vec<D>> apart) {
  const double floor2 = distanceFloor2(pairs);
  const ClusterListView& list = pairs.fluidList;
  forEachCluster<D>(pairs, list, [&](const ClusterRange& range, const ClusterPlaces<D>& x, std::uint32_t c) {
    const VecLanes<D> mi = loadLanes<D>(range, free), fi = loadLanes<D>(range, f);
    VecLanes<D> sum = loadLanes<D>(range, std::span<const Vec<D>>(y));
    Lanes mi2 = {};
    for (int a = 0; a < D; ++a) sum[a] += fi[a], mi2 += mi[a] * mi[a];
    if (!apart.empty()) {
      const VecLanes<D> more = loadLanes<D>(range, apart);
      for (int a = 0; a < D; ++a) sum[a] += more[a];
    }
    for (ListSegment s : {ListSegment::NearFluid, ListSegment::FarFluid})
      for (std::uint32_t j : list.segment(c, s)) {
        const PairLanes<D> pair(pairs, j, x, floor2);
        const Vec<D>& mj = free[j];
        const double mj2 = norm2(mj);
        if (mj2 == 0) continue;
        Lanes normal2 = broadcast(terms.evenNoise), across = {}, closing = {};
        for (int a = 0; a < D; ++a) {
          const Lanes n = mi[a] + mj[a];
          normal2 += n * n, across += n * pair.d[a], closing += pair.d[a] * (f[j][a] - fi[a]);
        }
        const Lanes unit2 = pair.r.inverse * pair.r.inverse, along = 1.0 - across * across * unit2 / normal2;
        const Lanes k = terms.evening(pair.r.square) * along * unit2 * closing;
        for (int a = 0; a < D; ++a) sum[a] += (mi2 > 0.0 ? k : Lanes{}) * pair.d[a];
      }
    storeLanes<D>(range, sum, y);
  });
}

template <int D>
void surfaceOnWalls(Context<Cpu>&, const MphPairs<D>& pairs, const SurfaceTerms<D>& terms,
                    const ClusterListView& walls, std::span<const Vec<D>> ofWalls, std::span<Vec<D>> y,
                    std::span<Vec<D>> load) {
  const double floor2 = distanceFloor2(pairs);
  forEachCluster<D>(pairs, walls, [&](const ClusterRange& range, const ClusterPlaces<D>& x, std::uint32_t c) {
    VecLanes<D> sum = {};
    for (ListSegment s : {ListSegment::NearFluid, ListSegment::FarFluid})
      for (std::uint32_t i : walls.segment(c, s)) {
        const PairLanes<D> pair(pairs, i, x, floor2);
        const Lanes share = terms.share(terms.gradient(pair.r.square), pair.r.square);
        for (int k = 0; k < D; ++k) sum[k] -= share * ofWalls[i][k];
      }
    const ClusterRange place(range.first - walls.first, range.first - walls.first + range.count);
    VecLanes<D> all = loadLanes<D>(place, std::span<const Vec<D>>(load));
    for (int k = 0; k < D; ++k) all[k] += sum[k];
    storeLanes<D>(place, sum, y);
    storeLanes<D>(place, all, load);
  });
}

#define TREACLE_INSTANTIATE(D)                                                                                \
  template void surfaceSlope<D>(Context<Cpu>&, const MphPairs<D>&, const SurfaceTerms<D>&,                    \
                                std::span<SurfaceSums<D>>, std::span<Vec<D>>, std::span<Vec<D>>);             \
  template void surfaceForces<D>(Context<Cpu>&, const MphPairs<D>&, const SurfaceTerms<D>&,                   \
                                 std::span<const SurfaceSums<D>>, std::span<const Vec<D>>, std::span<Vec<D>>, \
                                 std::span<Vec<D>>, std::span<Vec<D>>);                                       \
  template void evenAlongSurface<D>(Context<Cpu>&, const MphPairs<D>&, const SurfaceTerms<D>&,                \
                                    std::span<const Vec<D>>, std::span<const Vec<D>>, std::span<Vec<D>>,      \
                                    std::span<const Vec<D>>);                                                 \
  template void surfaceOnWalls<D>(Context<Cpu>&, const MphPairs<D>&, const SurfaceTerms<D>&,                  \
                                  const ClusterListView&, std::span<const Vec<D>>, std::span<Vec<D>>,         \
                                  std::span<Vec<D>>);
TREACLE_INSTANTIATE(2)
TREACLE_INSTANTIATE(3)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
