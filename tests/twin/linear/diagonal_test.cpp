#include "treacle/linear/diagonal.hpp"

#include "support/gpu.hpp"
#include "support/matrices.hpp"
#include "support/tolerances.hpp"

#include <gtest/gtest.h>

namespace treacle::test {
namespace {

template <int D, class T>
void checkDiagonalTwins(std::uint32_t n, double tolerance) {
  SCOPED_TRACE(testing::Message() << D << "-D, " << n << " particles");
  Context<Cpu> host;
  Context<Cuda> context;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::vector<Block<D>> diagonal(n);
  std::vector<Vec<D>> r(n), z(n);
  for (std::uint32_t i = 0; i < n; ++i) {
    for (double& value : r[i].v) value = unit(random);
    for (int row = 0; row < D; ++row)
      for (int c = 0; c <= row; ++c) diagonal[i](row, c) = diagonal[i](c, row) = unit(random) + (row == c ? 4 : 0);
  }
  const auto deviceDiagonal = copyToDevice<Block<D>>(context, diagonal);
  const auto deviceR = copyToDevice<Vec<D>>(context, r);
  Buffer<Vec<D>, Cuda> deviceZ(context, n);
  const auto compare = [&](const char* what) {
    const Buffer<Vec<D>> result = copyToHost(context, deviceZ);
    EXPECT_LE(relativeDifference<double>(result.span(), std::span<const Vec<D>>(z)), tolerance) << what;
  };

  std::vector<Vec<D, T>> inverse(n);
  Buffer<Vec<D, T>, Cuda> deviceInverse(context, n);
  jacobiInverse<D, T>(host, diagonal, inverse);
  jacobiInverse<D, T>(context, deviceDiagonal, deviceInverse);
  applyDiagonal<D, T>(host, inverse, r, z);
  applyDiagonal<D, T>(context, deviceInverse, deviceR, deviceZ);
  compare("diagonal");

  std::vector<Block<D, T>> blocks(n);
  Buffer<Block<D, T>, Cuda> deviceBlocks(context, n);
  blockInverse<D, T>(host, diagonal, blocks);
  blockInverse<D, T>(context, deviceDiagonal, deviceBlocks);
  applyBlockDiagonal<D, T>(host, blocks, r, z);
  applyBlockDiagonal<D, T>(context, deviceBlocks, deviceR, deviceZ);
  compare("block diagonal");
}

TEST(Diagonal, ActsLikeTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  for (std::uint32_t n : {0u, 1u, 31u, 33u, 10007u}) {
    checkDiagonalTwins<2, double>(n, operatorTolerance);
    checkDiagonalTwins<3, double>(n, operatorTolerance);
    checkDiagonalTwins<2, float>(n, singleTolerance);
    checkDiagonalTwins<3, float>(n, singleTolerance);
  }
}

}  // namespace
}  // namespace treacle::test
