#include "support/device_scene.hpp"
#include "support/gpu.hpp"
#include "support/tolerances.hpp"
#include "treacle/linear/galerkin_spgemm.hpp"
#include "treacle/precondition/bucket_galerkin.hpp"

#include <gtest/gtest.h>

namespace treacle::test {
namespace {

template <int D>
BlockCsr<D> cpuGalerkin(Scene<D>& s, const BucketLevels<>& levels) {
  Buffer<Vec<D>> columns;
  BlockCsr<D> a0;
  bucketGalerkin(s.context, s.pairs(), s.ranges(), levels, s.terms(), columns, a0);
  return a0;
}

template <int D>
BlockCsr<D> deviceGalerkin(DeviceScene<D>& device, const MphPairs<D>& pairs) {
  Buffer<Vec<D>, Cuda> columns;
  BlockCsr<D, double, Cuda> a0;
  bucketGalerkin(device.context, pairs, device.ranges, device.levels, device.terms(), columns, a0);
  return onHost(device.context, a0);
}

template <int D>
void checkScenes(SchemeKind scheme) {
  SCOPED_TRACE(nameOf(scheme));
  for (const bool twoMaterials : {true, false})
    for (const Walls walls : {Walls::Floor, Walls::None}) {
      Scene<D> s = makeScene<D>({.walls = walls, .twoMaterials = twoMaterials, .scheme = scheme});
      DeviceScene<D> device(s);
      const BlockCsr<D> expected = cpuGalerkin(s, device.hostLevels);
      EXPECT_LE(matrixDifference(deviceGalerkin(device, device.pairs), expected), operatorTolerance);

      GradientRows<D, Cuda> rows;
      BlockCsr<D, double, Cuda> a, a0;
      gradientRows(device.context, device.pairs, rows);
      assemble(device.context, device.pairs, device.terms(), rows, a);
      GalerkinSpgemm<D> spgemm;
      spgemm.compute(device.context, a, device.levels.begin[0], a0);
      EXPECT_LE(matrixDifference(onHost(device.context, a0), expected), operatorTolerance);
    }
}

TEST(BucketGalerkin, GivesTheMatrixOfTheCpuOnBothRoutes) {
  TREACLE_SKIP_WITHOUT_GPU();
  for (const SchemeKind scheme : bothSchemes) {
    checkScenes<2>(scheme);
    checkScenes<3>(scheme);
  }
}

template <int D>
void checkLarge(SchemeKind scheme) {
  SCOPED_TRACE(nameOf(scheme));
  Scene<D> s = makeLargeScene<D>(scheme);
  DeviceScene<D> device(s);
  const BlockCsr<D> expected = cpuGalerkin(s, device.hostLevels);
  const BlockCsr<D> result = deviceGalerkin(device, device.pairs);
  EXPECT_LE(matrixDifference(result, expected), operatorTolerance);

  const BlockCsr<D> again = deviceGalerkin(device, device.pairs);
  for (std::size_t k = 0; k < result.value.size(); ++k)
    for (int e = 0; e < D * D; ++e) ASSERT_EQ(again.value[k].a[e], result.value[k].a[e]);

  MphPairs<D> withoutLists = device.pairs;
  withoutLists.fluidList.offset = withoutLists.wallList.offset = nullptr;
  EXPECT_LE(matrixDifference(deviceGalerkin(device, withoutLists), expected), operatorTolerance);
}

TEST(BucketGalerkin, GivesTheSameForManyParticlesAndWithoutLists) {
  TREACLE_SKIP_WITHOUT_GPU();
  for (const SchemeKind scheme : bothSchemes) {
    checkLarge<2>(scheme);
    checkLarge<3>(scheme);
  }
}

}  // namespace
}  // namespace treacle::test
