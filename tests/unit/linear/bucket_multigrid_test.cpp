#include "treacle/linear/bucket_multigrid.hpp"
#include "support/matrices.hpp"
#include "support/scene.hpp"
#include "support/tolerances.hpp"
#include "treacle/linear/diagonal.hpp"
#include "treacle/precondition/bucket_galerkin.hpp"

#include <gtest/gtest.h>

#include <random>

namespace treacle::test {
namespace {

/// z of cycles whose rest, from different levels on, is one dense matrix.
template <int D, class T>
void checkDenseEnd(double tolerance) {
  Scene<D> s = makeScene<D>();
  std::vector<Block<D>> diagonal(s.n());
  std::vector<Vec<D, T>> inverse(s.n());
  diagonalBlocks<D>(s.context, s.pairs(), s.terms(), diagonal);
  jacobiInverse<D, T>(s.context, diagonal, inverse);
  BucketLevels<> levels;
  findBuckets(s.context, s.ranges().key, D * CellGrid<D>::subBits, D, levels);
  Buffer<Vec<D>> columns;
  BlockCsr<D> a0;
  bucketGalerkin(s.context, s.pairs(), s.ranges(), levels, s.terms(), columns, a0);

  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  std::vector<Vec<D>> r(s.n());
  for (Vec<D>& v : r)
    for (int k = 0; k < D; ++k) v[k] = normal(random);
  const auto applied = [&](std::uint32_t denseUnknowns) {
    BucketMultigrid<D, T> multigrid(denseUnknowns);
    multigrid.setup(s.context, a0, {levels.begin.begin(), levels.begin.end()}, {2, 3, 4});
    EXPECT_GE(multigrid.levelCount(), 2u);
    std::vector<Vec<D>> z(s.n());
    multigrid.apply(s.context, inverse, r, z);
    return z;
  };
  const std::vector<Vec<D>> expected = applied(0);
  const std::uint32_t all = D * a0.rows(), last = D * levels.count(levels.begin.size() - 1);
  ASSERT_LT(last, all);
  for (const std::uint32_t denseUnknowns : {all, last})
    EXPECT_LE(relativeDifference<double>(applied(denseUnknowns), expected), tolerance) << denseUnknowns;
}

TEST(BucketMultigrid, WithADenseEndIsTheSameCycle) {
  checkDenseEnd<2, double>(operatorTolerance);
  checkDenseEnd<3, double>(operatorTolerance);
  checkDenseEnd<2, float>(10 * singleTolerance);
  checkDenseEnd<3, float>(10 * singleTolerance);
}

}  // namespace
}  // namespace treacle::test
