#include "support/gpu.hpp"
#include "support/matrices.hpp"
#include "support/tolerances.hpp"
#include "treacle/core/error.hpp"
#include "treacle/linear/bucket_multigrid.hpp"

#include <gtest/gtest.h>

namespace treacle::test {
namespace {

template <int D, class T>
void checkTwins(std::uint32_t rows, double tolerance) {
  SCOPED_TRACE(testing::Message() << D << "-D, " << rows << " rows");
  Context<Cpu> host;
  Context<Cuda> context;
  const BlockCsr<D, T> fine = randomMatrix<D, T>(rows, 3, 4);
  const std::vector<std::uint32_t> members = randomMembers(rows, 5);
  BlockCsr<D, T> expected;
  coarsen<D, T>(host, fine, members, expected);

  const auto deviceMembers = copyToDevice<std::uint32_t>(context, members);
  BlockCsr<D, T, Cuda> coarse;
  coarsen<D, T>(context, onDevice(context, fine), deviceMembers, coarse);
  EXPECT_LE(matrixDifference(onHost(context, coarse), expected), tolerance);
}

TEST(Coarsen, SumsLikeTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  for (std::uint32_t rows : {0u, 1u, 31u, 33u, 10007u}) {
    checkTwins<1, double>(rows, operatorTolerance);
    checkTwins<2, double>(rows, operatorTolerance);
    checkTwins<3, double>(rows, operatorTolerance);
    checkTwins<1, float>(rows, singleTolerance);
    checkTwins<2, float>(rows, singleTolerance);
    checkTwins<3, float>(rows, singleTolerance);
  }
}

TEST(Coarsen, RefusesRowsThatCoupleTooFar) {
  TREACLE_SKIP_WITHOUT_GPU();
  Context<Cuda> context;
  const std::uint32_t rows = 100;
  std::vector<std::uint32_t> members(rows + 1);
  for (std::uint32_t i = 0; i <= rows; ++i) members[i] = i;
  const auto deviceMembers = copyToDevice<std::uint32_t>(context, members);
  BlockCsr<3, double, Cuda> coarse;
  EXPECT_THROW(
      (coarsen<3, double>(context, onDevice(context, randomMatrix<3>(rows, 40, 6)), deviceMembers, coarse)),
      RunError);
}

}  // namespace
}  // namespace treacle::test
