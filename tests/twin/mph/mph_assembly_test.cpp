#include "treacle/mph/mph_assembly.hpp"

#include "support/device_scene.hpp"
#include "support/gpu.hpp"
#include "support/tolerances.hpp"

#include <gtest/gtest.h>

namespace treacle::test {
namespace {

template <int D>
void checkDiagonal(Scene<D>& s, DeviceScene<D>& device, const MphPairs<D>& pairs) {
  std::vector<Block<D>> expected(s.n());
  diagonalBlocks<D>(s.context, s.pairs(), s.terms(), expected);
  Buffer<Block<D>, Cuda> diagonal(device.context, s.n());
  diagonalBlocks<D>(device.context, pairs, device.terms(), diagonal);
  const Buffer<Block<D>> back = copyToHost(device.context, diagonal);
  EXPECT_LE(relativeDifference<double>(back.span(), std::span<const Block<D>>(expected)), operatorTolerance);
}

template <int D>
void checkAssembly(Scene<D>& s) {
  DeviceScene<D> device(s);
  GradientRows<D> rows;
  GradientRows<D, Cuda> deviceRows;
  gradientRows(s.context, s.pairs(), rows);
  gradientRows(device.context, device.pairs, deviceRows);
  const auto start = copyToHost(device.context, deviceRows.rowStart);
  const auto neighbour = copyToHost(device.context, deviceRows.column);
  const auto g = copyToHost(device.context, deviceRows.value);
  ASSERT_TRUE(std::equal(start.begin(), start.end(), rows.rowStart.begin(), rows.rowStart.end()));
  ASSERT_TRUE(std::equal(neighbour.begin(), neighbour.end(), rows.column.begin(), rows.column.end()));
  EXPECT_LE(relativeDifference<double>(g.span(), std::span<const Vec<D>>(rows.value)), operatorTolerance);

  BlockCsr<D> a;
  BlockCsr<D, double, Cuda> deviceA;
  assemble(s.context, s.pairs(), s.terms(), rows, a);
  assemble(device.context, device.pairs, device.terms(), deviceRows, deviceA);
  EXPECT_LE(matrixDifference(onHost(device.context, deviceA), a), operatorTolerance);
  checkDiagonal(s, device, device.pairs);
}

template <int D>
void checkScenes() {
  for (const SchemeKind scheme : bothSchemes)
    for (const bool twoMaterials : {true, false})
      for (const Walls walls : {Walls::Floor, Walls::None})
        for (const unsigned seed : {1u, 2u}) {
          SCOPED_TRACE(testing::Message() << D << "D, " << nameOf(scheme));
          Scene<D> s =
              makeScene<D>({.walls = walls, .seed = seed, .twoMaterials = twoMaterials, .scheme = scheme});
          checkAssembly(s);
        }
}

TEST(Assemble, GivesTheMatrixOfTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  checkScenes<2>();
  checkScenes<3>();
}

template <int D>
void checkLargeDiagonal(SchemeKind scheme) {
  Scene<D> s = makeLargeScene<D>(scheme);
  DeviceScene<D> device(s);
  checkDiagonal(s, device, device.pairs);
  MphPairs<D> withoutLists = device.pairs;
  withoutLists.fluidList.offset = withoutLists.wallList.offset = nullptr;
  checkDiagonal(s, device, withoutLists);
}

TEST(DiagonalBlocks, AreThoseOfTheCpuWithAndWithoutLists) {
  TREACLE_SKIP_WITHOUT_GPU();
  for (const SchemeKind scheme : bothSchemes) {
    checkLargeDiagonal<2>(scheme);
    checkLargeDiagonal<3>(scheme);
  }
}

}  // namespace
}  // namespace treacle::test
