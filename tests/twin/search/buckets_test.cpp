#include "treacle/search/buckets.hpp"
#include "support/device_particles.hpp"
#include "support/gpu.hpp"
#include "support/random_particles.hpp"

namespace treacle::test {
namespace {

void check(Context<Cuda>& context, const Buffer<std::uint64_t>& key, int cellShift, int dimensions,
           BucketLevels<Cuda>& found) {
  SCOPED_TRACE(testing::Message() << key.size() << " keys, " << dimensions << "D");
  Context<Cpu> host;
  BucketLevels<> expected;
  findBuckets(host, key, cellShift, dimensions, expected);
  findBuckets(context, copyToDevice<std::uint64_t>(context, key), cellShift, dimensions, found);
  ASSERT_EQ(found.begin.size(), expected.begin.size());
  for (std::size_t level = 0; level < expected.begin.size(); ++level)
    expectSameBits(context, expected.begin[level], found.begin[level]);
  expectSameBits(context, expected.bucketOf, found.bucketOf);
}

template <int D>
void checkBucketsSizes() {
  Context<Cuda> context;
  BucketLevels<Cuda> found;  // one for all, as from step to step
  for (std::uint32_t fluid : {0u, 1u, 31u, 20011u, 33u})
    for (std::uint32_t wall : {0u, 500u}) {
      RandomParticles<D> r(fluid, wall, fluid + wall + 4);
      sortByCell(r.context, r.grid, r.particles, r.ranges, r.workspace);
      check(context, r.ranges.key, D * CellGrid<D>::subBits, D, found);
    }
}

TEST(BucketsTwin, EqualTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  checkBucketsSizes<2>();
  checkBucketsSizes<3>();
}

TEST(BucketsTwin, OfOneCellAndOfTheEndsOfTheLongestCurve) {
  TREACLE_SKIP_WITHOUT_GPU();
  Context<Cuda> context;
  BucketLevels<Cuda> found;
  Buffer<std::uint64_t> key(1000);
  std::fill(key.begin(), key.end(), 77);
  check(context, key, 4, 2, found);
  std::fill(key.begin() + 300, key.end(), ~std::uint64_t{0} >> 2);
  check(context, key, 4, 2, found);
  check(context, key, 6, 3, found);
}

}  // namespace
}  // namespace treacle::test
