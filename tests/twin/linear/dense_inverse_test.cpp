#include "treacle/linear/dense_inverse.hpp"
#include "treacle/core/pseudo_random.hpp"

#include "support/gpu.hpp"
#include "support/hats.hpp"
#include "support/matrices.hpp"
#include "support/tolerances.hpp"

#include <gtest/gtest.h>

namespace treacle::test {
namespace {

template <class T, int B>
Buffer<T> onDeviceInverse(Context<Cuda>& context, const BlockCsr<B>& a) {
  const std::size_t n = std::size_t{B} * a.rows();
  Buffer<T, Cuda> inverse(context, n * n);
  denseInverse<T>(context, onDevice(context, a), inverse);
  return copyToHost(context, inverse);
}

template <class T, int B>
void checkTwins(Context<Cuda>& context, const BlockCsr<B>& a, double tolerance) {
  Context<Cpu> host;
  const std::size_t n = std::size_t{B} * a.rows();
  Buffer<T> expected(n * n);
  denseInverse<T>(host, a, expected);
  const Buffer<T> found = onDeviceInverse<T>(context, a), again = onDeviceInverse<T>(context, a);
  EXPECT_LE((relativeDifference<T>(found.span(), expected.span())), tolerance);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) {
      ASSERT_EQ(found[i * n + j], found[j * n + i]) << "not symmetric";
      ASSERT_EQ(found[i * n + j], again[i * n + j]) << "not the same bits";
    }
}

HatCase<2> line(int points) {
  return hatCase<2>("line", {points, 1}, {}, [](const Vec<2, int>&) { return true; });
}

TEST(DenseInverseTwin, EqualsTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  Context<Cuda> context;
  std::vector<HatCase<2>> cases = hatCases<2>(14);
  for (int n : {1, 2, 31, 32, 33, 64, 65, 1200}) cases.push_back(line(n));
  cases.push_back(hatCases<2>(31)[1]);  // 31 x 33 points, periodic
  for (const HatCase<2>& c : cases) {
    SCOPED_TRACE(testing::Message() << c.name << ", " << c.active.size() << " points");
    const HatProblem<2> problem(c);
    checkTwins<double>(context, problem.a, 1e-9);
    checkTwins<float>(context, problem.a, singleTolerance);
  }
}

TEST(DenseInverseTwin, EqualsTheCpuForSeveralNumbersPerNode) {
  TREACLE_SKIP_WITHOUT_GPU();
  Context<Cuda> context;
  std::vector<HatCase<2>> cases = hatCases<2>(14);
  for (int n : {1, 15, 16, 17, 33}) cases.push_back(line(n));
  for (const HatCase<2>& c : cases) {
    SCOPED_TRACE(testing::Message() << c.name << ", " << c.active.size() << " points, two numbers each");
    const HatProblem<2, 2> problem(c);
    checkTwins<double>(context, problem.a, 1e-9);
    checkTwins<float>(context, problem.a, singleTolerance);
  }
  for (const HatCase<3>& c : hatCases<3>(6)) {
    SCOPED_TRACE(testing::Message() << c.name << ", " << c.active.size() << " points, three numbers each");
    const HatProblem<3, 3> problem(c);
    checkTwins<double>(context, problem.a, 1e-9);
    checkTwins<float>(context, problem.a, singleTolerance);
  }
}

TEST(DenseInverseTwin, SolvesSingularSystemsThatHaveASolution) {
  TREACLE_SKIP_WITHOUT_GPU();
  Context<Cuda> context;
  Context<Cpu> host;
  const HatProblem<2> problem(hatCases<2>(20)[0], 0);  // constants are its null space
  const BlockCsr<1>& a = problem.a;
  const std::uint32_t n = a.rows();
  const BlockCsrView<1> matrix = viewOf(a);
  const Buffer<double> inverse = onDeviceInverse<double>(context, a);
  std::vector<double> x(n), b(n), found(n), back(n);
  for (std::uint32_t i = 0; i < n; ++i) x[i] = pseudoRandom(i);
  hatMultiply<double>(host, matrix, x, b);
  denseMultiply<double>(host, n, inverse.data(), b.data(), found.data());
  hatMultiply<double>(host, matrix, found, back);
  EXPECT_LE((relativeDifference<double>(std::span<const double>(back), std::span<const double>(b))), 1e-4);
}

}  // namespace
}  // namespace treacle::test
