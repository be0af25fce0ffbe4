#include "treacle/linear/bucket_multigrid.hpp"
#include "support/device_scene.hpp"
#include "support/gpu.hpp"
#include "support/tolerances.hpp"
#include "treacle/linear/galerkin_spgemm.hpp"
#include "treacle/precondition/bucket_galerkin.hpp"

#include <gtest/gtest.h>

#include <cstring>

namespace treacle::test {
namespace {

template <int D, class T>
std::vector<Vec<D, T>> converted(const std::vector<Vec<D>>& from) {
  std::vector<Vec<D, T>> to(from.size());
  for (std::size_t i = 0; i < from.size(); ++i)
    for (int k = 0; k < D; ++k) to[i][k] = static_cast<T>(from[i][k]);
  return to;
}

/// Random positive numbers so large that neither part of K hides errors of the other; single precision holds them
/// exactly, and both precisions apply the same K.
template <int D>
std::vector<Vec<D>> randomInverse(const BlockCsr<D>& a0, std::uint32_t n) {
  double trace = 0;
  for (std::uint32_t i = 0; i < a0.rows(); ++i)
    for (std::uint64_t k = a0.rowStart[i]; k < a0.rowStart[i + 1]; ++k)
      for (int c = 0; a0.column[k] == i && c < D; ++c) trace += a0.value[k](c, c);
  const Index count = Index{D} * n;
  const Vector random =
      10 * D * a0.rows() / trace * (randomVector(count, 6).cwiseAbs() + Vector::Constant(count, 0.1));
  return unflat<D>(Vector(std::vector<float>(random.begin(), random.end())));
}

/// K of one scene on the device against K of the CPU, made from the same A^0.
template <int D>
struct CycleTwin {
  Scene<D> s;
  DeviceScene<D> d;
  BlockCsr<D> finest;
  BlockCsr<D, double, Cuda> finestOnDevice;
  std::vector<Vec<D>> inverse, r, other;

  explicit CycleTwin(Scene<D> scene)
      : s(std::move(scene)),
        d(s),
        r(unflat<D>(randomVector(s.unknowns(), 4))),
        other(unflat<D>(randomVector(s.unknowns(), 5))) {
    Buffer<Vec<D>> columns;
    bucketGalerkin(s.context, s.pairs(), s.ranges(), d.hostLevels, s.terms(), columns, finest);
    finestOnDevice = onDevice(d.context, finest);
    inverse = randomInverse(finest, s.n());
  }

  std::uint32_t unknownsOn(std::size_t level) const { return D * d.hostLevels.count(level); }

  std::vector<Vec<D>> onCpu(const CycleSweeps& sweeps) {
    const auto& begin = d.hostLevels.begin;
    BucketMultigrid<D, double> multigrid;
    multigrid.setup(s.context, finest, {begin.begin(), begin.end()}, sweeps);
    std::vector<Vec<D>> z(s.n());
    multigrid.apply(s.context, inverse, r, z);
    return z;
  }

  template <class T>
  BucketMultigrid<D, T, Cuda> makeDevice(const CycleSweeps& sweeps, GalerkinSpgemm<D>* spgemm = nullptr) {
    const auto& begin = d.levels.begin;
    BucketMultigrid<D, T, Cuda> multigrid;
    multigrid.setup(d.context, finestOnDevice, {begin.begin(), begin.end()}, sweeps, spgemm);
    return multigrid;
  }

  /// K x of the device.
  template <class T>
  Buffer<Vec<D>> apply(BucketMultigrid<D, T, Cuda>& multigrid, const std::vector<Vec<D>>& x) {
    const auto inverseOnDevice = copyToDevice<Vec<D, T>>(d.context, converted<D, T>(inverse));
    const auto xOnDevice = copyToDevice<Vec<D>>(d.context, x);
    auto z = copyToDevice<Vec<D>>(d.context, x);  // what is there before must not count
    multigrid.apply(d.context, inverseOnDevice, xOnDevice, z);
    return copyToHost(d.context, z);
  }

  /// The cycle's part of K r must weigh enough for its errors to show.
  void checkScale(const std::vector<Vec<D>>& expected) {
    double cycle = 0, all = 0;
    for (std::uint32_t i = 0; i < s.n(); ++i)
      for (int k = 0; k < D; ++k) {
        cycle += std::pow(expected[i][k] - inverse[i][k] * r[i][k], 2);
        all += std::pow(expected[i][k], 2);
      }
    ASSERT_GT(cycle, 0.01 * all);
  }

  void checkDouble(const CycleSweeps& sweeps, const std::vector<Vec<D>>& expected, double tolerance) {
    auto multigrid = makeDevice<double>(sweeps);
    EXPECT_EQ(multigrid.levelCount(), d.hostLevels.begin.size());
    const Buffer<Vec<D>> z = apply(multigrid, r), again = apply(multigrid, r);
    EXPECT_LE(relativeDifference<double>(z.span(), std::span<const Vec<D>>(expected)), tolerance);
    EXPECT_EQ(std::memcmp(z.data(), again.data(), z.span().size_bytes()), 0) << "not the same bits";
    checkSymmetric(apply(multigrid, other), z);

    GalerkinSpgemm<D> spgemm;
    auto byProducts = makeDevice<double>(sweeps, &spgemm);
    EXPECT_LE(relativeDifference<double>(apply(byProducts, r), z), tolerance);
  }

  /// other . K r = r . K other
  void checkSymmetric(const Buffer<Vec<D>>& kOther, const Buffer<Vec<D>>& kR) {
    const Vector left = flat<D>(kR), right = flat<D>(kOther);
    const double size = left.norm() * flat<D>(other).norm();
    EXPECT_LE(std::abs(left.dot(flat<D>(other)) - right.dot(flat<D>(r))), operatorTolerance * size);
  }

  void checkSingle(const CycleSweeps& sweeps, const std::vector<Vec<D>>& expected) {
    auto multigrid = makeDevice<float>(sweeps);
    const Buffer<Vec<D>> z = apply(multigrid, r), again = apply(multigrid, r);
    EXPECT_LE(relativeDifference<double>(z.span(), std::span<const Vec<D>>(expected)), 10 * singleTolerance);
    EXPECT_EQ(std::memcmp(z.data(), again.data(), z.span().size_bytes()), 0) << "not the same bits";
  }

  void checkAll(const char* what, double tolerance) {
    for (const CycleSweeps& sweeps : {CycleSweeps{2, 3, 4}, CycleSweeps{2, 2, 4}}) {
      SCOPED_TRACE(testing::Message() << D << "D, " << what << ", " << sweeps.middle
                                      << " sweeps on middle levels");
      const std::vector<Vec<D>> expected = onCpu(sweeps);
      checkScale(expected);
      checkDouble(sweeps, expected, tolerance);
      checkSingle(sweeps, expected);
    }
  }
};

/// Without walls inertia alone holds a body: its coarse operators are small differences of large numbers, and K
/// magnifies the rounding errors of another order of summation some ten thousand times. In single precision that
/// would be visible were the coarse operators not summed in double precision.
template <int D>
void checkSmall(SchemeKind scheme) {
  SCOPED_TRACE(nameOf(scheme));
  for (const Walls walls : {Walls::Floor, Walls::None}) {
    CycleTwin<D> twin(makeScene<D>({.walls = walls, .scheme = scheme}));
    ASSERT_LE(twin.unknownsOn(0), (BucketMultigrid<D, double, Cuda>().denseUnknowns()));
    if (walls == Walls::Floor)
      twin.checkAll("floor", operatorTolerance);
    else
      twin.checkAll("no walls", 100 * operatorTolerance);
  }
}

TEST(BucketMultigridTwin, EqualsTheCpuAsOneDenseMatrix) {
  TREACLE_SKIP_WITHOUT_GPU();
  for (const SchemeKind scheme : bothSchemes) {
    checkSmall<2>(scheme);
    checkSmall<3>(scheme);
  }
}

template <int D>
void checkLarge(std::size_t levelsAboveDense) {
  CycleTwin<D> twin(makeLargeScene<D>(SchemeKind::Published));
  ASSERT_GT(twin.unknownsOn(levelsAboveDense - 1), (BucketMultigrid<D, double, Cuda>().denseUnknowns()));
  twin.checkAll("many particles", operatorTolerance);
}

TEST(BucketMultigridTwin, EqualsTheCpuWithLevelsAboveTheDenseOne) {
  TREACLE_SKIP_WITHOUT_GPU();
  checkLarge<2>(2);
  checkLarge<3>(1);
}

}  // namespace
}  // namespace treacle::test
