#include "treacle/model/materials/viscosity_shift.hpp"
#include "treacle/model/materials/rheology.hpp"

#include <gtest/gtest.h>

namespace treacle::test {
namespace {

const ViscosityShift arrhenius{.model = ShiftModel::Arrhenius, .reference = 300, .activationEnergy = 5e4};
const ViscosityShift vft{.model = ShiftModel::Vft, .reference = 1375, .slope = 4215, .divergence = 536};
const ViscosityShift wlf{.model = ShiftModel::Wlf, .reference = 373.15, .c1 = 17.44, .c2 = 51.6};
const ViscosityShift table{.model = ShiftModel::Table, .temperatures = {300, 320, 360}, .factors = {10, 1, 0.01}};

double at(const ViscosityShift& shift, double T) { return ShiftFactor::make(shift)(T); }

TEST(ViscosityShift, IsTheFormulaOfItsModel) {
  EXPECT_NEAR(at(arrhenius, 350) / std::exp(5e4 / 8.31446261815324 * (1 / 350.0 - 1 / 300.0)), 1, 1e-12);
  EXPECT_NEAR(at(vft, 1200) / std::pow(10, 4215 * (1 / 664.0 - 1 / 839.0)), 1, 1e-12);
  EXPECT_NEAR(at(wlf, 400) / std::pow(10, -17.44 * 26.85 / (51.6 + 26.85)), 1, 1e-12);
  EXPECT_NEAR(at(table, 310), std::sqrt(10), 1e-12);
  EXPECT_NEAR(at(table, 350), std::pow(10, -1.5), 1e-12);
  for (const ViscosityShift& shift : {arrhenius, vft, wlf}) EXPECT_EQ(at(shift, shift.reference), 1);
}

TEST(ViscosityShift, HasBounds) {
  EXPECT_NEAR(at(arrhenius, 100), 1e6, 1e-6);
  EXPECT_NEAR(at(vft, 400), 1e6, 1e-6);  // below the pole
  EXPECT_NEAR(at(wlf, 300), 1e6, 1e-6);
  ViscosityShift narrow = arrhenius;
  narrow.least = 0.5, narrow.most = 3;
  EXPECT_NEAR(at(narrow, 1000), 0.5, 1e-12);
  EXPECT_NEAR(at(narrow, 200), 3, 1e-12);
  EXPECT_NEAR(at(table, 200), 10, 1e-12);
  EXPECT_NEAR(at(table, 500), 0.01, 1e-12);
}

TEST(ViscosityShift, LeavesATableItsFactors) {
  ViscosityShift steep = table;
  steep.factors = {1e9, 1, 1e-9};
  EXPECT_NEAR(at(steep, 300) / 1e9, 1, 1e-12);
  EXPECT_NEAR(at(steep, 360) / 1e-9, 1, 1e-12);
}

TEST(ViscosityShift, IsOneForMaterialsWithout) { EXPECT_EQ(ShiftFactor{}(500), 1); }

/// At another temperature a fluid has the stress that it has at the reference for a_T times the shear rate.
TEST(ViscosityShift, MovesTheFlowCurveOfARheology) {
  const Rheology carreau{.model = RheologyModel::CarreauYasuda,
                         .flowIndex = 0.4,
                         .zeroViscosity = 100,
                         .infiniteViscosity = 1,
                         .timeConstant = 2};
  const double a = at(arrhenius, 320), rate = 3;
  EXPECT_NEAR(rate * carreau.viscosity(rate, a), a * rate * carreau.viscosity(a * rate), 1e-12);
  EXPECT_EQ(Rheology::newtonian(7).viscosity(rate, a), a * 7);
  Rheology bounded = carreau;
  bounded.mostViscosity = 50;
  EXPECT_EQ(bounded.viscosity(0, at(arrhenius, 280)), 50);  // at all temperatures
}

}  // namespace
}  // namespace treacle::test
