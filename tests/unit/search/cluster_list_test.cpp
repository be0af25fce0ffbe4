#include "support/random_particles.hpp"

#include <gtest/gtest.h>

#include <omp.h>
#include <sys/mman.h>

#include <map>
#include <vector>

namespace treacle::test {
namespace {

/// Every pair within the radii is in its cluster's list exactly once, in the right segment; every entry is within
/// reach of some lane; and clusters that are not special have no pairs across a periodic end, or parted by a
/// sheet.
template <int D>
void checkLists(std::uint32_t fluid, std::uint32_t wall, bool sheets) {
  RandomParticles<D> r(fluid, wall, fluid + 1);
  if (sheets) r.addSides(fluid);
  sortByCell(r.context, r.grid, r.particles, r.ranges, r.workspace);
  const auto& x = r.particles.position;
  const ListRadii radii{0.5 * r.radius, r.radius};
  ClusterList<> list;
  buildClusterList<D>(r.context, r.grid, r.ranges, x,
                      {0, fluid, radii, false, sheets ? r.particles.side.data() : nullptr}, list);
  const auto sees = [&](std::uint32_t i, std::uint32_t j) {
    return !sheets || sides::seeEachOther(r.particles.side[i], r.particles.side[j]);
  };

  for (std::uint32_t c = 0; c < list.clusterCount(); ++c) {
    const std::uint32_t first = c * clusterSize, last = std::min(first + clusterSize, fluid);
    std::vector<double> nearest(list.offset[4 * (c + 1)] - list.offset[4 * c], 1e9);
    for (std::uint32_t i = first; i < last; ++i) {
      std::map<std::uint32_t, int> withinReach, segmentOf;
      std::size_t entry = 0;
      for (int s = 0; s < listSegments; ++s)
        for (std::uint32_t j : list.segment(c, ListSegment(s))) {
          ASSERT_EQ(j >= fluid, s >= int(ListSegment::NearWall));
          const double distance = r.distance(x[i], x[j]);
          if (sees(i, j)) nearest[entry] = std::min(nearest[entry], distance);
          ++entry;
          if (distance <= radii.far && !sees(i, j)) {
            ASSERT_TRUE(list.special[c]) << i << " and " << j;
          }
          if (distance <= radii.far && sees(i, j)) {
            ++withinReach[j], segmentOf[j] = s % 2;
            ASSERT_TRUE(list.special[c] || norm(x[j] - x[i]) == distance) << i << " and " << j;
          }
        }
      for (std::uint32_t j = 0; j < r.ranges.activeCount; ++j) {
        if (!sees(i, j)) continue;
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
    for (const bool sheets : {false, true}) {
      checkLists<2>(n, n / 2, sheets);
      checkLists<3>(n, n / 2, sheets);
    }
  }
}

TEST(ClusterList, DoesNotDependOnTheNumberOfThreads) {
  RandomParticles<3> r(11000, 3000, 5);
  sortByCell(r.context, r.grid, r.particles, r.ranges, r.workspace);
  ClusterList<> one, many;
  const auto build = [&](int threads, ClusterList<>& list) {
    omp_set_num_threads(threads);
    buildClusterList<3>(r.context, r.grid, r.ranges, r.particles.position, {0, 11000, {r.radius / 2, r.radius}},
                        list);
  };
  build(1, one);
  build(3, many);
  ASSERT_EQ(one.entry.size(), many.entry.size());
  for (std::size_t k = 0; k < one.entry.size(); ++k) ASSERT_EQ(one.entry[k], many.entry[k]);
}

/// Of more particles than 27 bits count. Only the last of them exist: the others' memory is never touched.
TEST(ClusterList, HasIndicesOf32Bits) {
  constexpr std::uint32_t few = 64, first = (1u << 28) - few, last = first + few;
  const std::size_t bytes = std::size_t{last} * sizeof(Vec<2>);
  void* memory = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  ASSERT_NE(memory, MAP_FAILED);
  const std::span<Vec<2>> x(static_cast<Vec<2>*>(memory), last);
  for (std::uint32_t i = first; i < last; ++i) x[i] = {0.5 + 1e-3 * (i - first), 0.5};
  const auto grid = CellGrid<2>::make({0, 0}, {1, 1}, {false, false}, 1);
  CellRanges<> ranges;
  for (Buffer<std::uint32_t>* range : {&ranges.fluidBegin, &ranges.fluidEnd, &ranges.wallBegin, &ranges.wallEnd}) {
    range->resize(1);
    (*range)[0] = 0;
  }
  ranges.fluidBegin[0] = first, ranges.fluidEnd[0] = last;
  Context<Cpu> context;
  ClusterList<> list;
  buildClusterList<2>(context, grid, ranges, x, {first, last, {1, 1}}, list);
  ASSERT_EQ(list.entry.size(), few / clusterSize * few);
  for (std::uint32_t c = 0; c < list.clusterCount(); ++c)
    for (std::uint32_t k = 0; k < few; ++k) EXPECT_EQ(list.segment(c, ListSegment::NearFluid)[k], first + k);
  munmap(memory, bytes);
}

TEST(ClusterList, OfWallsIsEmptyAwayFromFluid) {
  RandomParticles<2> r(2000, 2000, 9);
  sortByCell(r.context, r.grid, r.particles, r.ranges, r.workspace);
  ClusterList<> list;
  buildClusterList<2>(r.context, r.grid, r.ranges, r.particles.position,
                      {2000, r.ranges.activeCount, {0.3 * r.radius, 0}, true}, list);
  for (std::uint32_t c = 0; c < list.clusterCount(); ++c)
    if (list.segment(c, ListSegment::NearFluid).empty()) {
      EXPECT_TRUE(list.segment(c, ListSegment::NearWall).empty());
    }
}

}  // namespace
}  // namespace treacle::test
