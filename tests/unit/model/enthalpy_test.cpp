#include "treacle/model/materials/enthalpy.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace treacle::test {
namespace {

/// 1 m3 of it weighs 2 kg.
Material wax() {
  Material m;
  m.density = 2, m.specificHeat = 30, m.conductivity = 5;
  m.freezing = Freezing{.solidus = 300,
                        .liquidus = 310,
                        .latentHeat = 1000,
                        .solidConductivity = 9,
                        .solidSpecificHeat = 20,
                        .solidFactor = 1e4};
  return m;
}

TEST(Enthalpy, CountsTheHeatOfSolidLatentAndLiquid) {
  const Enthalpy h = Enthalpy::make(wax());
  EXPECT_DOUBLE_EQ(h.at(100), 2 * 20 * 100);
  EXPECT_DOUBLE_EQ(h.at(300), 2 * 20 * 300);
  EXPECT_DOUBLE_EQ(h.at(310) - h.at(300), 2 * (1000 + 25 * 10));
  EXPECT_DOUBLE_EQ(h.at(305) - h.at(300), 1000 + 25 * 10);
  EXPECT_DOUBLE_EQ(h.at(320) - h.at(310), 2 * 30 * 10);
}

TEST(Enthalpy, AndTemperatureAreInverse) {
  const Enthalpy h = Enthalpy::make(wax());
  for (double T = 280; T < 330; T += 0.7) EXPECT_NEAR(h.temperature(h.at(T)), T, 1e-12 * T);
  for (const double T : {300.0, 310.0}) EXPECT_NEAR(h.temperature(h.at(T)), T, 1e-12 * T);
}

TEST(Enthalpy, HasTheSlopesOfItsPieces) {
  const Enthalpy h = Enthalpy::make(wax());
  for (const double T : {250.0, 305.0, 350.0})
    EXPECT_NEAR((h.at(T + 1e-3) - h.at(T - 1e-3)) / 2e-3, h.slope(T), 1e-6 * h.slope(T));
  EXPECT_EQ(h.leastSlope(), 40);
}

TEST(Enthalpy, OfWhatDoesNotFreezeIsThatOfTheLiquidAlone) {
  Material m = wax();
  m.freezing.reset();
  const Enthalpy h = Enthalpy::make(m);
  for (const double T : {1.0, 299.0, 305.0, 1000.0}) {
    EXPECT_EQ(h.at(T), 60 * T);
    EXPECT_EQ(h.conductivity(T), 5);
    EXPECT_EQ(h.slope(T), 60);
    EXPECT_EQ(h.frozen.viscosityFactor(T), 1);
  }
}

TEST(Freezing, GoesWithTheFrozenShare) {
  const Enthalpy h = Enthalpy::make(wax());
  const double share[][2] = {{290, 1}, {300, 1}, {302.5, 0.75}, {305, 0.5}, {310, 0}, {400, 0}};
  for (const auto& [T, frozen] : share) {
    EXPECT_DOUBLE_EQ(h.frozen.share(T), frozen);
    EXPECT_DOUBLE_EQ(h.conductivity(T), 5 + frozen * 4);
    EXPECT_NEAR(h.frozen.viscosityFactor(T), std::pow(1e4, frozen), 1e-10 * std::pow(1e4, frozen));
  }
}

TEST(Freezing, TakesTheConstantsOfTheLiquidForTheSolid) {
  Material m = wax();
  m.freezing->solidConductivity = m.freezing->solidSpecificHeat = 0;
  const Enthalpy h = Enthalpy::make(m);
  EXPECT_EQ(h.solid, h.liquid);
  EXPECT_EQ(h.conductivity(280), h.conductivity(350));
}

}  // namespace
}  // namespace treacle::test
