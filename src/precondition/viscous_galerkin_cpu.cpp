#include "corner_galerkin.hpp"
#include "treacle/mph/mph_lanes.hpp"
#include "treacle/precondition/hat_grid.hpp"

namespace treacle {
namespace {

template <int D, class T>
ViscousMoments<D, double> toDouble(const ViscousMoments<D, T>& v) {
  ViscousMoments<D, double> r;
  for (int k = 0; k < momentCount<D>; ++k) r.m[k] = v.m[k];
  return r;
}

template <int D, class T>
void viscousMoments(const MphPairs<D>& pairs, Buffer<ViscousMoments<D, T>>& moments) {
  moments.resize(pairs.fluidCount);
  const double floor2 = distanceFloor2(pairs);
  forEachCluster<D>(
      pairs, pairs.fluidList, [&](const ClusterRange& range, const ClusterPlaces<D>& x, std::uint32_t c) {
        const ViscosityLanes<D> viscosity(pairs, range);
        Lanes sum[momentCount<D>] = {};
        for (ListSegment segment : {ListSegment::NearFluid, ListSegment::FarFluid})
          for (std::uint32_t j : pairs.fluidList.segment(c, segment)) {
            const PairLanes<D> pair(pairs, j, x, floor2);
            const Lanes f = pairs.terms.viscous(0.5 * viscousGalerkinFactor * viscosity.with(j), pair.r);
            forEachMoment<D>(pair.d, [&](int m, const Lanes& product) { sum[m] += f * product; });
          }
        for (std::uint32_t lane = 0; lane < range.count; ++lane)
          for (int m = 0; m < momentCount<D>; ++m) moments[range.first + lane].m[m] = static_cast<T>(sum[m][lane]);
      });
}

}  // namespace

template <int D, class T>
void viscousGalerkin(Context<Cpu>& context, const MphPairs<D>& pairs, const WallTerms<D>& terms,
                     const HatNodes<D>& nodes, Buffer<ViscousMoments<D, T>>& moments, BlockCsr<D>& a) {
  viscousMoments(pairs, moments);
  cornerGalerkin<D, D>(
      context, pairs, nodes,
      [&](std::uint32_t i, const NodeHat<D>& p, const NodeHat<D>& q) {
        Block<D> sum = toDouble(moments[i]).between(p.gradient, q.gradient);
        for (int k = 0; k < D * D; ++k) sum.a[k] += p.value * q.value * terms.block[i].a[k];
        return sum;
      },
      a);
}

#define TREACLE_INSTANTIATE(D, T)                                                                                 \
  template void viscousGalerkin<D, T>(Context<Cpu>&, const MphPairs<D>&, const WallTerms<D>&, const HatNodes<D>&, \
                                      Buffer<ViscousMoments<D, T>>&, BlockCsr<D>&);
TREACLE_INSTANTIATE(2, double)
TREACLE_INSTANTIATE(3, double)
TREACLE_INSTANTIATE(2, float)
TREACLE_INSTANTIATE(3, float)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
