#include "support/oracle.hpp"
#include "support/tolerances.hpp"
#include "treacle/linear/bucket_multigrid.hpp"
#include "treacle/precondition/bucket_galerkin.hpp"

#include <gtest/gtest.h>

namespace treacle::test {
namespace {

/// P of one level: fine block rows by coarse ones, ones where a member belongs to a bucket.
template <int D>
Matrix prolongation(std::span<const std::uint32_t> begin) {
  const Index coarse = static_cast<Index>(begin.size()) - 1;
  Matrix p = Matrix::Zero(D * begin.back(), D * coarse);
  for (Index b = 0; b < coarse; ++b)
    for (std::uint32_t i = begin[b]; i < begin[b + 1]; ++i)
      for (int k = 0; k < D; ++k) p(D * i + k, D * b + k) = 1;
  return p;
}

template <int D>
void checkGalerkin(Walls walls, SchemeKind scheme) {
  Scene<D> s = makeScene<D>({.walls = walls, .scheme = scheme, .slips = false});
  BucketLevels<> levels;
  findBuckets(s.context, s.ranges().key, D * CellGrid<D>::subBits, D, levels);
  ASSERT_GT(levels.begin.size(), 1u);
  Buffer<Vec<D>> columns;
  BlockCsr<D> a0;
  bucketGalerkin(s.context, s.pairs(), s.ranges(), levels, s.terms(), columns, a0);

  Matrix p = prolongation<D>(levels.begin[0].span());
  Matrix expected = p.transpose() * Oracle<D>(s).matrix() * p;
  EXPECT_LT((dense(a0) - expected).norm(), operatorTolerance * expected.norm());

  BlockCsr<D> fine = std::move(a0);
  for (std::size_t r = 1; r < levels.begin.size(); ++r) {
    BlockCsr<D> coarse;
    coarsen<D, double>(s.context, fine, levels.begin[r].span(), coarse);
    p = prolongation<D>(levels.begin[r].span());
    expected = p.transpose() * expected * p;
    EXPECT_LT((dense(coarse) - expected).norm(), operatorTolerance * expected.norm()) << "level " << r;
    fine = std::move(coarse);
  }
  EXPECT_EQ(fine.rows(), 1u);
}

TEST(BucketGalerkin, EqualsRestrictedMatrixOnEveryLevel) {
  for (const SchemeKind scheme : {SchemeKind::Published, SchemeKind::Accurate}) {
    checkGalerkin<2>(Walls::Floor, scheme);
    checkGalerkin<3>(Walls::Floor, scheme);
    checkGalerkin<2>(Walls::None, scheme);
  }
}

}  // namespace
}  // namespace treacle::test
