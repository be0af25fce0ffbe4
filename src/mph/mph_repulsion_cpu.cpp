#include "treacle/mph/mph_repulsion.hpp"

#include "treacle/mph/mph_lanes.hpp"

namespace treacle {
namespace {

/// What is to be multiplied by the rate and -d, for the lanes of a cluster.
template <int D>
class ForceLanes {
 public:
  ForceLanes(const MphPairs<D>& pairs, const PairsApart& apart, const ClusterRange& range)
      : pairs_(pairs), apart_(apart), viscosity_(pairs, range) {
    for (std::uint32_t lane = 0; lane < clusterSize; ++lane) tension_[lane] = apart.tension(range.particle(lane));
  }
  Lanes with(std::uint32_t j, const PairDistance<Lanes>& r) const {
    const Lanes viscosity = viscosity_.with(j);
    Lanes force = viscosity * pairs_.terms.repulsionShape(r);
    if (apart_.held.empty()) return force;
    const Lanes most = (PairsApart::mostTension / pairs_.terms.viscousFactor) * viscosity,
                tension = (1 / apart_.rate) * (tension_ + apart_.tension(j));
    return force +
           pairs_.terms.gradientFactor * pairs_.terms.tensionShape(r) * (most - positivePart(most - tension));
  }

 private:
  const MphPairs<D>& pairs_;
  const PairsApart& apart_;
  ViscosityLanes<D> viscosity_;
  Lanes tension_;
};

/// y += force on the particles of the list from those in its segments; y starts with the list's first particle.
template <int D>
void addForce(const MphPairs<D>& pairs, const ClusterListView& list, std::span<const ListSegment> segments,
              const PairsApart& apart, std::span<Vec<D>> y) {
  const double floor2 = distanceFloor2(pairs);
  forEachCluster<D>(pairs, list, [&](const ClusterRange& range, const ClusterPlaces<D>& x, std::uint32_t c) {
    const ForceLanes<D> force(pairs, apart, range);
    VecLanes<D> sum = {};
    for (ListSegment s : segments)
      for (std::uint32_t j : list.segment(c, s)) {
        const PairLanes<D> pair(pairs, j, x, floor2);
        const Lanes f = force.with(j, pair.r);
        for (int k = 0; k < D; ++k) sum[k] += f * pair.d[k];
      }
    const ClusterRange place(range.first - list.first, range.first - list.first + range.count);
    VecLanes<D> yi = loadLanes<D>(place, std::span<const Vec<D>>(y));
    for (int k = 0; k < D; ++k) yi[k] -= apart.rate * sum[k];
    storeLanes<D>(place, yi, y);
  });
}

}  // namespace

template <int D>
void addRepulsion(Context<Cpu>&, const MphPairs<D>& pairs, const PairsApart& apart, std::span<Vec<D>> y) {
  constexpr ListSegment segments[] = {ListSegment::NearFluid, ListSegment::NearWall};
  addForce<D>(pairs, pairs.fluidList, segments, apart, y);
}

template <int D>
void addRepulsionOnWalls(Context<Cpu>&, const MphPairs<D>& pairs, const PairsApart& apart, std::span<Vec<D>> y) {
  constexpr ListSegment segments[] = {ListSegment::NearFluid};
  addForce<D>(pairs, pairs.wallList, segments, apart, y);
}

template <int D>
void repulsionPower(Context<Cpu>&, const MphPairs<D>& pairs, const PairsApart& apart, std::span<const Vec<D>> u,
                    std::span<double> power) {
  const double floor2 = distanceFloor2(pairs);
  const ClusterListView& list = pairs.fluidList;
  forEachCluster<D>(pairs, list, [&](const ClusterRange& range, const ClusterPlaces<D>& x, std::uint32_t c) {
    const ForceLanes<D> force(pairs, apart, range);
    const VecLanes<D> ui = loadLanes<D>(range, u);
    const auto sum = [&](ListSegment segment) {
      Lanes total = {};
      for (std::uint32_t j : list.segment(c, segment)) {
        const PairLanes<D> pair(pairs, j, x, floor2);
        Lanes along = {};
        for (int k = 0; k < D; ++k) along += (u[j][k] - ui[k]) * pair.d[k];
        total += force.with(j, pair.r) * along;
      }
      return total;
    };
    storeLanes(range, apart.rate * (0.5 * sum(ListSegment::NearFluid) + sum(ListSegment::NearWall)), power);
  });
}

#define TREACLE_INSTANTIATE(D)                                                                                   \
  template void addRepulsion<D>(Context<Cpu>&, const MphPairs<D>&, const PairsApart&, std::span<Vec<D>>);        \
  template void addRepulsionOnWalls<D>(Context<Cpu>&, const MphPairs<D>&, const PairsApart&, std::span<Vec<D>>); \
  template void repulsionPower<D>(Context<Cpu>&, const MphPairs<D>&, const PairsApart&, std::span<const Vec<D>>, \
                                  std::span<double>);
TREACLE_INSTANTIATE(2)
TREACLE_INSTANTIATE(3)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
