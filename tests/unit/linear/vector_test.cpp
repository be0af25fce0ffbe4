#include "treacle/linear/vector.hpp"

#include "support/dense.hpp"
#include "support/tolerances.hpp"
#include "treacle/core/block.hpp"

#include <gtest/gtest.h>
#include <omp.h>

namespace treacle::test {
namespace {

TEST(VectorOperations, EqualEigen) {
  Context<Cpu> context;
  for (Index n : {0, 1, 31, 33, 4096, 4097, 30011}) {
    const Vector p = randomVector(n, 1), q = randomVector(n, 2), u = randomVector(n, 3);
    Vector x = randomVector(n, 4), r = randomVector(n, 5), s = randomVector(n, 6);
    const double scale = std::max(1.0, p.norm() * q.norm());
    KrylovScalars scalars;
    directionDot(context, p, q, &scalars);
    EXPECT_NEAR(scalars.rho, p.dot(q), kernelTolerance * scale);

    scalars.alpha = 0.3;
    const Vector x1 = x + 0.3 * p, r1 = r - 0.3 * q, s1 = s - 0.3 * u;
    updateSolution(context, {p, q, x, r, u, s}, &scalars);
    EXPECT_LE((x - x1).norm() + (r - r1).norm() + (s - s1).norm(), kernelTolerance * (1 + x1.norm()));
    EXPECT_NEAR(scalars.rr, r1.squaredNorm(), kernelTolerance * (1 + r1.squaredNorm()));

    scalars.iteration = 1;
    scalars.beta = -0.7;
    Vector direct = x;
    direction(context, p, direct, &scalars);
    EXPECT_LE((direct - (p - 0.7 * x)).norm(), kernelTolerance * (1 + direct.norm()));

    Vector res = q;
    residual(context, p, res, &scalars);
    EXPECT_NEAR(scalars.rr, (p - q).squaredNorm(), kernelTolerance * (1 + res.squaredNorm()));
    EXPECT_NEAR(scalars.bb, p.squaredNorm(), kernelTolerance * (1 + p.squaredNorm()));
    EXPECT_EQ(res, p - q);
  }
}

TEST(VectorOperations, DoNotDependOnTheNumberOfThreads) {
  Context<Cpu> context;
  const Vector x = randomVector(100003, 1), y = randomVector(100003, 2);
  KrylovScalars one, five;
  omp_set_num_threads(1);
  directionDot(context, x, y, &one);
  omp_set_num_threads(5);
  directionDot(context, x, y, &five);
  omp_set_num_threads(1);
  EXPECT_EQ(one.rho, five.rho);
}

template <int D>
void checkInverse() {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Vector numbers = randomVector(D * D, seed);
    Matrix g(D, D);
    std::copy(numbers.begin(), numbers.end(), g.data());
    const Matrix m = g * g.transpose() + 0.1 * Matrix::Identity(D, D);
    Block<D> b{};
    for (int r = 0; r < D; ++r)
      for (int c = 0; c < D; ++c) b(r, c) = m(r, c);
    const Block<D> inv = inverse(b);
    Matrix product(D, D);
    for (int r = 0; r < D; ++r)
      for (int c = 0; c < D; ++c) {
        product(r, c) = 0;
        for (int k = 0; k < D; ++k) product(r, c) += inv(r, k) * b(k, c);
      }
    EXPECT_LT((product - Matrix::Identity(D, D)).norm(), operatorTolerance);
  }
}

TEST(Block, InverseTimesItselfIsTheIdentity) {
  checkInverse<2>();
  checkInverse<3>();
}

}  // namespace
}  // namespace treacle::test
