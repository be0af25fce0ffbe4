#include "treacle/mph/tension.hpp"

#include "treacle/core/parallel.hpp"
#include "treacle/mph/mph_lanes.hpp"

namespace treacle {
namespace {

/// f(i) for every i below `count`.
template <class F>
void forEachParticle(std::size_t count, F&& f) {
  parallelFor(count, parallelGrain, [&](std::size_t i) { f(static_cast<std::uint32_t>(i)); });
}

/// 2 P_ij of the lanes of a cluster and a neighbour.
template <int D>
class PairTensionLanes {
 public:
  PairTensionLanes(const MphPairs<D>& pairs, const ClusterRange& range, std::span<const double> tension)
      : pairs_(pairs), tension_(tension), own_(loadLanes(range, tension)) {
    for (int m = 0; m < pairs.materials.count; ++m)
      for (std::uint32_t lane = 0; lane < clusterSize; ++lane)
        share_[m][lane] = tensionShare(pairs, pairs.substance(range.particle(lane)), static_cast<Substance>(m));
  }
  Lanes with(std::uint32_t j) const { return pairTension(share_[pairs_.substance(j)], own_, tension_[j]); }

 private:
  const MphPairs<D>& pairs_;
  std::span<const double> tension_;
  Lanes own_;
  Lanes share_[maxMaterials];
};

}  // namespace

template <int D>
void lackOfDensity(Context<Cpu>&, const MphPairs<D>& pairs, const Places& around, std::span<Covered> lack) {
  forEachParticle(lack.size(), [&](std::uint32_t i) { lack[i] = lackOf(pairs, i, around); });
}

template <int D>
void coveredMeans(Context<Cpu>&, const MphPairs<D>& pairs, const ClusterListView& list, std::span<const Covered> q,
                  std::span<double> mean) {
  const double floor2 = distanceFloor2(pairs);
  forEachCluster<D>(pairs, list, [&](const ClusterRange& range, const ClusterPlaces<D>& x, std::uint32_t c) {
    Lanes sum = {}, weight = {};
    for (ListSegment s : fluidSegments)
      for (std::uint32_t j : list.segment(c, s)) {
        const Lanes w = pairs.terms.density(1.0, PairLanes<D>(pairs, j, x, floor2).r);
        sum += w * q[j][0];
        weight += w * q[j][1];
      }
    for (std::uint32_t lane = 0; lane < range.count; ++lane)
      mean[range.first + lane] = coveredMeanOf(pairs, {sum[lane], weight[lane]});
  });
}

template <int D>
void coverTension(Context<Cpu>&, const MphPairs<D>& pairs, const Places& around, std::span<const double> tension,
                  std::span<Covered> covered) {
  forEachParticle(covered.size(),
                  [&](std::uint32_t i) { covered[i] = coveredTensionOf(pairs, i, around, tension[i]); });
}

template <int D>
void followDensity(Context<Cpu>&, const MphPairs<D>& pairs, double dt, const Places& around,
                   std::span<const double> lack, std::span<double> tension) {
  forEachParticle(tension.size(),
                  [&](std::uint32_t i) { tension[i] = tensionOf(pairs, i, dt, around, lack[i], tension[i]); });
}

template <int D>
void tensionForces(Context<Cpu>&, const MphPairs<D>& pairs, const ClusterListView& list,
                   std::span<const double> tension, std::span<Vec<D>> force) {
  const double floor2 = distanceFloor2(pairs);
  forEachCluster<D>(pairs, list, [&](const ClusterRange& range, const ClusterPlaces<D>& x, std::uint32_t c) {
    const PairTensionLanes<D> pairTensions(pairs, range, tension);
    VecLanes<D> sum = {};
    const auto add = [&](ListSegment s) {
      for (std::uint32_t j : list.segment(c, s)) {
        const PairLanes<D> pair(pairs, j, x, floor2);
        const Lanes f = pairs.terms.densityGradient(pair.r) * pairTensions.with(j);
        for (int k = 0; k < D; ++k) sum[k] -= f * pair.d[k];
      }
    };
    const bool wall = range.first >= pairs.fluidCount;
    for (ListSegment s : wall ? std::span<const ListSegment>(fluidSegments) : allSegments) add(s);
    storeLanes<D>(range, sum, force);
  });
}

template <int D>
void spreadVelocities(Context<Cpu>&, const MphPairs<D>& pairs, double dt, std::span<const Vec<D>> u,
                      std::span<const double> tension, std::span<Vec<D>> transport) {
  const double floor2 = distanceFloor2(pairs);
  const ClusterListView& list = pairs.fluidList;
  forEachCluster<D>(pairs, list, [&](const ClusterRange& range, const ClusterPlaces<D>& x, std::uint32_t c) {
    const VecLanes<D> own = loadLanes<D>(range, u);
    Lanes sum[D + 1] = {};
    for (ListSegment s : {ListSegment::NearFluid, ListSegment::NearWall})
      for (std::uint32_t j : list.segment(c, s)) {
        const PairLanes<D> pair(pairs, j, x, floor2);
        const Lanes f = pairs.terms.gradient(pair.r);
        Lanes along = {};
        for (int k = 0; k < D; ++k) {
          along += (u[j][k] - own[k]) * pair.d[k];
          sum[k] += f * pair.d[k];
        }
        sum[D] += f * max(along, -along);
      }
    for (std::uint32_t lane = 0; lane < range.count; ++lane) {
      const std::uint32_t i = range.first + lane;
      double sums[D + 1];
      for (int k = 0; k < D + 1; ++k) sums[k] = sum[k][lane];
      transport[i] = spreadVelocityOf(pairs, i, dt, tension[i], sums, u[i]);
    }
  });
}

template <int D>
void letGapsClose(Context<Cpu>&, const MphPairs<D>& pairs, const Places& places, std::span<SymmetricBlock<D>> b,
                  std::span<Covered> logarithm) {
  forEachParticle(b.size(), [&](std::uint32_t i) {
    const double resists = places.resists(i, pairs.restDensity);
    b[i] = std::sqrt(resists) * b[i];
    logarithm[i] = logarithmOf(resists);
  });
}

void letWallsYield(Context<Cpu>&, std::span<double> mean) {
  forEachParticle(mean.size(), [&](std::uint32_t i) { mean[i] = wallShareOf(mean[i]); });
}

void shareTension(Context<Cpu>&, std::span<const double> share, std::span<double> tension) {
  forEachParticle(tension.size(), [&](std::uint32_t i) { tension[i] *= share[i]; });
}

template <int D>
void actingPressures(Context<Cpu>&, const MphPairs<D>& pairs, const Places& around,
                     std::span<const double> tension, std::span<double> pressure) {
  forEachParticle(pressure.size(), [&](std::uint32_t i) {
    pressure[i] = actingPressureOf(pairs, i, around, tension[i], pressure[i]);
  });
}

#define TREACLE_INSTANTIATE(D)                                                                                  \
  template void lackOfDensity<D>(Context<Cpu>&, const MphPairs<D>&, const Places&, std::span<Covered>);         \
  template void coveredMeans<D>(Context<Cpu>&, const MphPairs<D>&, const ClusterListView&,                      \
                                std::span<const Covered>, std::span<double>);                                   \
  template void letGapsClose<D>(Context<Cpu>&, const MphPairs<D>&, const Places&, std::span<SymmetricBlock<D>>, \
                                std::span<Covered>);                                                            \
  template void actingPressures<D>(Context<Cpu>&, const MphPairs<D>&, const Places&, std::span<const double>,   \
                                   std::span<double>);                                                          \
  template void coverTension<D>(Context<Cpu>&, const MphPairs<D>&, const Places&, std::span<const double>,      \
                                std::span<Covered>);                                                            \
  template void followDensity<D>(Context<Cpu>&, const MphPairs<D>&, double, const Places&,                      \
                                 std::span<const double>, std::span<double>);                                   \
  template void tensionForces<D>(Context<Cpu>&, const MphPairs<D>&, const ClusterListView&,                     \
                                 std::span<const double>, std::span<Vec<D>>);                                   \
  template void spreadVelocities<D>(Context<Cpu>&, const MphPairs<D>&, double, std::span<const Vec<D>>,         \
                                    std::span<const double>, std::span<Vec<D>>);
TREACLE_INSTANTIATE(2)
TREACLE_INSTANTIATE(3)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
