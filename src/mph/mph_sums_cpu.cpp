#include "treacle/mph/mph_sums.hpp"

#include "treacle/mph/mph_lanes.hpp"

namespace treacle {
namespace {

/// C q / gradientFactor of the particles of a cluster of fluid.
template <bool Renormalised, int D>
VecLanes<D> pressureGradient(const MphPairs<D>& pairs, const ClusterRange& range, const ClusterPlaces<D>& x,
                             std::uint32_t c, std::span<const double> q) {
  const double floor2 = distanceFloor2(pairs);
  const Lanes qi = loadLanes(range, q);
  VecLanes<D> sum = {}, own = {};  // own: of g d, which meets q_i B_i
  for (ListSegment s : nearSegments)
    for (std::uint32_t j : pairs.fluidList.segment(c, s)) {
      const PairLanes<D> pair(pairs, j, x, floor2);
      if constexpr (Renormalised) {
        const Lanes g = pairs.terms.gradientShape(pair.r);
        VecLanes<D> gd;
        for (int k = 0; k < D; ++k) own[k] += gd[k] = g * pair.d[k];
        const VecLanes<D> ofOther = corrected(pairs, j, gd);
        for (int k = 0; k < D; ++k) sum[k] += q[j] * ofOther[k];
      } else {
        const Lanes f = pairs.terms.gradientShape(pair.r) * (qi + q[j]);
        for (int k = 0; k < D; ++k) sum[k] += f * pair.d[k];
      }
    }
  if constexpr (Renormalised) {
    const SymmetricBlock<D, Lanes> b = loadBlocks<Lanes>(range, pairs.renormalisation);
    for (int k = 0; k < D; ++k) sum[k] += qi * b.row(k, own);
  }
  return sum;
}

/// C^T u of a list; walls have no B.
template <bool Renormalised, int D>
void divergenceOf(const MphPairs<D>& pairs, const ClusterListView& list, std::span<const Vec<D>> u,
                  std::span<double> div) {
  const double floor2 = distanceFloor2(pairs);
  forEachCluster<D>(pairs, list, [&](const ClusterRange& range, const ClusterPlaces<D>& x, std::uint32_t c) {
    const VecLanes<D> ui = loadLanes<D>(range, u);
    SymmetricBlock<D, Lanes> b;
    if constexpr (Renormalised) b = loadBlocks<Lanes>(range, pairs.renormalisation);
    Lanes sum = {};
    for (ListSegment s : nearSegments)
      for (std::uint32_t j : list.segment(c, s)) {
        const PairLanes<D> pair(pairs, j, x, floor2);
        Lanes along = {};
        for (int k = 0; k < D; ++k) {
          if constexpr (Renormalised)
            along += (u[j][k] - ui[k]) * b.row(k, pair.d);
          else
            along += (u[j][k] - ui[k]) * pair.d[k];
        }
        sum -= pairs.terms.gradientShape(pair.r) * along;
      }
    storeLanes(range, pairs.terms.gradientFactor * sum, div);
  });
}

}  // namespace

template <int D>
void numberDensity(Context<Cpu>&, const MphPairs<D>& pairs, std::span<double> n, const PlaceSums& places) {
  const double floor2 = distanceFloor2(pairs);
  std::span<const ListSegment> segments = nearSegments;
  if (pairs.terms.densityRadius > pairs.terms.pressureRadius) segments = allSegments;
  for (const ClusterListView& list : {pairs.fluidList, pairs.wallList})
    forEachCluster<D>(pairs, list, [&](const ClusterRange& range, const ClusterPlaces<D>& x, std::uint32_t c) {
      Lanes sum = {}, around = {};
      VecLanes<D> away = {};
      for (ListSegment s : segments)
        for (std::uint32_t j : list.segment(c, s)) {
          const PairLanes<D> pair(pairs, j, x, floor2);
          Lanes w = pairs.terms.density(pairs.terms.densityFactor, pair.r);
          const std::uint32_t self = j - range.first;
          if (self < clusterSize) w[self] = 0;  // a particle is not its own neighbour
          sum += w;
          if (places.open.empty()) continue;
          Lanes v = pairs.terms.openness(pair.r);
          if (self < clusterSize) v[self] = 0;
          around += v;
          for (int k = 0; k < D; ++k) away[k] += v * pair.d[k];
        }
      storeLanes(range, sum, n);
      if (places.open.empty()) return;
      storeLanes(range, pairs.wideScale * around, places.wide);
      Lanes square = {};
      for (int k = 0; k < D; ++k) square += away[k] * away[k];
      storeLanes(range, pairs.opennessFactor() * squareRoot(square), places.open);
    });
}

template <int D>
void wallDensity(Context<Cpu>&, const MphPairs<D>& pairs, std::span<double> n) {
  const double floor2 = distanceFloor2(pairs);
  const ClusterListView& list = pairs.fluidList;
  forEachCluster<D>(pairs, list, [&](const ClusterRange& range, const ClusterPlaces<D>& x, std::uint32_t c) {
    Lanes sum = {};
    for (ListSegment s : wallSegments)
      for (std::uint32_t j : list.segment(c, s))
        sum += pairs.terms.density(pairs.terms.densityFactor, PairLanes<D>(pairs, j, x, floor2).r);
    storeLanes(range, sum, n);
  });
}

template <int D>
void addPressureGradient(Context<Cpu>&, const MphPairs<D>& pairs, std::span<const double> q, double factor,
                         std::span<Vec<D>> y) {
  const ClusterListView& list = pairs.fluidList;
  forEachCluster<D>(pairs, list, [&](const ClusterRange& range, const ClusterPlaces<D>& x, std::uint32_t c) {
    const VecLanes<D> sum = pairs.renormalisation ? pressureGradient<true>(pairs, range, x, c, q)
                                                  : pressureGradient<false>(pairs, range, x, c, q);
    VecLanes<D> yi = loadLanes<D>(range, std::span<const Vec<D>>(y));
    for (int k = 0; k < D; ++k) yi[k] += factor * pairs.terms.gradientFactor * sum[k];
    storeLanes<D>(range, yi, y);
  });
}

template <int D>
void divergence(Context<Cpu>&, const MphPairs<D>& pairs, std::span<const Vec<D>> u, std::span<double> div) {
  withRenormalisation(pairs,
                      [&]<bool Renormalised>() { divergenceOf<Renormalised>(pairs, pairs.fluidList, u, div); });
  divergenceOf<false>(pairs, pairs.wallList, u, div);
}

template <int D>
void wallTerms(Context<Cpu>&, const MphPairs<D>& pairs, const WallTerms<D>& terms) {
  const double floor2 = distanceFloor2(pairs);
  const ClusterListView& list = pairs.fluidList;
  forEachCluster<D>(pairs, list, [&](const ClusterRange& range, const ClusterPlaces<D>& x, std::uint32_t c) {
    const ViscosityLanes<D> viscosity(pairs, range);
    Lanes block[D][D] = {};
    VecLanes<D> gradient = {};
    for (ListSegment s : wallSegments)
      for (std::uint32_t j : list.segment(c, s)) {
        const PairLanes<D> pair(pairs, j, x, floor2);
        const Lanes f = pairs.terms.viscous(viscosity.with(j), pair.r) * wallFactors(pairs, range, j, pair.d);
        const Lanes g = pairs.terms.gradient(pair.r);
        for (int r = 0; r < D; ++r) {
          gradient[r] += g * pair.d[r];
          for (int k = 0; k < D; ++k) block[r][k] += f * pair.d[r] * pair.d[k];
        }
      }
    for (std::uint32_t lane = 0; lane < range.count; ++lane) {
      const std::uint32_t i = range.first + lane;
      terms.block[i] = Block<D>::diagonal(pairs.inertia(i));
      Vec<D> own;
      for (int r = 0; r < D; ++r) {
        own[r] = gradient[r][lane];
        for (int k = 0; k < D; ++k) terms.block[i](r, k) += block[r][k][lane];
      }
      terms.gradient[i] = pairs.corrected(i, own);
    }
  });
}

template <int D>
void addWallDrag(Context<Cpu>&, const MphPairs<D>& pairs, std::span<const Vec<D>> u, std::span<Vec<D>> y) {
  const double floor2 = distanceFloor2(pairs);
  const ClusterListView& list = pairs.fluidList;
  forEachCluster<D>(pairs, list, [&](const ClusterRange& range, const ClusterPlaces<D>& x, std::uint32_t c) {
    const ViscosityLanes<D> viscosity(pairs, range);
    VecLanes<D> yi = loadLanes<D>(range, std::span<const Vec<D>>(y));
    for (ListSegment s : wallSegments)
      for (std::uint32_t j : list.segment(c, s)) {
        const PairLanes<D> pair(pairs, j, x, floor2);
        Lanes along = {};
        for (int k = 0; k < D; ++k) along += pair.d[k] * u[j][k];
        const Lanes f =
            pairs.terms.viscous(viscosity.with(j), pair.r) * wallFactors(pairs, range, j, pair.d) * along;
        for (int k = 0; k < D; ++k) yi[k] += f * pair.d[k];
      }
    storeLanes<D>(range, yi, y);
  });
}

#define TREACLE_INSTANTIATE(D)                                                                                \
  template void numberDensity<D>(Context<Cpu>&, const MphPairs<D>&, std::span<double>, const PlaceSums&);     \
  template void wallDensity<D>(Context<Cpu>&, const MphPairs<D>&, std::span<double>);                         \
  template void addPressureGradient<D>(Context<Cpu>&, const MphPairs<D>&, std::span<const double>, double,    \
                                       std::span<Vec<D>>);                                                    \
  template void divergence<D>(Context<Cpu>&, const MphPairs<D>&, std::span<const Vec<D>>, std::span<double>); \
  template void wallTerms<D>(Context<Cpu>&, const MphPairs<D>&, const WallTerms<D>&);                         \
  template void addWallDrag<D>(Context<Cpu>&, const MphPairs<D>&, std::span<const Vec<D>>, std::span<Vec<D>>);
TREACLE_INSTANTIATE(2)
TREACLE_INSTANTIATE(3)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
