#include "treacle/mph/surface_tension.hpp"

#include "treacle/mph/mph_lanes.hpp"

#include <cmath>

namespace treacle {

template <int D>
void surfaceSlope(Context<Cpu>&, const MphPairs<D>& pairs, const SurfaceTerms<D>& terms,
                  std::span<SurfaceSums<D>> sums, std::span<SurfaceSlope<D>> slope,
                  std::span<Adhesion<D>> adhesion) {
  const double floor2 = distanceFloor2(pairs);
  const ClusterListView& list = pairs.fluidList;
  forEachCluster<D>(pairs, list, [&](const ClusterRange& range, const ClusterPlaces<D>& x, std::uint32_t c) {
    VecLanes<D> fluid = {}, wall = {};
    Lanes filled = {}, walls = {}, colour = {}, wallColour = {}, repelled = {};
    for (ListSegment s : {ListSegment::NearFluid, ListSegment::FarFluid})
      for (std::uint32_t j : list.segment(c, s)) {
        const PairLanes<D> pair(pairs, j, x, floor2);
        const Lanes g = terms.gradient(pair.r.square);
        filled += terms.share(g, pair.r.square);
        colour += terms.weight(pair.r.square);
        for (int k = 0; k < D; ++k) fluid[k] += g * pair.d[k];
      }
    for (ListSegment s : {ListSegment::NearWall, ListSegment::FarWall})
      for (std::uint32_t j : list.segment(c, s)) {
        const PairLanes<D> pair(pairs, j, x, floor2);
        const Lanes g = terms.gradient(pair.r.square), share = terms.share(g, pair.r.square);
        walls += share;
        wallColour += terms.weight(pair.r.square);
        for (std::uint32_t lane = 0; lane < range.count; ++lane)
          repelled[lane] += terms.dryPull(pairs.material[range.first + lane], pairs.material[j]) * share[lane];
        for (int k = 0; k < D; ++k) wall[k] += g * pair.d[k];
      }
    for (std::uint32_t lane = 0; lane < range.count; ++lane) {
      const std::uint32_t i = range.first + lane;
      SurfaceSums<D>& sum = sums[i];
      for (int k = 0; k < D; ++k) sum.fluid[k] = fluid[k][lane], sum.wall[k] = wall[k][lane];
      sum.filled = filled[lane], sum.walls = walls[lane], sum.repelled = repelled[lane];
      sum.colour = colour[lane], sum.wallColour = wallColour[lane];
      slope[i] = terms.slope(pairs.material[i], sum);
      adhesion[i] = terms.adhesion(sum);
    }
  });
}

template <int D>
void wallAdhesion(Context<Cpu>&, const MphPairs<D>& pairs, const SurfaceTerms<D>& terms,
                  const ClusterListView& list, std::span<WallSums<D>> sums, std::span<Adhesion<D>> adhesion) {
  const double floor2 = distanceFloor2(pairs);
  forEachCluster<D>(pairs, list, [&](const ClusterRange& range, const ClusterPlaces<D>& x, std::uint32_t c) {
    VecLanes<D> wall = {};
    Lanes walls = {}, filled = {}, colour = {}, repels = {};
    for (ListSegment s : {ListSegment::NearFluid, ListSegment::FarFluid})
      for (std::uint32_t j : list.segment(c, s)) {
        const PairLanes<D> pair(pairs, j, x, floor2);
        const Lanes v = terms.wetting(pair.r.square);
        filled += v;
        colour += terms.weight(pair.r.square);
        for (std::uint32_t lane = 0; lane < range.count; ++lane)
          repels[lane] += terms.dryPull(pairs.material[j], pairs.material[range.first + lane]) * v[lane];
      }
    for (ListSegment s : {ListSegment::NearWall, ListSegment::FarWall})
      for (std::uint32_t j : list.segment(c, s)) {
        const PairLanes<D> pair(pairs, j, x, floor2);
        const Lanes g = terms.wettingGradient(pair.r.square);
        walls += terms.wetting(pair.r.square);
        colour += terms.weight(pair.r.square);
        for (int k = 0; k < D; ++k) wall[k] += g * pair.d[k];
      }
    for (std::uint32_t lane = 0; lane < range.count; ++lane) {
      WallSums<D>& sum = sums[range.first + lane - list.first];
      for (int k = 0; k < D; ++k) sum.wall[k] = wall[k][lane];
      sum.walls = walls[lane], sum.filled = filled[lane], sum.colour = colour[lane], sum.repels = repels[lane];
      adhesion[range.first + lane - list.first] = terms.adhesion(sum);
    }
  });
}

template <int D>
void surfaceForces(Context<Cpu>&, const MphPairs<D>& pairs, const SurfaceTerms<D>& terms,
                   std::span<const SurfaceSums<D>> sums, std::span<const SurfaceSlope<D>> slope,
                   std::span<const Adhesion<D>> adhesion, const SurfaceForces<D>& of) {
  const double floor2 = distanceFloor2(pairs);
  const ClusterListView& list = pairs.fluidList;
  forEachCluster<D>(pairs, list, [&](const ClusterRange& range, const ClusterPlaces<D>& x, std::uint32_t c) {
    VecLanes<D> mi = {}, li = {};
    Lanes mi2 = {}, tie = {};
    for (std::uint32_t lane = 0; lane < range.count; ++lane) {
      const SurfaceSlope<D>& own = slope[range.first + lane];
      for (int k = 0; k < D; ++k) mi[k][lane] = own.m[k];
      if constexpr (D == 3)
        for (int k = 0; k < D; ++k) li[k][lane] = own.line[k];
      tie[lane] = own.tie;
    }
    for (int k = 0; k < D; ++k) mi2 += mi[k] * mi[k];
    VecLanes<D> sum = {}, away = {}, press = {};
    for (ListSegment s : {ListSegment::NearFluid, ListSegment::FarFluid})
      for (std::uint32_t j : list.segment(c, s)) {
        const PairLanes<D> pair(pairs, j, x, floor2);
        const Lanes g = terms.gradient(pair.r.square), w = terms.weight(pair.r.square);
        const Vec<D>& mj = slope[j].m;
        const double mj2 = norm2(mj), mj1 = std::sqrt(mj2);
        Lanes alongI = {}, alongJ = {};
        for (int k = 0; k < D; ++k) {
          alongI += mi[k] * pair.d[k];
          alongJ += mj[k] * pair.d[k];
        }
        alongI *= tie, alongJ *= slope[j].tie;
        const Lanes both = mi2 + mj2, core = terms.core(pair.r.inverse) * both;
        for (int k = 0; k < D; ++k) {
          sum[k] += g * (both * pair.d[k] - alongI * mi[k] - alongJ * mj[k]);
          away[k] -= core * pair.d[k];
          press[k] += w * (mj1 * mj[k]);
        }
        if constexpr (D == 3) {
          const Vec<D>& lj = slope[j].line;
          const Lanes ofI = g * (li[0] * pair.d[0] + li[1] * pair.d[1] + li[2] * pair.d[2]);
          const Lanes ofJ = g * (lj[0] * pair.d[0] + lj[1] * pair.d[1] + lj[2] * pair.d[2]);
          for (int k = 0; k < D; ++k) sum[k] += ofI * li[k] + ofJ * lj[k];
        }
      }
    for (ListSegment s : {ListSegment::NearWall, ListSegment::FarWall})
      for (std::uint32_t j : list.segment(c, s)) {
        const Vec<D>& along = adhesion[j].along;
        if (norm2(along) == 0) continue;
        const PairLanes<D> pair(pairs, j, x, floor2);
        const VecLanes<D> force = terms.alongWall(pair.d, pair.r.square, along);
        Lanes pull = {};
        for (std::uint32_t lane = 0; lane < range.count; ++lane)
          pull[lane] = terms.wetPull(pairs.material[range.first + lane], pairs.material[j]);
        for (int k = 0; k < D; ++k) away[k] += pull * force[k];
      }
    storeLanes<D>(range, away, of.apart);
    storeLanes<D>(range, press, of.press);
    for (std::uint32_t lane = 0; lane < range.count; ++lane) {
      const std::uint32_t i = range.first + lane;
      Vec<D> ofFluid;
      for (int k = 0; k < D; ++k) ofFluid[k] = sum[k][lane];
      terms.finish(pairs.material[i], i, sums[i], slope[i].m, ofFluid, of);
    }
  });
}

template <int D>
void bendSurface(Context<Cpu>&, const MphPairs<D>& pairs, const SurfaceTerms<D>& terms, const SurfaceForces<D>& of,
                 std::span<SurfaceFit> fitted) {
  const double floor2 = distanceFloor2(pairs);
  const ClusterListView& list = pairs.fluidList;
  forEachCluster<D>(pairs, list, [&](const ClusterRange& range, const ClusterPlaces<D>& x, std::uint32_t c) {
    const VecLanes<D> mi = loadLanes<D>(range, std::span<const Vec<D>>(of.normal));
    Lanes mi1 = {};
    for (int k = 0; k < D; ++k) mi1 += mi[k] * mi[k];
    mi1 = squareRoot(mi1);
    VecLanes<D> sum = loadLanes<D>(range, std::span<const Vec<D>>(of.force));
    Lanes force = {}, press = {};
    for (ListSegment s : {ListSegment::NearFluid, ListSegment::FarFluid})
      for (std::uint32_t j : list.segment(c, s)) {
        const PairLanes<D> pair(pairs, j, x, floor2);
        const Vec<D>& mj = of.normal[j];
        const double mj1 = norm(mj);
        Lanes closing = {};
        for (int k = 0; k < D; ++k) closing += pair.d[k] * (mi1 * mj[k] - mj1 * mi[k]);
        const Lanes bent = terms.bending(pair.r.square, pair.r.inverse) * closing;
        for (int k = 0; k < D; ++k) sum[k] += bent * pair.d[k];
        const Lanes near = terms.nearness(pair.r.square);
        force += near * of.fit[j].force, press += near * of.fit[j].press;
      }
    storeLanes<D>(range, sum, of.force);
    for (std::uint32_t lane = 0; lane < range.count; ++lane) {
      const std::uint32_t i = range.first + lane;
      fitted[i] = {force[lane], press[lane]};
      terms.split(i, fitted[i], of);
    }
  });
}

template <int D>
void evenAlongSurface(Context<Cpu>&, const MphPairs<D>& pairs, const SurfaceTerms<D>& terms,
                      std::span<const Vec<D>> normal, std::span<const SurfaceFit> fit, std::span<const Vec<D>> f,
                      std::span<Vec<D>> y, std::span<const Vec<D>> apart) {
  const double floor2 = distanceFloor2(pairs);
  const ClusterListView& list = pairs.fluidList;
  forEachCluster<D>(pairs, list, [&](const ClusterRange& range, const ClusterPlaces<D>& x, std::uint32_t c) {
    const VecLanes<D> mi = loadLanes<D>(range, normal), fi = loadLanes<D>(range, f);
    VecLanes<D> sum = fi;
    Lanes shares = {};
    for (std::uint32_t lane = 0; lane < range.count; ++lane) shares[lane] = fit[range.first + lane].press;
    if (!apart.empty()) {
      const VecLanes<D> more = loadLanes<D>(range, apart);
      for (int a = 0; a < D; ++a) sum[a] += more[a];
    }
    for (ListSegment s : {ListSegment::NearFluid, ListSegment::FarFluid})
      for (std::uint32_t j : list.segment(c, s)) {
        if (fit[j].press == 0) continue;
        const PairLanes<D> pair(pairs, j, x, floor2);
        const Vec<D>& mj = normal[j];
        Lanes normal2 = terms.evenNoise, across = {}, closing = {};
        for (int a = 0; a < D; ++a) {
          const Lanes n = mi[a] + mj[a];
          normal2 += n * n, across += n * pair.d[a], closing += pair.d[a] * (f[j][a] - fi[a]);
        }
        const Lanes unit2 = pair.r.inverse * pair.r.inverse, along = 1.0 - across * across * unit2 / normal2;
        const Lanes k = terms.evenFactor * terms.nearness(pair.r.square) * along * unit2 * closing;
        for (int a = 0; a < D; ++a) sum[a] += select(shares > 0.0, k, Lanes(0.0)) * pair.d[a];
      }
    storeLanes<D>(range, sum, y);
  });
}

template <int D>
void addSurfaceForces(Context<Cpu>&, std::span<const Vec<D>> f, std::span<Vec<D>> y) {
  parallelFor(f.size(), parallelGrain, [&](std::size_t i) { y[i] += f[i]; });
}

template <int D>
void surfaceOnWalls(Context<Cpu>&, const MphPairs<D>& pairs, const SurfaceTerms<D>& terms,
                    const ClusterListView& walls, std::span<const Vec<D>> ofWalls,
                    std::span<const Adhesion<D>> adhesion, std::span<Vec<D>> y, std::span<Vec<D>> load) {
  const double floor2 = distanceFloor2(pairs);
  forEachCluster<D>(pairs, walls, [&](const ClusterRange& range, const ClusterPlaces<D>& x, std::uint32_t c) {
    VecLanes<D> sum = {};
    for (ListSegment s : {ListSegment::NearFluid, ListSegment::FarFluid})
      for (std::uint32_t i : walls.segment(c, s)) {
        const PairLanes<D> pair(pairs, i, x, floor2);
        const Lanes share = terms.share(terms.gradient(pair.r.square), pair.r.square);
        for (int k = 0; k < D; ++k) sum[k] -= share * ofWalls[i][k];
        for (std::uint32_t lane = 0; lane < range.count; ++lane) {
          const std::uint32_t j = range.first + lane;
          if (norm2(adhesion[j].along) == 0) continue;
          Vec<D> d;
          for (int k = 0; k < D; ++k) d[k] = pair.d[k][lane];
          const Vec<D> pull = terms.alongWall(d, norm2(d), adhesion[j].along) *
                              terms.wetPull(pairs.material[i], pairs.material[j]);
          for (int k = 0; k < D; ++k) sum[k][lane] += pull[k];
        }
      }
    const ClusterRange place(range.first - walls.first, range.first - walls.first + range.count);
    VecLanes<D> all = loadLanes<D>(place, std::span<const Vec<D>>(load));
    for (int k = 0; k < D; ++k) all[k] += sum[k];
    storeLanes<D>(place, sum, y);
    storeLanes<D>(place, all, load);
  });
}

#define TREACLE_INSTANTIATE(D)                                                                                   \
  template void surfaceSlope<D>(Context<Cpu>&, const MphPairs<D>&, const SurfaceTerms<D>&,                       \
                                std::span<SurfaceSums<D>>, std::span<SurfaceSlope<D>>, std::span<Adhesion<D>>);  \
  template void wallAdhesion<D>(Context<Cpu>&, const MphPairs<D>&, const SurfaceTerms<D>&,                       \
                                const ClusterListView&, std::span<WallSums<D>>, std::span<Adhesion<D>>);         \
  template void surfaceForces<D>(Context<Cpu>&, const MphPairs<D>&, const SurfaceTerms<D>&,                      \
                                 std::span<const SurfaceSums<D>>, std::span<const SurfaceSlope<D>>,              \
                                 std::span<const Adhesion<D>>, const SurfaceForces<D>&);                         \
  template void bendSurface<D>(Context<Cpu>&, const MphPairs<D>&, const SurfaceTerms<D>&,                        \
                               const SurfaceForces<D>&, std::span<SurfaceFit>);                                  \
  template void evenAlongSurface<D>(Context<Cpu>&, const MphPairs<D>&, const SurfaceTerms<D>&,                   \
                                    std::span<const Vec<D>>, std::span<const SurfaceFit>,                        \
                                    std::span<const Vec<D>>, std::span<Vec<D>>, std::span<const Vec<D>>);        \
  template void addSurfaceForces<D>(Context<Cpu>&, std::span<const Vec<D>>, std::span<Vec<D>>);                  \
  template void surfaceOnWalls<D>(Context<Cpu>&, const MphPairs<D>&, const SurfaceTerms<D>&,                     \
                                  const ClusterListView&, std::span<const Vec<D>>, std::span<const Adhesion<D>>, \
                                  std::span<Vec<D>>, std::span<Vec<D>>);
TREACLE_INSTANTIATE(2)
TREACLE_INSTANTIATE(3)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
