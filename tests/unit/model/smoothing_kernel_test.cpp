#include "treacle/model/particles/smoothing_kernel.hpp"

#include <gtest/gtest.h>

namespace treacle::test {
namespace {

/// Integral over the plane or over space by Simpson's rule; the pieces meet the seams of the spline.
template <int D, class F>
double integral(const SmoothingKernel<D>& kernel, F&& f) {
  const int pieces = 2000;
  const double step = kernel.radius() / pieces;
  double sum = 0;
  for (int n = 0; n <= pieces; ++n) {
    const double r = n * step, shell = D == 2 ? 2 * M_PI * r : 4 * M_PI * r * r;
    sum += (n == 0 || n == pieces ? 1 : n % 2 ? 4 : 2) * shell * f(r);
  }
  return sum * step / 3;
}

template <int D>
void check(KernelKind kind, double h) {
  const auto kernel = SmoothingKernel<D>::make(kind, h);
  SCOPED_TRACE(testing::Message() << D << "D, kernel " << static_cast<int>(kind) << ", h = " << h);
  EXPECT_DOUBLE_EQ(kernel.radius(), 2 * h);
  EXPECT_NEAR(integral<D>(kernel, [&](double r) { return kernel.value(r); }), 1, 1e-10);
  // By parts: the integral of r |W'| is D times that of W.
  EXPECT_NEAR(integral<D>(kernel, [&](double r) { return r * r * kernel.slope(r); }), D, 1e-9);

  const double scale = kernel.value(0) / h, small = 1e-6 * h;
  for (double r = 0.01 * h; r < 2.2 * h; r += 0.0137 * h) {
    const double difference = (kernel.value(r + small) - kernel.value(r - small)) / (2 * small);
    EXPECT_NEAR(kernel.slope(r) * r, -difference, 1e-8 * scale) << "at r / h = " << r / h;
    EXPECT_GE(kernel.slope(r), 0);
  }
  for (const double r : {2 * h, 2.0001 * h, 3 * h, 1e3 * h}) {
    EXPECT_NEAR(kernel.value(r), 0, 1e-40 * scale * h);
    EXPECT_NEAR(kernel.slope(r), 0, 1e-25 * scale / h);
  }
  EXPECT_GT(kernel.value(1.99 * h), 0);
  EXPECT_TRUE(std::isfinite(kernel.slope(0)));
  // Continuous where the spline has its seam.
  EXPECT_NEAR(kernel.value(h * (1 - 1e-12)), kernel.value(h * (1 + 1e-12)), 1e-11 * scale * h);
  EXPECT_NEAR(kernel.slope(h * (1 - 1e-12)), kernel.slope(h * (1 + 1e-12)), 1e-11 * scale / h);
}

TEST(SmoothingKernel, HasUnitIntegralItsOwnSlopeAndSupport) {
  for (const KernelKind kind : {KernelKind::CubicSpline, KernelKind::WendlandC2})
    for (const double h : {1.2, 0.012}) {
      check<2>(kind, h);
      check<3>(kind, h);
    }
}

TEST(SmoothingKernel, CubicSplineHasItsTextbookValues) {
  const auto plane = SmoothingKernel<2>::make(KernelKind::CubicSpline, 1);
  EXPECT_NEAR(plane.value(0), 10 / (7 * M_PI), 1e-15);
  EXPECT_NEAR(plane.value(1), 10 / (7 * M_PI) / 4, 1e-15);
  const auto space = SmoothingKernel<3>::make(KernelKind::CubicSpline, 2);
  EXPECT_NEAR(space.value(0), 1 / (8 * M_PI), 1e-15);
  EXPECT_NEAR(space.value(3), 1 / (8 * M_PI) / 32, 1e-15);
  EXPECT_NEAR(SmoothingKernel<2>::make(KernelKind::WendlandC2, 1).value(1), 7 / (4 * M_PI) * 3 / 16, 1e-15);
}

}  // namespace
}  // namespace treacle::test
