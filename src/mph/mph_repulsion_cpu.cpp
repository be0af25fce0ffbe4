#include "treacle/mph/mph_repulsion.hpp"

#include "treacle/mph/mph_lanes.hpp"

namespace treacle {
namespace {

/// y += force on the particles of the list from those in its segments; y starts with the list's first particle.
template <int D>
void addForce(const MphPairs<D>& pairs, const ClusterListView& list, std::span<const ListSegment> segments,
              double rate, std::span<Vec<D>> y) {
  const double floor2 = distanceFloor2(pairs);
  forEachCluster<D>(pairs, list, [&](const ClusterRange& range, const ClusterPlaces<D>& x, std::uint32_t c) {
    const ViscosityLanes<D> viscosity(pairs, range);
    VecLanes<D> sum = {};
    for (ListSegment s : segments)
      for (std::uint32_t j : list.segment(c, s)) {
        const PairLanes<D> pair(pairs, j, x, floor2);
        const Lanes f = viscosity.with(j) * pairs.terms.repulsionShape(pair.r);
        for (int k = 0; k < D; ++k) sum[k] += f * pair.d[k];
      }
    const ClusterRange place(range.first - list.first, range.first - list.first + range.count);
    VecLanes<D> yi = loadLanes<D>(place, std::span<const Vec<D>>(y));
    for (int k = 0; k < D; ++k) yi[k] -= rate * sum[k];
    storeLanes<D>(place, yi, y);
  });
}

}  // namespace

template <int D>
void addRepulsion(Context<Cpu>&, const MphPairs<D>& pairs, double rate, std::span<Vec<D>> y) {
  addForce<D>(pairs, pairs.fluidList, nearSegments, rate, y);
}

template <int D>
void addRepulsionOnWalls(Context<Cpu>&, const MphPairs<D>& pairs, double rate, std::span<Vec<D>> y) {
  constexpr ListSegment segments[] = {ListSegment::NearFluid};
  addForce<D>(pairs, pairs.wallList, segments, rate, y);
}

template <int D>
void repulsionPower(Context<Cpu>&, const MphPairs<D>& pairs, double rate, std::span<const Vec<D>> u,
                    std::span<double> power) {
  const double floor2 = distanceFloor2(pairs);
  const ClusterListView& list = pairs.fluidList;
  forEachCluster<D>(pairs, list, [&](const ClusterRange& range, const ClusterPlaces<D>& x, std::uint32_t c) {
    const ViscosityLanes<D> viscosity(pairs, range);
    const VecLanes<D> ui = loadLanes<D>(range, u);
    const auto sum = [&](ListSegment segment) {
      Lanes total = {};
      for (std::uint32_t j : list.segment(c, segment)) {
        const PairLanes<D> pair(pairs, j, x, floor2);
        Lanes along = {};
        for (int k = 0; k < D; ++k) along += (u[j][k] - ui[k]) * pair.d[k];
        total += viscosity.with(j) * pairs.terms.repulsionShape(pair.r) * along;
      }
      return total;
    };
    storeLanes(range, rate * (0.5 * sum(ListSegment::NearFluid) + sum(ListSegment::NearWall)), power);
  });
}

#define TREACLE_INSTANTIATE(D)                                                                        \
  template void addRepulsion<D>(Context<Cpu>&, const MphPairs<D>&, double, std::span<Vec<D>>);        \
  template void addRepulsionOnWalls<D>(Context<Cpu>&, const MphPairs<D>&, double, std::span<Vec<D>>); \
  template void repulsionPower<D>(Context<Cpu>&, const MphPairs<D>&, double, std::span<const Vec<D>>, \
                                  std::span<double>);
TREACLE_INSTANTIATE(2)
TREACLE_INSTANTIATE(3)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
