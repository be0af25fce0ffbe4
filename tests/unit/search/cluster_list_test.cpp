#include "support/random_particles.hpp"

#include <gtest/gtest.h>

#include <omp.h>

#include <map>
#include <vector>

namespace treacle::test {
namespace {

/// Every pair within the radii is in its cluster's list exactly once, in the right segment, at the right image;
/// and every entry is within reach of some lane.
template <int D>
void checkLists(std::uint32_t fluid, std::uint32_t wall) {
  RandomParticles<D> r(fluid, wall, fluid + 1);
  sortByCell(r.context, r.grid, r.particles, r.ranges, r.workspace);
  const auto& x = r.particles.position;
  const ListRadii radii{0.5 * r.radius, r.radius};
  ClusterList<> list;
  buildClusterList<D>(r.context, r.grid, r.ranges, x, 0, fluid, radii, false, list);
  const auto images = periodicImages(r.grid);

  for (std::uint32_t c = 0; c < list.clusterCount(); ++c) {
    const std::uint32_t first = c * clusterSize, last = std::min(first + clusterSize, fluid);
    std::vector<double> nearest(list.offset[4 * (c + 1)] - list.offset[4 * c], 1e9);
    for (std::uint32_t i = first; i < last; ++i) {
      Vec<D> xi = x[i];  // the cluster itself may straddle a periodic end
      for (int k = 0; k < D; ++k)
        if (r.grid.periodic[k]) xi[k] += r.grid.length[k] * std::round((x[first][k] - xi[k]) / r.grid.length[k]);
      std::map<std::uint32_t, int> withinReach, segmentOf;
      std::size_t entry = 0;
      for (int s = 0; s < listSegments; ++s)
        for (ListEntry e : list.segment(c, ListSegment(s))) {
          ASSERT_EQ(e.index() >= fluid, s >= int(ListSegment::NearWall));
          const double distance = norm(x[e.index()] + images.shift[e.image()] - xi);
          nearest[entry] = std::min(nearest[entry], distance);
          ++entry;
          if (distance <= radii.far) ++withinReach[e.index()], segmentOf[e.index()] = s % 2;
        }
      for (std::uint32_t j = 0; j < r.ranges.activeCount; ++j) {
        const double distance = r.distance(x[i], x[j]);
        if (distance < radii.far * (1 - 1e-12)) {
          ASSERT_EQ(withinReach[j], 1) << i << " and " << j;
        }
        if (distance < radii.near * (1 - 1e-12)) {
          ASSERT_EQ(segmentOf[j], 0) << i << " and " << j;
        }
      }
    }
    for (double d : nearest) ASSERT_LE(d, radii.far * (1 + 1e-12));
  }
}

TEST(ClusterList, HoldsExactlyThePairsWithinReach) {
  for (std::uint32_t n : {1u, 7u, 31u, 33u, 300u, 1500u}) {
    checkLists<2>(n, n / 2);
    checkLists<3>(n, n / 2);
  }
}

TEST(ClusterList, DoesNotDependOnTheNumberOfThreads) {
  RandomParticles<3> r(11000, 3000, 5);
  sortByCell(r.context, r.grid, r.particles, r.ranges, r.workspace);
  ClusterList<> one, many;
  const auto build = [&](int threads, ClusterList<>& list) {
    omp_set_num_threads(threads);
    buildClusterList<3>(r.context, r.grid, r.ranges, r.particles.position, 0, 11000, {r.radius / 2, r.radius},
                        false, list);
  };
  build(1, one);
  build(3, many);
  ASSERT_EQ(one.entry.size(), many.entry.size());
  for (std::size_t k = 0; k < one.entry.size(); ++k) ASSERT_EQ(one.entry[k].bits, many.entry[k].bits);
}

TEST(ClusterList, OfWallsIsEmptyAwayFromFluid) {
  RandomParticles<2> r(2000, 2000, 9);
  sortByCell(r.context, r.grid, r.particles, r.ranges, r.workspace);
  ClusterList<> list;
  buildClusterList<2>(r.context, r.grid, r.ranges, r.particles.position, 2000, r.ranges.activeCount,
                      {0.3 * r.radius, 0}, true, list);
  for (std::uint32_t c = 0; c < list.clusterCount(); ++c)
    if (list.segment(c, ListSegment::NearFluid).empty()) {
      EXPECT_TRUE(list.segment(c, ListSegment::NearWall).empty());
    }
}

}  // namespace
}  // namespace treacle::test
