#include "treacle/search/buckets.hpp"
#include "support/random_particles.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <vector>

namespace treacle::test {
namespace {

template <int D>
void checkBuckets() {
  RandomParticles<D> r(5000, 100, 4);
  sortByCell(r.context, r.grid, r.particles, r.ranges, r.workspace);
  BucketLevels<> levels;
  findBuckets(r.context, r.ranges.key, D * CellGrid<D>::subBits, D, levels);
  EXPECT_EQ(levels.count(levels.begin.size() - 1), 1u);

  // A particle's bucket on level k is that of its cell index divided by 2^k, as in the paper.
  std::vector<std::uint32_t> bucket(levels.bucketOf.begin(), levels.bucketOf.end());
  for (std::size_t level = 0; level < levels.begin.size(); ++level) {
    std::map<std::vector<int>, std::uint32_t> seen;
    for (std::uint32_t i = 0; i < 5000; ++i) {
      const auto cell = r.grid.cellOf(r.particles.position[i]);
      std::vector<int> coordinates;
      for (int k = 0; k < D; ++k) coordinates.push_back(cell[k] >> level);
      const auto [place, isNew] = seen.emplace(coordinates, bucket[i]);
      ASSERT_EQ(place->second, bucket[i]);
    }
    ASSERT_EQ(seen.size(), levels.count(level));
    if (level + 1 == levels.begin.size()) break;
    const auto& begin = levels.begin[level + 1];
    for (auto& b : bucket)
      b = static_cast<std::uint32_t>(std::upper_bound(begin.begin(), begin.end(), b) - begin.begin() - 1);
  }
}

TEST(Buckets, AreTheOccupiedCellsHalvedUntilOneIsLeft) {
  checkBuckets<2>();
  checkBuckets<3>();
}

}  // namespace
}  // namespace treacle::test
