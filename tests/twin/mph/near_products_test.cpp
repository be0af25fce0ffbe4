#include "treacle/mph/near_products.hpp"
#include "support/device_scene.hpp"
#include "support/gpu.hpp"
#include "support/matrices.hpp"
#include "support/tolerances.hpp"
#include "treacle/mph/mph_sums.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace treacle::test {
namespace {

/// The product of lists per particle against the sums of the CPU.
template <int D>
void check(Scene<D> s, const char* what) {
  SCOPED_TRACE(testing::Message() << D << "D, " << nameOf(s.c.method.scheme) << ", " << what);
  DeviceScene<D> d(s);
  NearProducts<D> products;
  products.prepare(d.context, d.pairs);

  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  std::vector<double> q(s.pairs().activeCount);
  for (double& value : q) value = normal(random);
  std::vector<Vec<D>> y(s.n());
  for (Vec<D>& value : y)
    for (int k = 0; k < D; ++k) value[k] = normal(random) / s.c.spacing;  // as large as the gradient that is added

  auto found = copyToDevice<Vec<D>>(d.context, y);
  products.addPressureGradient(d.context, copyToDevice<double>(d.context, q), found.span());
  addPressureGradient<D>(s.context, s.pairs(), q, 1, y);
  const Buffer<Vec<D>> sum = copyToHost(d.context, found);
  EXPECT_LE(relativeDifference<double>({sum.data()->v, D * sum.size()}, {y.data()->v, D * y.size()}),
            10 * kernelTolerance);
}

template <int D>
void checkAll() {
  for (const SchemeKind scheme : bothSchemes) {
    check<D>(makeScene<D>({.seed = 3, .scheme = scheme}), "floor");
    check<D>(makeScene<D>({.walls = Walls::None, .seed = 3, .scheme = scheme}), "no walls");
    check<D>(makeLargeScene<D>(scheme), "many particles");
  }
}

TEST(NearProductsTwin, EqualThePairSumsOfTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  checkAll<2>();
  checkAll<3>();
}

}  // namespace
}  // namespace treacle::test
