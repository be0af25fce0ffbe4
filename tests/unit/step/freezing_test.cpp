#include "support/loaded_walls.hpp"
#include "support/same_bits.hpp"
#include "support/state_of.hpp"
#include "support/temperature_range.hpp"
#include "treacle/model/materials/enthalpy.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace treacle::test {
namespace {

const Freezing wax{.solidus = 309.5,
                   .liquidus = 310.5,
                   .latentHeat = 200,
                   .solidConductivity = 1.5,
                   .solidSpecificHeat = 2,
                   .solidFactor = 50};

/// Two fluids of which one freezes, between walls. Where it is warm it is liquid.
template <int D>
LoadedWalls<D> freezing(SchemeKind scheme, WallsMove walls = WallsMove::Apart) {
  LoadedWalls<D> start(walls, 1, scheme);
  start.c.heat.emplace();
  for (Material& m : start.c.materials) m.specificHeat = 3, m.conductivity = 0.5;
  start.c.materials[0].freezing = wax;
  start.c.bodies[0].temperature = 310;
  start.particles.has.temperatures = true;
  start.particles.temperature.resize(start.particles.fluidCount);
  for (std::uint32_t i = 0; i < start.particles.fluidCount; ++i)
    start.particles.temperature[i] = 305 + 2.4e3 * (start.particles.position[i][0] - 5e-3) + 0.3 * (i % 7);
  return start;
}

/// Heat goes through many particles in a step.
void conductWell(Case& c) {
  for (Material& m : c.materials) m.conductivity *= 100;
  c.materials[0].freezing->solidConductivity *= 100;
}

template <int D>
double frozenOf(const Particles<D>& p) {
  double sum = 0;
  for (std::uint32_t i = 0; i < p.fluidCount; ++i)
    if (p.material[i] == 0) sum += FrozenShare::make(wax).share(p.temperature[i]);
  return sum;
}

/// What the motion loses to the viscosity is what the enthalpy of the fluid gains, to rounding, whatever the
/// tolerance.
template <int D>
void checkFreezing(SchemeKind scheme) {
  LoadedWalls<D> start = freezing<D>(scheme);
  start.c.heat->tolerance = 1e-4;
  conductWell(start.c);
  Simulation<D> s = start.template simulation<Cpu>();
  const EnthalpyTable table = EnthalpyTable::make(start.c.materials);
  const auto heatOf = [&](const Particles<D>& p) {
    double sum = 0;
    for (std::uint32_t i = 0; i < p.fluidCount; ++i) sum += table.of[p.material[i]].at(p.temperature[i]);
    return sum * std::pow(start.c.spacing, D);
  };
  const double frozen = frozenOf(s.particles());
  double before = heatOf(s.particles());
  for (int k = 0; k < 4; ++k) {
    const StepReport report = s.advance();
    const HeatBalance& heat = *report.balance->heat;
    const double after = heatOf(s.particles());
    EXPECT_NEAR(heat.energy, after, 1e-13 * after);
    EXPECT_NEAR(after - before, report.timeStep * heat.heating, 1e-12 * after);
    before = after;
  }
  EXPECT_GT(std::abs(frozenOf(s.particles()) - frozen), 0.5);
}

TEST(FreezingSteps, ConserveHeat) {
  for (const SchemeKind scheme : bothSchemes) {
    checkFreezing<2>(scheme);
    checkFreezing<3>(scheme);
  }
}

/// The result does not depend on how far it is iterated, but for what the tolerance allows.
TEST(FreezingSteps, AreSolvedToTheTolerance) {
  LoadedWalls<2> start = freezing<2>(SchemeKind::Accurate);
  start.c.heat->viscousHeating = false;
  conductWell(start.c);
  Simulation<2> coarse = start.simulation<Cpu>();
  start.c.heat->tolerance = 1e-22;
  Simulation<2> fine = start.simulation<Cpu>();
  const double frozen = frozenOf(fine.particles());
  coarse.advance(), fine.advance();
  ASSERT_GT(std::abs(frozenOf(fine.particles()) - frozen), 1);
  for (std::uint32_t i = 0; i < fine.particles().fluidCount; ++i)
    EXPECT_NEAR(coarse.particles().temperature[i], fine.particles().temperature[i], 1e-4);
}

/// Warm parts cool and cold parts warm up to their common temperature, without new extremes.
TEST(FreezingSteps, HaveNoNewExtremes) {
  LoadedWalls<2> start = freezing<2>(SchemeKind::Accurate);
  start.c.heat->viscousHeating = false;
  expectNoNewExtremes(start, 0.9);
}

/// A reaction heats all fluid at a given rate through melting: temperatures follow the enthalpy.
TEST(FreezingSteps, TemperaturesFollowTheHeatThatIsGiven) {
  LoadedWalls<2> start = freezing<2>(SchemeKind::Accurate, WallsMove::Not);
  start.c.heat->viscousHeating = false;
  constexpr double start0 = 300, perSecond = 6e3;  // [K], [W/kg]
  for (Material& m : start.c.materials) {
    m.freezing = wax, m.specificHeat = 3;
    m.states = {{.name = "reacted", .rate = "1", .heat = perSecond}};
  }
  Particles<2>& p = start.particles;
  p.has.states = 1;
  p.states[0].resize(p.fluidCount);
  std::fill(p.states[0].begin(), p.states[0].end(), 0);
  p.has.shearRates = true;
  p.shearRate.resize(p.fluidCount);
  std::fill(p.shearRate.begin(), p.shearRate.end(), 0);
  std::fill(p.temperature.begin(), p.temperature.end(), start0);
  Simulation<2> s = start.simulation<Cpu>();
  const Enthalpy h = Enthalpy::make(start.c.materials[0]);
  const double density = start.c.materials[0].density;
  int below = 0, between = 0, above = 0;
  for (int k = 0; k < 40; ++k) {
    s.advance();
    const auto& now = s.particles();
    for (std::uint32_t i = 0; i < now.fluidCount; ++i) {
      if (now.material[i] != 0) continue;
      const double T = h.temperature(h.at(start0) + density * perSecond * s.time());
      ASSERT_NEAR(now.temperature[i], T, 1e-3);
      ++(T < wax.solidus ? below : T < wax.liquidus ? between : above);
    }
  }
  EXPECT_GT(below, 0);
  EXPECT_GT(between, 0);
  EXPECT_GT(above, 0);
}

/// A frozen body is as much stiffer as it says.
TEST(FreezingSteps, MultiplyTheViscosityOfWhatIsFrozen) {
  Case c = freezing<2>(SchemeKind::Accurate).c;
  std::vector<FormulaStep> formulas;
  RheologyTable table = RheologyTable::make(c, formulas);
  const double temperature[] = {300, 310, 320};
  table.temperature = temperature;
  const double mu = c.materials[0].dynamicViscosity, other = c.materials[1].dynamicViscosity;
  EXPECT_NEAR(table.viscosity(0, 0, 1), 50 * mu, 1e-12 * 50 * mu);
  EXPECT_NEAR(table.viscosity(1, 0, 1), std::sqrt(50) * mu, 1e-12 * 50 * mu);
  EXPECT_EQ(table.viscosity(2, 0, 1), mu);
  for (const std::size_t i : {0, 1, 2}) EXPECT_EQ(table.viscosity(i, 1, 1), other);
}

TEST(FreezingSteps, ContinueFromACopyWithTheSameBits) {
  const LoadedWalls<2> start = freezing<2>(SchemeKind::Accurate);
  Simulation<2> whole = start.simulation<Cpu>();
  for (int k = 0; k < 3; ++k) whole.advance();
  Simulation<2> resumed(start.c, stateOf(whole), whole.step(), whole.time());
  for (int k = 0; k < 3; ++k) whole.advance(), resumed.advance();
  expectSameBits(stateOf(whole), stateOf(resumed));
}

}  // namespace
}  // namespace treacle::test
