#include "lane_sums.hpp"
#include "treacle/mph/density_sums.hpp"
#include "treacle/mph/slip_sums.hpp"

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

template <int D, class Backend>
void addPressureGradient(Context<Backend>& context, const MphPairs<D>& pairs, std::span<const double> q,
                         double factor, std::span<Vec<D>> y) {
  const ClusterListView& list = pairs.fluidList;
  forEachCluster<D>(pairs, list, [&](const ClusterRange& range, const ClusterPlaces<D>& x, std::uint32_t c) {
    const VecLanes<D> sum = pairs.renormalisation ? pressureGradient<true>(pairs, range, x, c, q)
                                                  : pressureGradient<false>(pairs, range, x, c, q);
    VecLanes<D> yi = loadLanes<D>(range, std::span<const Vec<D>>(y));
    for (int k = 0; k < D; ++k) yi[k] += factor * pairs.terms.gradientFactor * sum[k];
    storeLanes<D>(range, yi, y);
  });
  subtractGradientAlongWalls(context, pairs, q, factor, y);
}

template <int D, class Backend>
void divergence(Context<Backend>& context, const MphPairs<D>& pairs, std::span<const Vec<D>> u,
                std::span<double> div) {
  withRenormalisation(pairs,
                      [&]<bool Renormalised>() { divergenceOf<Renormalised>(pairs, pairs.fluidList, u, div); });
  divergenceOf<false>(pairs, pairs.wallList, u, div);
  subtractDivergenceAlongWalls(context, pairs, u, div);
}

#define TREACLE_INSTANTIATE(D)                                                                          \
  TREACLE_DENSITY_SUMS(D, Cpu)                                                                          \
  TREACLE_SLIP_SUMS(D, Cpu)                                                                             \
  template void addPressureGradient(Context<Cpu>&, const MphPairs<D>&, std::span<const double>, double, \
                                    std::span<Vec<D>>);                                                 \
  template void divergence(Context<Cpu>&, const MphPairs<D>&, std::span<const Vec<D>>, std::span<double>);
TREACLE_INSTANTIATE(2)
TREACLE_INSTANTIATE(3)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
