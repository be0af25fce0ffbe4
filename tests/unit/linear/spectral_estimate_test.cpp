#include "treacle/linear/spectral_estimate.hpp"
#include "treacle/core/pseudo_random.hpp"

#include "support/dense.hpp"
#include "support/hats.hpp"
#include "support/tolerances.hpp"

#include <gtest/gtest.h>

namespace treacle::test {
namespace {

/// The estimate for a dense matrix.
template <class T>
double estimate(const Matrix& a, const Vector& inverseDiagonal, int steps = 10) {
  Context<Cpu> context;
  const std::vector<T> inverse(inverseDiagonal.begin(), inverseDiagonal.end());
  SpectralEstimate<T> spectrum;
  const auto times = [&](std::span<const T> x, std::span<T> y) {
    const Vector product = a * Vector(x);
    for (Index i = 0; i < a.rows(); ++i) y[i] = static_cast<T>(product[i]);
  };
  spectrum.run(context, times, inverse, steps);
  return *spectrum.largest();
}

/// Largest eigenvalue of D^-1 A.
double largestOf(const Matrix& a, const Vector& inverseDiagonal) {
  const Vector root = inverseDiagonal.cwiseSqrt();
  return eigenvalues(root.asDiagonal() * a * root.asDiagonal()).maxCoeff();
}

template <int D>
void checkEstimate() {
  for (const HatCase<D>& c : hatCases<D>(D == 2 ? 18 : 7)) {
    SCOPED_TRACE(testing::Message() << D << "-D, " << c.name);
    HatProblem<D> problem(c);
    Matrix a = dense(problem.a);
    if (a.rows() == 0) continue;
    // Uneven scales, as nodes at the edge of a body have them.
    Vector scale(a.rows());
    for (Index i = 0; i < a.rows(); ++i) scale[i] = std::pow(10, 2 * pseudoRandom(static_cast<std::uint32_t>(i)));
    a = scale.asDiagonal() * a * scale.asDiagonal();
    const Vector inverse = a.diagonal().cwiseInverse();
    const double exact = largestOf(a, inverse);
    for (const double found : {estimate<double>(a, inverse), estimate<float>(a, inverse)}) {
      EXPECT_GE(found, 0.95 * exact);
      EXPECT_LE(found, 1.12 * exact);
    }
    EXPECT_NEAR(estimate<double>(a, inverse, 60), 1.1 * exact, 1e-5 * exact);  // measured: 1.2e-6
  }
}

TEST(SpectralEstimate, IsALittleAboveTheLargestEigenvalue) {
  checkEstimate<2>();
  checkEstimate<3>();
}

TEST(SpectralEstimate, EndsWhereNothingIsLeftToFind) {
  const auto times11 = 1.1;
  for (const int steps : {1, 10, 60}) {
    // One unknown, and a matrix with one eigenvalue only: found in the first step.
    EXPECT_NEAR(estimate<double>(Matrix::Constant(1, 1, 3.0), Vector::Constant(1, 0.5), steps), times11 * 1.5,
                1e-9);
    EXPECT_NEAR(estimate<float>(Matrix::Identity(50, 50) * 3, Vector::Constant(50, 0.5), steps), times11 * 1.5,
                1e-5);
    // No unknown takes part, or the matrix is zero.
    EXPECT_EQ(estimate<double>(Matrix::Identity(5, 5), Vector::Zero(5), steps), 1);
    EXPECT_EQ(estimate<double>(Matrix::Zero(5, 5), Vector::Ones(5), steps), 1);
    EXPECT_EQ(estimate<double>(Matrix(0, 0), Vector(0), steps), 1);
  }
  // Three eigenvalues: exact after three steps, and more do no harm.
  Vector values(30);
  for (int i = 0; i < 30; ++i) values[i] = 1 + i % 3;
  for (const int steps : {3, 10, 64})
    EXPECT_NEAR(estimate<double>(values.asDiagonal(), Vector::Ones(30), steps), times11 * 3, 1e-12);
}

TEST(SpectralEstimate, LeavesUnknownsWithoutDiagonalOut) {
  const HatProblem<2> problem(hatCases<2>(10)[0]);
  Matrix a = dense(problem.a);
  Vector inverse = a.diagonal().cwiseInverse();
  for (Index i = 0; i < a.rows(); i += 3) {
    a(i, i) *= 100;
    inverse[i] = 0;
  }
  const double exact = largestOf(a, inverse);
  EXPECT_NEAR(estimate<double>(a, inverse, 40), 1.1 * exact, 1e-7 * exact);  // measured: 7e-9
}

}  // namespace
}  // namespace treacle::test
