#include "treacle/linear/dense_inverse.hpp"

#include "support/dense.hpp"
#include "support/hats.hpp"
#include "support/tolerances.hpp"

#include <gtest/gtest.h>

namespace treacle::test {
namespace {

template <class T, int B>
Matrix inverseOf(const BlockCsr<B>& a) {
  Context<Cpu> context;
  const Index n = B * a.rows();
  std::vector<T> inverse(n * n);
  denseInverse<T>(context, a, inverse);
  Matrix m(n, n);
  std::copy(inverse.begin(), inverse.end(), m.data());
  return m;
}

template <class T, int B>
void checkInverse(const BlockCsr<B>& a, double tolerance) {
  Matrix regularised = dense(a);
  const Vector diagonal = regularised.diagonal();
  for (Index i = 0; i < diagonal.size(); ++i)
    regularised(i, i) += regularisation<T>(diagonal[i], diagonal.maxCoeff());
  const Matrix expected = inverse(regularised), found = inverseOf<T>(a);
  EXPECT_EQ(found, found.transpose());
  EXPECT_LE((found - expected).norm(), tolerance * expected.norm());
}

TEST(DenseInverse, IsTheInverseAndSymmetric) {
  for (const HatCase<3>& c : hatCases<3>(4)) checkInverse<double>(HatProblem<3, 3>(c).a, 1e-9);
  for (const HatCase<2>& c : hatCases<2>(14)) {
    SCOPED_TRACE(c.name);
    const HatProblem<2> problem(c);
    checkInverse<double>(problem.a, 1e-9);
    checkInverse<float>(problem.a, singleTolerance);
    checkInverse<double>(HatProblem<2, 2>(c).a, 1e-9);
  }
}

TEST(DenseInverse, SolvesSingularSystemsThatHaveASolution) {
  const HatProblem<2> problem(hatCases<2>(9)[0], 0);
  const Matrix a = dense(problem.a), inverse = inverseOf<double>(problem.a);
  const Vector b = a * randomVector(a.rows(), 3);
  EXPECT_LE((a * (inverse * b) - b).norm(), 1e-6 * b.norm());  // the regularisation; measured: 1.2e-7
}

TEST(DenseInverse, GivesZerosWhereThereIsNoPivot) {
  HatProblem<2> problem(hatCases<2>(4)[0]);
  for (Block<1>& block : problem.a.value) block.a[0] = 0;
  EXPECT_EQ(inverseOf<double>(problem.a).norm(), 0);
}

}  // namespace
}  // namespace treacle::test
