#include "treacle/method/weight.hpp"

#include <gtest/gtest.h>

namespace treacle {
namespace {

template <int D>
double integral(const Weight<D>& w) {
  // Midpoint rule in r; the volume element is 2 pi r dr or 4 pi r^2 dr.
  const int n = 20000;
  const double dr = w.radius / n;
  double sum = 0;
  for (int i = 0; i < n; ++i) {
    const double r = (i + 0.5) * dr;
    sum += w.value(r) * (D == 2 ? 2 * M_PI * r : 4 * M_PI * r * r) * dr;
  }
  return sum;
}

TEST(Weight, IntegratesToTheParticleVolume) {
  const double l = 0.3;
  EXPECT_NEAR(integral(Weight<2>::make(1.75 * l, l)), l * l, 1e-6 * l * l);
  EXPECT_NEAR(integral(Weight<3>::make(3.5 * l, l)), l * l * l, 1e-6 * l * l * l);
}

template <int D>
void checkDerivative() {
  const auto w = Weight<D>::make(1.75e-3, 1e-3);
  for (double r : {0.2e-3, 0.9e-3, 1.7e-3}) {
    const double step = 1e-8;
    EXPECT_NEAR(w.derivative(r), (w.value(r + step) - w.value(r - step)) / (2 * step),
                1e-6 * std::abs(w.derivative(0)));
    EXPECT_LT(w.derivative(r), 0);
  }
  EXPECT_EQ(w.value(1.75e-3), 0);
  EXPECT_EQ(w.derivative(2e-3), 0);
}

TEST(Weight, HasItsDerivative) {
  checkDerivative<2>();
  checkDerivative<3>();
}

TEST(Weight, PairTermsAreTheMomentumEquationsCoefficients) {
  const auto w = Weight<3>::make(3.5e-3, 1e-3);
  const auto pressure = PairTerm::pressure(w), viscosity = PairTerm::viscosity(w);
  const double r = 1.3e-3;
  EXPECT_DOUBLE_EQ(pressure.factor * (1 / r - pressure.inverseRadius) * r, -w.derivative(r));
  EXPECT_NEAR(viscosity.factor * (1 / r - viscosity.inverseRadius) / (r * r) * r * r,
              -2 * (3 + 2) * w.derivative(r) / r, 1e-12 * std::abs(w.derivative(r) / r) * 10);
}

TEST(Weight, LatticeNumberDensityIsTheSumOverNeighbours) {
  // 2D, h = 1.75 l: four neighbours at l and four at sqrt(2) l; 3D: 6, 12 and 8 at l, sqrt(2) l, sqrt(3) l.
  const auto w2 = Weight<2>::make(1.75, 1.0);
  EXPECT_DOUBLE_EQ(latticeNumberDensity(w2, 1.0), 4 * w2.value(1) + 4 * w2.value(std::sqrt(2.0)));
  const auto w3 = Weight<3>::make(1.75, 1.0);
  EXPECT_NEAR(latticeNumberDensity(w3, 1.0),
              6 * w3.value(1) + 12 * w3.value(std::sqrt(2.0)) + 8 * w3.value(std::sqrt(3.0)), 1e-15);
  // A wide neighbourhood sums to 1 less the particle's own share.
  const auto wide = Weight<2>::make(20.0, 1.0);
  EXPECT_NEAR(latticeNumberDensity(wide, 1.0) + wide.value(0), 1, 1e-3);
}

}  // namespace
}  // namespace treacle
