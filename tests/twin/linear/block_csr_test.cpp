#include "support/gpu.hpp"
#include "support/matrices.hpp"
#include "support/tolerances.hpp"

#include <gtest/gtest.h>

namespace treacle::test {
namespace {

template <int D, class T>
void checkTwins(std::uint32_t rows, std::uint32_t reach, double tolerance) {
  SCOPED_TRACE(testing::Message() << D << "-D, " << rows << " rows, reach " << reach);
  Context<Cpu> host;
  Context<Cuda> context;
  const BlockCsr<D, T> a = randomMatrix<D, T>(rows, reach, 1);
  const BlockCsr<D, T, Cuda> deviceA = onDevice(context, a);
  std::mt19937 random(2);
  std::normal_distribution<T> normal;
  std::vector<Vec<D, T>> x(rows), y(rows), inverse(rows);
  for (Vec<D, T>& v : x)
    for (T& value : v.v) value = normal(random);

  multiply<D, T>(host, a, x, y);
  const Buffer<Vec<D, T>, Cuda> deviceX = copyToDevice<Vec<D, T>>(context, x);
  Buffer<Vec<D, T>, Cuda> deviceY(context, rows);
  multiply<D, T>(context, deviceA, deviceX, deviceY);
  const Buffer<Vec<D, T>> product = copyToHost(context, deviceY);
  EXPECT_LE((relativeDifference<T>(product.span(), std::span<const Vec<D, T>>(y))), tolerance);

  extendedJacobiInverse<D, T, T>(host, a, inverse);
  extendedJacobiInverse<D, T, T>(context, deviceA, deviceY);
  const Buffer<Vec<D, T>> sums = copyToHost(context, deviceY);
  EXPECT_LE((relativeDifference<T>(sums.span(), std::span<const Vec<D, T>>(inverse))), tolerance);

  // The same sums in the same order.
  multiply<D, T>(context, deviceA, deviceX, deviceY);
  const Buffer<Vec<D, T>> again = copyToHost(context, deviceY);
  for (std::uint32_t i = 0; i < rows; ++i) ASSERT_EQ(again[i], product[i]);
}

TEST(BlockCsr, MultipliesLikeTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  for (std::uint32_t rows : {0u, 1u, 31u, 33u, 10007u})
    for (std::uint32_t reach : {0u, 1u, 5u, 16u, 100u}) {
      checkTwins<1, double>(rows, reach, operatorTolerance);
      checkTwins<2, double>(rows, reach, operatorTolerance);
      checkTwins<3, double>(rows, reach, operatorTolerance);
      checkTwins<1, float>(rows, reach, singleTolerance);
      checkTwins<2, float>(rows, reach, singleTolerance);
      checkTwins<3, float>(rows, reach, singleTolerance);
    }
}

}  // namespace
}  // namespace treacle::test
