#include "treacle/search/neighbour_rows.hpp"

#include "support/random_particles.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <vector>

namespace treacle::test {
namespace {

using Members = std::set<std::uint32_t>;

/// Sorted particles and one kind of their rows.
template <int D>
struct Found {
  RandomParticles<D>& r;
  RowKind kind;
  RowRadii radii;
  NeighbourRows<> rows;

  Found(RandomParticles<D>& sorted, RowKind theKind)
      : r(sorted), kind(theKind), radii{0.6 * sorted.radius, sorted.radius} {
    findNeighbours(r.context, r.sorted(r.particles, r.ranges), radii, kind, rows);
  }

  /// All within `radius` of row `row`'s particle, by all pairs.
  Members expected(std::uint32_t row, double radius) const {
    const std::uint32_t i = rows.first + row, n = r.particles.fluidCount;
    const bool walls = kind == RowKind::WallsOfFluid;
    Members members;
    for (std::uint32_t j = walls ? n : 0; j < (walls ? r.particles.count : n); ++j)
      if (r.distance(r.particles.position[i], r.particles.position[j]) < radius) members.insert(j);
    return members;
  }

  void check(std::uint32_t stride) const {
    const NeighbourRowsView view = rows.view();
    const std::uint32_t n = r.particles.fluidCount;
    ASSERT_EQ(view.first, kind == RowKind::FluidOfWalls ? n : 0);
    ASSERT_EQ(view.count, kind == RowKind::FluidOfWalls ? r.ranges.activeCount - n : n);
    ASSERT_EQ(rows.start.size(), 2u * view.count + 1);
    ASSERT_EQ(rows.start[0], 0u);
    ASSERT_EQ(rows.start[2 * view.count], rows.column.size());
    for (std::uint32_t row = 0; row < view.count; row += stride) {
      const auto section = [&](std::uint32_t at) {
        return std::span(view.column + view.start[at], view.column + view.start[at + 1]);
      };
      const auto nearPart = section(row), farPart = section(view.count + row);
      Members all, near(nearPart.begin(), nearPart.end());
      std::size_t places = 0;
      view.forEachPlace(row, [&](std::uint64_t k) { all.insert(view.column[k]), ++places; });
      ASSERT_EQ(places, nearPart.size() + farPart.size());
      ASSERT_EQ(all.size(), places) << "a neighbour twice";
      ASSERT_EQ(all, expected(row, radii.far));
      ASSERT_EQ(near, expected(row, radii.near));
      ASSERT_TRUE(kind != RowKind::FluidOfFluid || near.contains(row)) << "without the particle itself";
    }
  }
};

template <int D>
void checkAll(RandomParticles<D>& r, std::uint32_t stride = 1) {
  sortByCell(r.context, r.grid, r.particles, r.ranges, r.workspace);
  for (const RowKind kind : {RowKind::FluidOfFluid, RowKind::WallsOfFluid, RowKind::FluidOfWalls}) {
    SCOPED_TRACE(testing::Message() << D << "D, " << r.particles.fluidCount << " fluid, "
                                    << r.particles.wallCount() << " walls, kind " << static_cast<int>(kind));
    Found<D>(r, kind).check(stride);
  }
}

template <int D>
void checkSizes() {
  for (const std::uint32_t fluid : {0u, 1u, 33u, 1000u, 12345u})
    for (const std::uint32_t wall : {0u, 1u, 33u, fluid / 2}) {
      RandomParticles<D> r(fluid, wall, fluid + 3 * wall + 1);
      checkAll(r, fluid > 2000 ? 23 : 1);
    }
}

TEST(NeighbourRows, AreThoseOfAllPairs) {
  checkSizes<2>();
  checkSizes<3>();
}

/// Particles that all but touch the ends of the domain, and each other across the periodic ones.
template <int D>
void checkEnds() {
  RandomParticles<D> r(40, 20, 5);
  const double least = 1e-12, most = std::nextafter(1.0, 0.0);
  for (std::uint32_t i = 0; i < r.particles.count; ++i)
    for (int k = 0; k < D; ++k) {
      const double ends[] = {0, least, 1 - least, most};
      r.particles.position[i][k] = k == D - 1 ? 0.01 * (i % 7) : ends[(i + 3 * k) % 4];
    }
  r.particles.position[0][D - 1] = r.particles.position[50][D - 1] = 1;  // the end of the open axis is inside
  checkAll(r);
  // All that stand at periodic ends are one crowd.
  EXPECT_EQ(Found<D>(r, RowKind::FluidOfFluid).expected(1, r.radius).size(), 39u);
}

TEST(NeighbourRows, AcrossPeriodicEnds) {
  checkEnds<2>();
  checkEnds<3>();
}

TEST(NeighbourRows, DoNotReachAcrossOpenEnds) {
  RandomParticles<2> r(2, 0, 1);
  r.particles.position[0] = {0.5, 0};
  r.particles.position[1] = {0.5, 1};
  sortByCell(r.context, r.grid, r.particles, r.ranges, r.workspace);
  EXPECT_EQ(Found<2>(r, RowKind::FluidOfFluid).rows.column.size(), 2u) << "more than each particle itself";
}

/// Rows are those of own particles, the first of either group; who stands in them may be a ghost.
TEST(NeighbourRows, OfOwnParticlesHaveGhosts) {
  RandomParticles<2> r(300, 100, 3);
  sortByCell(r.context, r.grid, r.particles, r.ranges, r.workspace);
  SortedParticles<2> part = r.sorted(r.particles, r.ranges);
  part.ghostFluid = 100, part.ghostWalls = 20;
  bool someGhost = false;
  for (const RowKind kind : {RowKind::FluidOfFluid, RowKind::WallsOfFluid, RowKind::FluidOfWalls}) {
    const Found<2> all(r, kind);
    NeighbourRows<> own;
    findNeighbours(r.context, part, all.radii, kind, own);
    EXPECT_EQ(own.first, all.rows.first);
    EXPECT_EQ(own.count, all.rows.count - (kind == RowKind::FluidOfWalls ? 20 : 100));
    for (std::uint32_t row = 0; row < own.count; ++row) {
      std::vector<std::uint32_t> expected, found;
      all.rows.view().forEachPlace(row, [&](std::uint64_t k) { expected.push_back(all.rows.column[k]); });
      own.view().forEachPlace(row, [&](std::uint64_t k) { found.push_back(own.column[k]); });
      ASSERT_EQ(found, expected) << row;
      for (const std::uint32_t j : found) someGhost = someGhost || !part.isOwn(j);
    }
  }
  EXPECT_TRUE(someGhost);
}

TEST(NeighbourRows, MayBeUsedAgainForFewerParticles) {
  RandomParticles<2> many(1000, 300, 1), few(20, 5, 2);
  sortByCell(many.context, many.grid, many.particles, many.ranges, many.workspace);
  sortByCell(few.context, few.grid, few.particles, few.ranges, few.workspace);
  Found<2> found(many, RowKind::WallsOfFluid);
  Found<2> again(few, RowKind::WallsOfFluid);
  std::swap(found.rows, again.rows);
  findNeighbours(few.context, few.sorted(few.particles, few.ranges), again.radii, again.kind, again.rows);
  again.check(1);
}

}  // namespace
}  // namespace treacle::test
