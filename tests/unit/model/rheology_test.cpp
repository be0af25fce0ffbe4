#include "treacle/model/materials/rheology.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace treacle::test {
namespace {

using enum RheologyModel;

Rheology powerLaw(double n) { return {.model = PowerLaw, .consistency = 3, .flowIndex = n, .mostViscosity = 1e6}; }
const Rheology bingham{.model = Bingham, .yieldStress = 20, .plasticViscosity = 2, .regularisation = 50};
const Rheology herschelBulkley{.model = HerschelBulkley,
                               .consistency = 2,
                               .flowIndex = 0.5,
                               .yieldStress = 50,
                               .regularisation = 100,
                               .mostViscosity = 1e4};
const Rheology casson{.model = Casson, .yieldStress = 5, .plasticViscosity = 0.1, .regularisation = 400};
const Rheology crossModel{
    .model = Cross, .flowIndex = 0.25, .zeroViscosity = 100, .infiniteViscosity = 1, .timeConstant = 2};
const Rheology carreau{.model = CarreauYasuda,
                       .flowIndex = 0.4,
                       .zeroViscosity = 100,
                       .infiniteViscosity = 1,
                       .timeConstant = 2,
                       .transition = 1.3};

TEST(Rheology, IsTheFormulaOfItsModel) {
  // By hand, at 8/s.
  EXPECT_NEAR(powerLaw(0.5).viscosity(8), 3 / std::sqrt(8), 1e-14);
  EXPECT_NEAR(powerLaw(1.5).viscosity(8), 3 * std::sqrt(8), 1e-14);
  EXPECT_NEAR(bingham.viscosity(8), 2 + 20.0 / 8, 1e-12);  // exp(-400) of the regularisation is left
  EXPECT_NEAR(herschelBulkley.viscosity(8), 2 / std::sqrt(8) + 50.0 / 8, 1e-12);
  const double root = std::sqrt(0.1) + std::sqrt(5.0 / 8) * (1 - std::exp(-std::sqrt(400 * 8.0)));
  EXPECT_NEAR(casson.viscosity(8), root * root, 1e-14);
  EXPECT_NEAR(crossModel.viscosity(8), 1 + 99 / (1 + 8), 1e-12);  // (2 8)^(3/4) = 8
  EXPECT_NEAR(carreau.viscosity(8), 1 + 99 * std::pow(1 + std::pow(16, 1.3), -0.6 / 1.3), 1e-12);
  EXPECT_EQ(Rheology::newtonian(7).viscosity(8), 7);
}

TEST(Rheology, OfAFluidAtRestIsFinite) {
  EXPECT_EQ(powerLaw(0.5).viscosity(0), 1e6);
  EXPECT_EQ(powerLaw(1).viscosity(0), 3);
  EXPECT_EQ(powerLaw(1.5).viscosity(0), 0);
  EXPECT_EQ(bingham.viscosity(0), 2 + 20 * 50);
  EXPECT_EQ(herschelBulkley.viscosity(0), 1e4);
  EXPECT_NEAR(casson.viscosity(0), std::pow(std::sqrt(0.1) + std::sqrt(5 * 400), 2), 1e-10);
  EXPECT_EQ(crossModel.viscosity(0), 100);
  EXPECT_EQ(carreau.viscosity(0), 100);
  EXPECT_EQ(Rheology::newtonian(7).viscosity(0), 7);
  for (const Rheology& r : {bingham, casson, crossModel, carreau})  // no jump where the series begins
    EXPECT_NEAR(r.viscosity(1e-12), r.viscosity(0), 1e-4 * r.viscosity(0));
}

TEST(Rheology, GrowsInStressAndFallsInViscosity) {
  for (const Rheology& r : {powerLaw(0.5), bingham, herschelBulkley, casson, crossModel, carreau})
    for (double rate = 1e-8; rate < 1e8; rate *= 1.3) {
      ASSERT_LE(r.viscosity(1.3 * rate), r.viscosity(rate) * (1 + 1e-14));
      ASSERT_GT(r.viscosity(1.3 * rate) * 1.3 * rate, r.viscosity(rate) * rate) << rate;
    }
}

TEST(Rheology, YieldStressIsReachedWithinAMultipleOfTheRegularisation) {
  for (const Rheology& r : {bingham, herschelBulkley}) {
    const double rate = 5 / r.regularisation, yielded = r.viscosity(rate) * rate;
    EXPECT_GT(yielded, r.yieldStress * (1 - std::exp(-5.0)));
    EXPECT_LT(r.viscosity(0.01 / r.regularisation) * 0.01 / r.regularisation, 0.012 * r.yieldStress);
  }
}

TEST(Rheology, KeepsItsBounds) {
  Rheology r = powerLaw(0.5);
  r.leastViscosity = 0.5, r.mostViscosity = 5;
  EXPECT_EQ(r.viscosity(1e-9), 5);
  EXPECT_EQ(r.viscosity(1e9), 0.5);
  EXPECT_NEAR(r.viscosity(1), 3, 1e-14);
}

/// Repeats solve and viscosity where the flow gives gamma = (stress / mu)^share: share 0 prescribes the shear
/// rate, 1 the stress. Error of the logarithm of the rate after so many solves.
double errorAfter(int solves, const Rheology& r, double share, double start) {
  const double exact = std::pow(3.0, share / (1 + share * (r.flowIndex - 1)));  // of K = 3 and a stress of 9
  const double stress = 9;
  double rate = start;
  for (int k = 0; k < solves; ++k) rate = r.nextRate(rate, std::pow(stress / r.viscosity(rate), share));
  return std::abs(std::log(rate / exact));
}

TEST(Rheology, OfAThickeningFluidSettles) {
  for (const double n : {1.5, 2.0, 3.0})
    for (const double share : {0.0, 0.5, 1.0}) {
      const double left = (n - 1) / (n + 1), before = errorAfter(0, powerLaw(n), share, 0.1);
      EXPECT_LE(errorAfter(4, powerLaw(n), share, 0.1), std::pow(left, 4) * before * (1 + 1e-9) + 1e-12) << n;
    }
  EXPECT_EQ(powerLaw(0.5).nextRate(3, 7), 7);
  EXPECT_EQ(powerLaw(3).nextRate(0, 7), 7);
  EXPECT_EQ(powerLaw(3).nextRate(7, 0), 0);
}

}  // namespace
}  // namespace treacle::test
