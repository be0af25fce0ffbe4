#include "support/oracle.hpp"
#include "support/tolerances.hpp"
#include "treacle/linear/bucket_multigrid.hpp"
#include "treacle/linear/diagonal.hpp"
#include "treacle/precondition/bucket_galerkin.hpp"

#include <gtest/gtest.h>

namespace treacle::test {
namespace {

/// Everything that the preconditioners of one scene are made of, in precision T.
template <int D, class T>
struct Preconditioners {
  Scene<D> s = makeScene<D>();
  std::vector<Vec<D, T>> inverse;
  std::vector<Block<D, T>> blocks;
  BucketLevels<> levels;
  BucketMultigrid<D, T> multigrid;

  explicit Preconditioners(CycleSweeps sweeps) : inverse(s.n()), blocks(s.n()) {
    std::vector<Block<D>> diagonal(s.n());
    diagonalBlocks<D>(s.context, s.pairs(), s.terms(), diagonal);
    jacobiInverse<D, T>(s.context, diagonal, inverse);
    blockInverse<D, T>(s.context, diagonal, blocks);
    findBuckets(s.context, s.ranges().key, D * CellGrid<D>::subBits, D, levels);
    Buffer<Vec<D>> columns;
    BlockCsr<D> a0;
    bucketGalerkin(s.context, s.pairs(), s.ranges(), levels, s.terms(), columns, a0);
    multigrid.setup(s.context, a0, {levels.begin.begin(), levels.begin.end()}, sweeps);
  }

  template <class Apply>
  Matrix dense(Apply&& apply) {
    return denseOf(s.unknowns(), [&](const Vector& x) {
      const auto r = unflat<D>(x);
      std::vector<Vec<D>> z(r.size());
      apply(r, z);
      return flat<D>(z);
    });
  }
};

void expectPositiveDefinite(const Matrix& m, double tolerance) {
  EXPECT_LT((m - m.transpose()).norm(), tolerance * m.norm());
  EXPECT_GT(eigenvalues((m + m.transpose()) / 2)[0], 0);
}

template <int D, class T>
void checkAll(CycleSweeps sweeps, double tolerance) {
  Preconditioners<D, T> p(sweeps);
  Context<Cpu>& context = p.s.context;
  const Matrix a = Oracle<D>(p.s).matrix();

  const Matrix jacobi = p.dense([&](auto& r, auto& z) { applyDiagonal<D, T>(context, p.inverse, r, z); });
  EXPECT_LT((jacobi.diagonal().cwiseProduct(a.diagonal()) - Vector::Ones(a.rows())).norm(),
            tolerance * std::sqrt(a.rows()));

  const Matrix block = p.dense([&](auto& r, auto& z) { applyBlockDiagonal<D, T>(context, p.blocks, r, z); });
  expectPositiveDefinite(block, tolerance);
  for (Index i = 0; i < a.rows(); i += D)
    EXPECT_LT((block.block(i, i, D, D) * a.block(i, i, D, D) - Matrix::Identity(D, D)).norm(), 10 * tolerance);

  expectPositiveDefinite(p.dense([&](auto& r, auto& z) { p.multigrid.apply(context, p.inverse, r, z); }),
                         tolerance);
}

TEST(Preconditioner, IsSymmetricPositiveDefinite) {
  for (const CycleSweeps& sweeps : {CycleSweeps{2, 3, 4}, CycleSweeps{2, 2, 4}, CycleSweeps{1, 1, 1}}) {
    checkAll<2, double>(sweeps, operatorTolerance);
    checkAll<3, double>(sweeps, operatorTolerance);
  }
  checkAll<2, float>({2, 3, 4}, 10 * singleTolerance);
  checkAll<3, float>({2, 3, 4}, 10 * singleTolerance);
}

/// M of [K23 eqs. (43)-(45)] by the recursion of the paper on dense matrices.
template <int D>
Matrix cycleMatrix(const Preconditioners<D, double>& p, std::size_t level, const CycleSweeps& sweeps) {
  const Matrix a = dense(p.multigrid.matrix(level));
  const Matrix identity = Matrix::Identity(a.rows(), a.rows());
  const Matrix smoother = (2 * a.cwiseAbs().rowSums().cwiseInverse()).asDiagonal();  // D^-1, D_ii = sum |A_ij| / 2
  const auto power = [&](int n) {
    Matrix m = identity;
    for (int k = 0; k < n; ++k) m = m * (identity - smoother * a);
    return m;
  };
  const Matrix inverse = treacle::test::inverse(a);
  if (level + 1 == p.multigrid.levelCount()) return (identity - power(sweeps.coarsest)) * inverse;

  const int n = level == 0 ? sweeps.finest : sweeps.middle;
  const auto& begin = p.levels.begin[level + 1];
  Matrix prolong = Matrix::Zero(a.rows(), D * (begin.size() - 1));
  for (std::size_t b = 0; b + 1 < begin.size(); ++b)
    for (std::uint32_t i = begin[b]; i < begin[b + 1]; ++i)
      for (int k = 0; k < D; ++k) prolong(D * i + k, D * b + k) = 1;
  const Matrix s = power(n);
  return (identity - s * s) * inverse +
         s * prolong * cycleMatrix<D>(p, level + 1, sweeps) * prolong.transpose() * s.transpose();
}

template <int D>
void checkCycle(const CycleSweeps& sweeps) {
  Preconditioners<D, double> p(sweeps);
  ASSERT_GE(p.multigrid.levelCount(), 2u);
  const Matrix k = p.dense([&](auto& r, auto& z) { p.multigrid.apply(p.s.context, p.inverse, r, z); });
  Matrix expected = Matrix::Zero(k.rows(), k.cols());
  for (Index i = 0; i < k.rows(); ++i) expected(i, i) = p.inverse[i / D][i % D];
  const Matrix coarse = cycleMatrix<D>(p, 0, sweeps);
  for (Index i = 0; i < k.rows(); ++i)
    for (Index j = 0; j < k.cols(); ++j)
      expected(i, j) += coarse(D * p.levels.bucketOf[i / D] + i % D, D * p.levels.bucketOf[j / D] + j % D);
  EXPECT_LT((k - expected).norm(), operatorTolerance * expected.norm());
}

TEST(BucketMultigrid, IsThePapersRecursion) {
  checkCycle<2>({2, 3, 4});
  checkCycle<2>({2, 2, 4});
  checkCycle<3>({2, 3, 4});
}

}  // namespace
}  // namespace treacle::test
