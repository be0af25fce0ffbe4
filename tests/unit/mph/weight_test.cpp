#include "treacle/mph/mph_terms.hpp"

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

/// The terms of a pair in the arithmetic and the unit of length of a loop, against the momentum equation's
/// coefficients [K23 eq. (4)].
template <int D, class Real>
void checkTerms(double unit, double tolerance) {
  const auto p = Weight<D>::make(1.75e-3, 1e-3), v = Weight<D>::make(3.5e-3, 1e-3);
  const auto terms = MphTerms<D>::make(p, v).template inUnitsOf<Real>(unit);
  for (const double r : {0.4e-3, 1.3e-3, 1.74e-3, 2.9e-3, 4e-3}) {
    const double s = r / unit;
    const PairDistance<Real> distance{static_cast<Real>(s * s), static_cast<Real>(1 / s)};
    const double slope = -v.derivative(r);
    EXPECT_NEAR(terms.density(terms.densityFactor, distance), p.value(r), tolerance * p.value(0));
    EXPECT_NEAR(terms.gradient(distance) * s, -p.derivative(r), tolerance * -p.derivative(0));
    EXPECT_NEAR(terms.viscousFactor * terms.viscousShape(distance) * s * s, 2 * (D + 2) * slope / r,
                tolerance * 2 * (D + 2) * slope / r);
    EXPECT_NEAR(terms.viscous(terms.viscousFactor, distance), terms.viscousFactor * terms.viscousShape(distance),
                tolerance * terms.viscousFactor * terms.viscousShape(distance));
  }
}

TEST(MphTerms, AreTheMomentumEquationsCoefficientsInEveryArithmetic) {
  checkTerms<2, double>(1, 1e-12);
  checkTerms<3, double>(1, 1e-12);
  checkTerms<2, float>(3.5e-3, 1e-5);
  checkTerms<3, float>(3.5e-3, 1e-5);
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
