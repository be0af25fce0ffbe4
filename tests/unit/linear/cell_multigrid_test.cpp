#include "treacle/linear/cell_multigrid.hpp"

#include "support/dense.hpp"
#include "support/pressure_column.hpp"
#include "support/tolerances.hpp"
#include "treacle/linear/krylov.hpp"

#include <gtest/gtest.h>

namespace treacle::test {
namespace {

/// Iterations of conjugate gradients to a relative residual of 1e-6.
template <class M>
int iterations(const PressureColumn& column, const M& m) {
  Context<Cpu> context;
  KrylovWorkspace<> workspace;
  const std::vector<double> b = column.rightHandSide();
  std::vector<double> x(column.count());
  const auto multiplyA = [&](std::span<const double> in, std::span<double> out) {
    multiply<1, double>(context, column.a, {reinterpret_cast<const Vec<1>*>(in.data()), in.size()},
                        {reinterpret_cast<Vec<1>*>(out.data()), out.size()});
  };
  const SolveReport report = conjugateGradient(context, {multiplyA, m, b, x}, {1e-12, 1000}, workspace);
  EXPECT_EQ(report.status, SolveStatus::Converged);
  for (std::uint32_t i = 0; i < column.count(); ++i)
    EXPECT_TRUE(column.unknown[i] || x[i] == 0) << "a known pressure has changed";
  return report.iterations;
}

template <class T>
int mgcgIterations(const PressureColumn& column, int m, int n) {
  Context<Cpu> context;
  const BucketLevels<> levels = column.levels();
  CellMultigrid<T> multigrid;
  multigrid.setup(context, column.a, levels.begin, m, n);
  EXPECT_EQ(multigrid.levelCount(), m == 0 ? levels.begin.size() : static_cast<std::size_t>(m));
  return iterations(column, [&](auto r, auto z) { multigrid.apply(context, r, z); });
}

TEST(CellMultigrid, TakesAsManyIterationsAsTheStudy) {
  // By a SciPy program on the same columns without their known pressures: nearly flat where conjugate gradients
  // alone grow with the length of the column.
  struct Study {
    Vec<3, int> size;
    int cg, oneLevel, twoLevels, allLevels, allTwoSweeps;
  };
  const Study studies[] = {{{9, 9, 9}, 35, 20, 20, 20, 20},
                           {{17, 9, 9}, 43, 23, 21, 21, 21},
                           {{17, 17, 17}, 59, 27, 24, 23, 24},
                           {{31, 17, 17}, 78, 31, 25, 24, 25},
                           {{31, 31, 31}, 105, 39, 30, 27, 29}};
  for (const Study& s : studies) {
    SCOPED_TRACE(testing::Message() << s.size[0] << " x " << s.size[1] << " x " << s.size[2]);
    const PressureColumn column(s.size);
    EXPECT_NEAR(iterations(column, [](auto r, auto z) { std::copy(r.begin(), r.end(), z.begin()); }), s.cg, 1);
    EXPECT_NEAR(mgcgIterations<double>(column, 1, 4), s.oneLevel, 1);
    EXPECT_NEAR(mgcgIterations<double>(column, 2, 4), s.twoLevels, 1);
    EXPECT_NEAR(mgcgIterations<double>(column, 0, 4), s.allLevels, 1);
    EXPECT_NEAR(mgcgIterations<double>(column, 0, 2), s.allTwoSweeps, 1);
    EXPECT_NEAR(mgcgIterations<float>(column, 0, 4), s.allLevels, 1);
  }
}

/// L_l^-1 r of [O23 eq. (17)] by its sweeps, on dense matrices of the levels from l on.
Vector cycle(const std::vector<Matrix>& a, const std::vector<Matrix>& p, int n, const Vector& r,
             std::size_t l = 0) {
  const Vector weight = 2 * a[l].cwiseAbs().rowSums().cwiseInverseOrZero();
  const bool last = l + 1 == a.size();
  Vector x = Vector::Zero(r.size());
  const auto sweep = [&] { x += weight.cwiseProduct(r - a[l] * x); };
  for (int s = 0; s < (last ? 2 * n : n); ++s) sweep();
  if (last) return x;
  x += p[l + 1] * cycle(a, p, n, p[l + 1].transpose() * (r - a[l] * x), l + 1);
  for (int s = 0; s < n; ++s) sweep();
  return x;
}

/// M of [O23 eqs. (12)-(16)], zero where a row is empty.
Matrix paperMatrix(const PressureColumn& column, int m, int n) {
  const BucketLevels<> levels = column.levels();
  Matrix fine = dense(column.a);
  const Matrix inverse = fine.diagonal().cwiseInverseOrZero().asDiagonal();
  const Index particles = fine.rows();
  std::vector<Matrix> a, p;
  for (std::size_t l = 0; l < levels.begin.size() && (m == 0 || l < static_cast<std::size_t>(m)); ++l) {
    Matrix prolong = Matrix::Zero(fine.rows(), levels.count(l));
    for (std::uint32_t c = 0; c < levels.count(l); ++c)
      for (std::uint32_t i = levels.begin[l][c]; i < levels.begin[l][c + 1]; ++i)
        prolong(i, c) = l > 0 || column.unknown[i];
    fine = prolong.transpose() * fine * prolong;
    a.push_back(fine);
    p.push_back(prolong);
  }
  return inverse +
         denseOf(particles, [&](const Vector& r) { return p[0] * cycle(a, p, n, p[0].transpose() * r); });
}

template <class T>
Matrix matrixOf(const PressureColumn& column, int m, int n) {
  Context<Cpu> context;
  const BucketLevels<> levels = column.levels();
  CellMultigrid<T> multigrid;
  multigrid.setup(context, column.a, levels.begin, m, n);
  return denseOf(column.count(), [&](const Vector& r) {
    Vector z = Vector::Constant(r.size(), NAN);
    multigrid.apply(context, r, z);
    return z;
  });
}

void checkMatrix(const PressureColumn& column, const Matrix& m, const Matrix& expected, double tolerance) {
  EXPECT_LE((m - expected).norm(), tolerance * expected.norm());
  EXPECT_LE((m - m.transpose()).norm(), tolerance * m.norm());
  // Where p is known M is zero, elsewhere positive definite.
  Matrix filled = (m + m.transpose()) / 2;
  for (std::uint32_t i = 0; i < column.count(); ++i) {
    if (column.unknown[i]) continue;
    EXPECT_EQ(m.row(i).cwiseAbs().sum() + m.col(i).cwiseAbs().sum(), 0);
    filled(i, i) = 1;
  }
  if (m.rows() == 0) return;
  EXPECT_GT(eigenvalues(filled)[0], 0);
}

TEST(CellMultigrid, IsThePapersRecursion) {
  // The top layer of the second has cells of its own, the third is nothing but surface, the last has no particle.
  for (const Vec<3, int> size : {Vec<3, int>{8, 7, 6}, {6, 8, 4}, {1, 6, 4}, {0, 1, 1}})
    for (int m : {1, 2, 0})
      for (int n : {1, 4}) {
        SCOPED_TRACE(testing::Message()
                     << size[0] << " x " << size[1] << " x " << size[2] << ", MGCG(" << m << ", " << n << ")");
        const PressureColumn column(size);
        const Matrix expected = paperMatrix(column, m, n);
        checkMatrix(column, matrixOf<double>(column, m, n), expected, operatorTolerance);
        checkMatrix(column, matrixOf<float>(column, m, n), expected, 10 * singleTolerance);
      }
}

}  // namespace
}  // namespace treacle::test
