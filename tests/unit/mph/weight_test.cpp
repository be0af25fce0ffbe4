#include "treacle/mph/mph_terms.hpp"

#include <gtest/gtest.h>

namespace treacle {
namespace {

constexpr SchemeKind schemes[] = {SchemeKind::Published, SchemeKind::Accurate};
constexpr WeightShape shapes[] = {WeightShape::Published, WeightShape::Wendland, WeightShape::DensityWindow,
                                  WeightShape::GradientWindow};

/// Of f(r) over all space, by the midpoint rule; the volume element is 2 pi r dr or 4 pi r^2 dr.
template <int D, class F>
double integral(double radius, F&& f) {
  const int n = 20000;
  const double dr = radius / n;
  double sum = 0;
  for (int i = 0; i < n; ++i) {
    const double r = (i + 0.5) * dr;
    sum += f(r) * (D == 2 ? 2 * M_PI * r : 4 * M_PI * r * r) * dr;
  }
  return sum;
}

template <int D>
void checkIntegral() {
  const double l = 0.3, volume = std::pow(l, D);
  for (const WeightShape shape : shapes) {
    const auto w = Weight<D>::make(2.3 * l, l, shape);
    EXPECT_NEAR(integral<D>(w.radius, [&](double r) { return w.value(r); }), volume, 1e-6 * volume);
    EXPECT_EQ(w.value(w.radius), 0);
    EXPECT_EQ(w.value(2 * w.radius), 0);
  }
}

TEST(Weight, IntegratesToTheParticleVolume) {
  checkIntegral<2>();
  checkIntegral<3>();
}

TEST(Weight, SlopesBeyondTheirReachAreNextToNothing) {
  for (const SchemeKind scheme : schemes) {
    const auto terms = MphTerms<3>::make(scheme, 1, 1, 0.3);
    const auto slope = [&](double r) { return r * terms.gradient(ExactDistance(r * r)); };
    double largest = 0, beyond = 0;
    for (double r = 0.001; r < 1; r += 0.001) {
      largest = std::max(largest, slope(r));
      if (r >= slopeReach(scheme)) beyond = std::max(beyond, slope(r));
    }
    EXPECT_LT(beyond, 0.005 * largest) << static_cast<int>(scheme);
    EXPECT_GT(largest, 0);
  }
}

/// The terms of a pair in the arithmetic and the unit of length of a loop: densities and gradients against the
/// weight and its numerical derivative.
template <int D, class Real>
void checkPressureTerms(double unit, double tolerance) {
  for (const SchemeKind scheme : schemes) {
    const auto w = Weight<D>::make(1.75e-3, 1e-3, gradientWeight(scheme));
    auto exact = MphTerms<D>::make(scheme, w.radius, 3.5e-3, 1e-3);
    for (const double r : {0.4e-3, 1.3e-3, 1.74e-3, 2.9e-3, 4e-3}) {
      SCOPED_TRACE(testing::Message() << "scheme " << static_cast<int>(scheme) << ", r " << r);
      const auto terms = exact.template inUnitsOf<Real>(unit);
      const double s = r / unit, step = 1e-8;
      const PairDistance<Real> distance{static_cast<Real>(s * s), static_cast<Real>(1 / s)};
      const double slope = (w.value(r + step) - w.value(r - step)) / (2 * step);
      for (const WeightShape shape : {WeightShape::Published, WeightShape::Wendland, WeightShape::DensityWindow}) {
        const auto density = Weight<D>::make(2.2e-3, 1e-3, shape);
        auto own = exact;
        own.setDensityWeight(density);
        const auto other = own.template inUnitsOf<Real>(unit);
        EXPECT_NEAR(other.density(other.densityFactor, distance), density.value(r), tolerance * density.value(0));
      }
      EXPECT_NEAR(terms.gradient(distance) * s, -slope, (tolerance + 1e-7) * w.value(0) / w.radius * 10);
      EXPECT_NEAR(terms.gradient(distance) * s, exact.gradient(ExactDistance(r * r)) * r,
                  tolerance * w.value(0) / w.radius * 10);
    }
  }
}

/// Viscosities: a full neighbourhood gives mu (grad^2 u + 2 grad div u), so the fourth moment of pair blocks
/// viscous d d^T is 2 D (D+2); with the weight of [K23] they are those of its eq. (4).
template <int D, class Real>
void checkViscosityTerms(double unit, double tolerance) {
  const double l = 1e-3, hv = 3.5e-3;
  const auto w = Weight<D>::make(hv, l, WeightShape::Published);
  for (const SchemeKind scheme : schemes) {
    const auto exact = MphTerms<D>::make(scheme, 1.75e-3, hv, l);
    const auto blockOf = [&](double r) { return exact.viscous(exact.viscousFactor, ExactDistance(r * r)); };
    const double moment = integral<D>(hv, [&](double r) { return blockOf(r) * std::pow(r, 4); }) / std::pow(l, D);
    EXPECT_NEAR(moment, 2 * D * (D + 2), 1e-6 * moment);
    const auto terms = exact.template inUnitsOf<Real>(unit);
    for (const double r : {0.4e-3, 1.3e-3, 2.9e-3, 3.6e-3}) {
      SCOPED_TRACE(testing::Message() << "scheme " << static_cast<int>(scheme) << ", r " << r);
      const double s = r / unit;
      const PairDistance<Real> distance{static_cast<Real>(s * s), static_cast<Real>(1 / s)};
      const double block = blockOf(r);
      EXPECT_EQ(block == 0, r > hv);
      EXPECT_NEAR(terms.viscousFactor * terms.viscousShape(distance) * s * s, block * r * r,
                  tolerance * block * r * r);
      EXPECT_NEAR(terms.viscous(terms.viscousFactor, distance) * s * s, block * r * r, tolerance * block * r * r);
      if (scheme == SchemeKind::Published && r < hv) {
        const double slope = -2 * w.scale / hv * (1 - r / hv);
        EXPECT_NEAR(block * r * r, 2 * (D + 2) * -slope / r, 1e-12 * block * r * r);
      }
    }
  }
}

TEST(MphTerms, AreThoseOfTheWeightsInEveryArithmetic) {
  checkPressureTerms<2, double>(1, 1e-12);
  checkPressureTerms<3, double>(1, 1e-12);
  checkPressureTerms<2, float>(3.5e-3, 1e-5);
  checkPressureTerms<3, float>(3.5e-3, 1e-5);
  checkViscosityTerms<2, double>(1, 1e-12);
  checkViscosityTerms<3, double>(1, 1e-12);
  checkViscosityTerms<2, float>(3.5e-3, 1e-5);
  checkViscosityTerms<3, float>(3.5e-3, 1e-5);
}

TEST(MphTerms, AreTheSameWhereTheCompilerKnowsTheScheme) {
  for (const SchemeKind scheme : schemes) {
    const auto chosen = MphTerms<3>::make(scheme, 3e-3, 3.5e-3, 1e-3);
    int calls = 0;
    withScheme(chosen, [&]<class Scheme>(const MphTerms<3, double, Scheme>& terms) {
      ++calls;
      EXPECT_EQ(Scheme::kind, scheme);
      const ExactDistance r(1.7e-3 * 1.7e-3);
      EXPECT_DOUBLE_EQ(terms.density(terms.densityFactor, r), chosen.density(chosen.densityFactor, r));
      EXPECT_DOUBLE_EQ(terms.gradient(r), chosen.gradient(r));
      EXPECT_DOUBLE_EQ(terms.viscous(terms.viscousFactor, r), chosen.viscous(chosen.viscousFactor, r));
    });
    EXPECT_EQ(calls, 1);
  }
}

TEST(Weight, LatticeNumberDensityIsTheSumOverNeighbours) {
  // 2D, h = 1.75 l: four neighbours at l and four at sqrt(2) l; 3D: 6, 12 and 8 at l, sqrt(2) l, sqrt(3) l.
  const auto w2 = Weight<2>::make(1.75, 1.0, WeightShape::Published);
  EXPECT_DOUBLE_EQ(latticeNumberDensity(w2, 1.0), 4 * w2.value(1) + 4 * w2.value(std::sqrt(2.0)));
  const auto w3 = Weight<3>::make(1.75, 1.0, WeightShape::Published);
  EXPECT_NEAR(latticeNumberDensity(w3, 1.0),
              6 * w3.value(1) + 12 * w3.value(std::sqrt(2.0)) + 8 * w3.value(std::sqrt(3.0)), 1e-15);
  // A wide neighbourhood sums to 1 less the particle's own share.
  for (const WeightShape shape : shapes) {
    const auto wide = Weight<2>::make(20.0, 1.0, shape);
    EXPECT_NEAR(latticeNumberDensity(wide, 1.0) + wide.value(0), 1, 1e-3);
  }
}

/// The window of Kaiser and Bessel itself.
TEST(Weight, OfDensitiesIsTheWindowThatItNames) {
  const double most = std::cyl_bessel_i(2.0, 10.0);
  for (double q = 0; q < 1; q += 0.01) {
    const double s = 1 - q * q;
    EXPECT_NEAR(DensityWindow::at(s), s * std::cyl_bessel_i(2.0, 10 * std::sqrt(s)) / most, 5e-4) << q;
  }
}

/// By the volume that two windows have in common: the distance z of the planes across the line between them, and
/// the distance from that line.
TEST(Weight, OfGradientsIsTheFoldedWindowThatItNames) {
  const auto window = [](double square) {  // of twice the distance from its centre
    return square < 1 ? std::cyl_bessel_i(0.0, 5.25 * std::sqrt(1 - square)) : 0;
  };
  const auto folded = [&](double q) {
    constexpr int n = 200;
    double sum = 0;
    for (int i = 0; i < 2 * n; ++i)
      for (int j = 0; j < n; ++j) {
        const double z = (i + 0.5) / n - 1, r = (j + 0.5) / n;
        const double apart = z - 2 * q;
        sum += window(z * z + r * r) * window(apart * apart + r * r) * r;
      }
    return sum;
  };
  const double most = folded(0);
  for (double q = 0; q < 1; q += 0.1) EXPECT_NEAR(GradientWindow::at(1 - q * q), folded(q) / most, 1e-3) << q;
}

TEST(Weight, SlopesOfWindowsAreTheirDerivatives) {
  const auto check = []<class W>(W) {
    for (double s = 0.01; s < 1; s += 0.01)
      EXPECT_NEAR(W::template slope<double>(s), (W::at(s + 1e-6) - W::at(s - 1e-6)) / 2e-6, 1e-8) << s;
  };
  check(DensityWindow{});
  check(GradientWindow{});
}

/// Waves of particles as short as the spacing, or shorter, hardly change what a uniform pressure does, and none
/// gains by it. The transform of the weight of gradients in two dimensions and in three, over that for long waves.
template <int D>
double transform(double wave, double radius) {
  const auto part = [&](double k) {
    return integral<D>(radius, [&](double r) {
      const double q = r / radius, x = k * r;
      return GradientWindow::at(1 - q * q) * (D == 2 ? std::cyl_bessel_j(0.0, x) : x == 0 ? 1 : std::sin(x) / x);
    });
  };
  return part(wave) / part(0);
}

TEST(Weight, OfGradientsHardlyHasShortWaves) {
  constexpr double radius = 2.5;  // spacings
  for (double wave = 0.5; wave < 20; wave += 0.7) {
    const double least = std::min(transform<2>(wave, radius), transform<3>(wave, radius));
    const double most = std::max(transform<2>(wave, radius), transform<3>(wave, radius));
    EXPECT_GT(least, -5e-5) << wave;
    if (wave > 6) {
      EXPECT_LT(most, 3e-4) << wave;
    }
  }
}

/// What the density of a lattice changes by when it is strained by exp(eps) along an axis of its own, and as much
/// less along the others: as much fluid is where it was.
template <int D>
double strained(const Weight<D>& w, double eps) {
  const double across = std::exp(-eps / (D - 1));
  const auto density = [&](double along, double beside) {
    double n = 0;
    for (int k = D == 3 ? -9 : 0; k <= (D == 3 ? 9 : 0); ++k)
      for (int i = -9; i <= 9; ++i)
        for (int j = -9; j <= 9; ++j)
          if (i != 0 || j != 0 || k != 0) n += w.value(std::hypot(i * along, j * beside, k * beside));
    return n;
  };
  return density(std::exp(eps), across) / density(1, 1) - 1;
}

TEST(Weight, OfDensitiesHardlySeesStrainAtConstantVolume) {
  for (const double eps : {-0.5, -0.2, 0.1, 0.3, 0.5}) {
    EXPECT_NEAR(strained(Weight<2>::make(3.5, 1, WeightShape::DensityWindow), eps), 0, 5e-4) << eps;
    EXPECT_NEAR(strained(Weight<3>::make(3.5, 1, WeightShape::DensityWindow), eps), 0, 1e-3) << eps;
  }
  EXPECT_LT(strained(Weight<2>::make(1.75, 1, WeightShape::Published), 0.05), -0.001);
}

}  // namespace
}  // namespace treacle
