#include "support/gpu.hpp"
#include "support/matrices.hpp"
#include "support/tolerances.hpp"
#include "treacle/linear/bucket_multigrid.hpp"
#include "treacle/linear/galerkin_spgemm.hpp"

#include <gtest/gtest.h>

namespace treacle::test {
namespace {

template <int D>
void checkTwins(Context<Cuda>& context, GalerkinSpgemm<D>& spgemm, std::uint32_t rows, std::uint32_t reach) {
  SCOPED_TRACE(testing::Message() << D << "-D, " << rows << " rows, reach " << reach);
  Context<Cpu> host;
  const BlockCsr<D> fine = randomMatrix<D>(rows, reach, 7);
  const std::vector<std::uint32_t> members = randomMembers(rows, 8);
  BlockCsr<D> expected;
  coarsen<D, double>(host, fine, members, expected);

  const auto deviceMembers = copyToDevice<std::uint32_t>(context, members);
  BlockCsr<D, double, Cuda> coarse;
  spgemm.compute(context, onDevice(context, fine), deviceMembers, coarse);
  EXPECT_LE(matrixDifference(onHost(context, coarse), expected), operatorTolerance);
}

template <int D>
void checkAllSizes() {
  Context<Cuda> context;
  GalerkinSpgemm<D> spgemm;  // what it keeps must fit the next system too
  for (std::uint32_t rows : {33u, 10007u, 0u, 1u, 31u})
    for (std::uint32_t reach : {0u, 3u, 40u}) checkTwins<D>(context, spgemm, rows, reach);
  EXPECT_GT(spgemm.bytes(), 0u);
}

TEST(GalerkinSpgemm, GivesTheSameAsSummation) {
  TREACLE_SKIP_WITHOUT_GPU();
  checkAllSizes<1>();
  checkAllSizes<2>();
  checkAllSizes<3>();
}

}  // namespace
}  // namespace treacle::test
