#include "support/random_particles.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace treacle::test {
namespace {

template <int D>
void checkSort(std::uint32_t fluid, std::uint32_t wall) {
  RandomParticles<D> r(fluid, wall, fluid + 7);
  std::vector<Vec<D>> before(r.particles.position.begin(), r.particles.position.end());
  sortByCell(r.context, r.grid, r.particles, r.ranges, r.workspace);
  const Particles<D>& p = r.particles;

  std::set<std::uint32_t> fluidIds(p.id.begin(), p.id.begin() + fluid), wallIds(p.id.begin() + fluid, p.id.end());
  EXPECT_EQ(fluidIds.size(), fluid);
  EXPECT_EQ(wallIds.size(), wall);
  for (std::uint32_t i = 0; i < p.count; ++i) ASSERT_EQ(p.position[i], before[p.id[i]]) << "fields went apart";
  for (std::uint32_t i = 0; i < p.count; ++i) ASSERT_EQ(p.body[i], p.id[i] % 7) << "fields went apart";
  for (std::uint32_t i = 0; i < fluid; ++i) ASSERT_EQ(p.acceleration[i], -p.position[i]) << "fields went apart";
  for (std::uint32_t m = 0; m < p.modeCount(); ++m)
    for (std::uint32_t i = 0; i < fluid; ++i)
      ASSERT_EQ(p.modes.vectors[std::size_t{m} * fluid + i][0], static_cast<float>(p.id[i] + 0.25 * m))
          << "fields went apart";
  for (std::uint32_t k = 0; k < p.wallSurface.size(); ++k)
    ASSERT_EQ(p.wallSurface[k].face[0], converted<float>(p.position[fluid + k])) << "fields went apart";
  for (std::uint32_t i = 0; i < fluid; ++i) ASSERT_EQ(r.ranges.key[i], r.grid.key(p.position[i]));
  EXPECT_TRUE(std::is_sorted(r.ranges.key.begin(), r.ranges.key.end()));

  // Each particle stands in its cell's range, and the ranges hold nobody else.
  std::size_t inRanges = 0;
  for (std::size_t cell = 0; cell < r.grid.cellCount(); ++cell) {
    for (std::uint32_t i = r.ranges.fluidBegin[cell]; i < r.ranges.fluidEnd[cell]; ++i)
      ASSERT_EQ(r.grid.linear(r.grid.cellOf(p.position[i])), cell);
    for (std::uint32_t i = r.ranges.wallBegin[cell]; i < r.ranges.wallEnd[cell]; ++i)
      ASSERT_EQ(r.grid.linear(r.grid.cellOf(p.position[i])), cell);
    inRanges +=
        r.ranges.fluidEnd[cell] - r.ranges.fluidBegin[cell] + r.ranges.wallEnd[cell] - r.ranges.wallBegin[cell];
  }
  EXPECT_EQ(inRanges, r.ranges.activeCount);

  // No wall within the radius of fluid may count as inactive.
  for (std::uint32_t j = r.ranges.activeCount; j < p.count; ++j)
    for (std::uint32_t i = 0; i < std::min(fluid, 200u); ++i)
      ASSERT_GT(r.distance(p.position[i], p.position[j]), r.radius);
}

TEST(CellSort, SortsFieldsTogetherAndFillsRanges) {
  for (std::uint32_t n : {1u, 31u, 33u, 1000u, 12345u}) {
    checkSort<2>(n, n / 2);
    checkSort<3>(n, n / 3);
  }
  checkSort<2>(40, 0);
}

TEST(CellSort, IsStable) {
  RandomParticles<2> r(100, 10, 3);
  for (auto& x : r.particles.position) x = {0.5, 0.5};
  sortByCell(r.context, r.grid, r.particles, r.ranges, r.workspace);
  EXPECT_TRUE(std::is_sorted(r.particles.id.begin(), r.particles.id.end()));
}

template <int D>
void checkRigidWalls() {
  RandomParticles<D> r(4000, 2000, 3);
  sortByCell(r.context, r.grid, r.particles, r.ranges, r.workspace);
  const std::uint32_t alone = r.ranges.activeCount;
  r.addRigidBody();
  sortByCell(r.context, r.grid, r.particles, r.ranges, r.workspace);
  const Particles<D>& p = r.particles;
  EXPECT_GT(r.ranges.activeCount, alone + 20);
  EXPECT_LT(r.ranges.activeCount, p.count - 20);  // not all
  for (std::uint32_t j = r.ranges.activeCount; j < p.count; ++j)
    for (std::uint32_t i = p.wallBegin(); i < p.count; ++i)
      if (p.body[i] != p.body[j]) {
        ASSERT_GT(r.distance(p.position[i], p.position[j]), r.radius);
      }
}

TEST(CellSort, KeepsWallsActiveWhereRigidBodiesMayTouch) {
  checkRigidWalls<2>();
  checkRigidWalls<3>();
}

TEST(CellSort, RefusesPositionsThatAreNotFinite) {
  for (const double value : {std::nan(""), HUGE_VAL})
    for (const std::uint32_t i : {0u, 99u, 100u, 149u}) {  // fluid and walls
      RandomParticles<3> r(100, 50, 3);
      r.particles.position[i][1] = value;
      EXPECT_THROW(sortByCell(r.context, r.grid, r.particles, r.ranges, r.workspace), RunError);
    }
}

TEST(CellGrid, TilesTheDomainByFloorOfExtentOverRadius) {
  const auto g = CellGrid<3>::make({-0.01, -0.02, -0.01}, {0.04, 0.02, 0.04}, {true, true, true}, 0.007);
  EXPECT_EQ(g.count, (Vec<3, int>{7, 5, 7}));  // as in the authors' 3D x2 case
  const auto exact = CellGrid<2>::make({0, 0}, {0.7, 0.3}, {false, false}, 0.1);
  EXPECT_EQ(exact.count, (Vec<2, int>{7, 3}));
}

/// A quotient that rounds up to a whole number must not lead below the lower end.
TEST(CellGrid, WrapsPlacesJustBelowTheUpperEnd) {
  for (const auto& [low, high] : {std::pair{-0.01, 0.03}, std::pair{-0.02, 0.02}, std::pair{-0.3, 0.7}}) {
    const auto g = CellGrid<2>::make({low, 0}, {high, 1}, {true, false}, 0.003);
    for (double x = high, k = 0; k < 100; ++k, x = std::nextafter(x, low)) {
      Vec<2> place{x, 0.5};
      ASSERT_TRUE(g.wrap(place)) << x;
      ASSERT_TRUE(place[0] >= low && place[0] < high) << x;
    }
  }
}

TEST(CellGrid, WrapsPeriodicAxesAndReportsOpenOnes) {
  const auto g = CellGrid<2>::make({0, 0}, {1, 1}, {true, false}, 0.1);
  Vec<2> x{-0.25, 0.5};
  EXPECT_TRUE(g.wrap(x));
  EXPECT_DOUBLE_EQ(x[0], 0.75);
  x = {0.5, 1.01};
  EXPECT_FALSE(g.wrap(x));
  x = {0.5, NAN};
  EXPECT_FALSE(g.wrap(x));
  x = {-1e-20, 0.5};
  EXPECT_TRUE(g.wrap(x));
  EXPECT_LT(x[0], 1.0);
}

}  // namespace
}  // namespace treacle::test
