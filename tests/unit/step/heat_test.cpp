#include "support/loaded_walls.hpp"
#include "support/same_bits.hpp"
#include "support/state_of.hpp"
#include "support/temperature_range.hpp"
#include "treacle/core/error.hpp"
#include "treacle/io/case/case_reader.hpp"
#include "treacle/model/particles/create.hpp"
#include "treacle/mph/particle_viscosity.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace treacle::test {
namespace {

Case gob(const std::vector<std::string>& overrides = {}) {
  return readCase(std::string(TREACLE_CASES) + "/glass-gob-2d.toml", overrides);
}

Particles<2> gobParticles(const Case& c) {
  std::vector<std::string> notes;
  return createParticles<2>(c, notes);
}

/// The two fluids between walls, of which one body is warm; heat goes nowhere.
template <int D>
LoadedWalls<D> closed(SchemeKind scheme) {
  LoadedWalls<D> start(WallsMove::Apart, 1, scheme);
  start.c.heat.emplace();
  for (Material& m : start.c.materials) m.specificHeat = 3, m.conductivity = 0.5;
  start.c.materials[1].conductivity = 4;
  start.c.materials[1].viscosityShift =
      ViscosityShift{.model = ShiftModel::Arrhenius, .reference = 320, .activationEnergy = 4e4};
  start.c.bodies[0].temperature = 300;
  start.particles.has.temperatures = true;
  start.particles.temperature.resize(start.particles.fluidCount);
  for (std::uint32_t i = 0; i < start.particles.fluidCount; ++i)
    start.particles.temperature[i] = 300 + 2e4 * start.particles.position[i][0];
  return start;
}

TEST(HeatSteps, TakeTheViscosityOfAMaterialWithoutAShift) {
  Case c = closed<2>(SchemeKind::Accurate).c;
  c.materials[0].rheology = Rheology::newtonian(3);
  std::vector<FormulaStep> formulas;
  RheologyTable table = RheologyTable::make(c, formulas);
  const double temperature[] = {350};
  table.temperature = temperature;
  EXPECT_EQ(table.viscosity(0, 0, 1), 3);
  EXPECT_LT(table.viscosity(0, 1, 1), c.materials[1].dynamicViscosity);
}

/// What the motion loses to the viscosity is what the fluid has gained, to rounding, whatever the tolerance.
template <int D>
void checkConservation(SchemeKind scheme) {
  LoadedWalls<D> start = closed<D>(scheme);
  start.c.heat->tolerance = 1e-4;
  Simulation<D> s = start.template simulation<Cpu>();
  const auto heatOf = [&](const Particles<D>& p) {
    double sum = 0;
    for (std::uint32_t i = 0; i < p.fluidCount; ++i) {
      const Material& m = start.c.materials[p.material[i]];
      sum += m.density * m.specificHeat * p.temperature[i];
    }
    return sum * std::pow(start.c.spacing, D);
  };
  double before = heatOf(s.particles());
  for (int k = 0; k < 4; ++k) {
    const Diagnostics diagnostics = s.diagnostics();
    const StepReport report = s.advance();
    const HeatBalance& heat = *report.balance->heat;
    EXPECT_EQ(heat.heating, report.balance->shearDissipation);
    EXPECT_EQ(heat.walls, 0);
    EXPECT_EQ(heat.surface, 0);
    const double after = heatOf(s.particles());
    EXPECT_NEAR(heat.energy, after, 1e-13 * after);
    EXPECT_NEAR(after - before, report.timeStep * heat.heating, 2e-13 * after);
    before = after;
    const StepEnergy energy(diagnostics, report);
    EXPECT_NEAR(energy.gained + energy.lost, energy.given, 5e-12 * energy.scale());
  }
}

TEST(HeatSteps, ConserveHeat) {
  for (const SchemeKind scheme : bothSchemes) {
    checkConservation<2>(scheme);
    checkConservation<3>(scheme);
  }
}

/// Heat flows from warm to cold: temperatures stay between their extremes, and those come together.
TEST(HeatSteps, HaveNoNewExtremes) {
  LoadedWalls<2> start = closed<2>(SchemeKind::Accurate);
  start.c.heat->viscousHeating = false;
  expectNoNewExtremes(start, 0.8);
}

/// Nothing changes where everything has one temperature, the surroundings that it radiates to, too.
TEST(HeatSteps, KeepOneTemperature) {
  Case c = gob({"heat.ambient_temperature=700", "gob.temperature=700", "plate.temperature=700",
                "heat.viscous_heating=false"});
  Simulation<2> s(c, gobParticles(c));
  for (int k = 0; k < 3; ++k) s.advance();
  for (const double T : s.particles().temperature) EXPECT_NEAR(T, 700, 1e-9);
}

/// A thin rod of copper that radiates cools as a whole: dT/dt = -epsilon sigma A (T^4 - T_a^4) / (rho c V).
TEST(HeatSteps, RadiateByTheFourthPower) {
  Case c = gob({"gravity.acceleration=[0,0]", "glass.conductivity=4e4", "heat.heat_transfer=0",
                "plate.temperature=0", "plate.wall_conductance=0", "gob.center=[0,0.02]", "time.step=0.05"});
  Simulation<2> s(c, gobParticles(c));
  for (int k = 0; k < 100; ++k) s.advance();
  double T = 1375;
  for (int k = 0; k < 5000; ++k)
    T -= 1e-3 * 0.85 * 5.670374419e-8 * (std::pow(T, 4) - std::pow(300, 4)) * 2 / (0.012 * 2400 * 1350);
  const auto& found = s.particles().temperature;
  EXPECT_LT(T, 1350);
  for (const double t : found) EXPECT_NEAR((t - 1375) / (T - 1375), 1, 0.1);  // as its area is known
}

/// A slab on a hot floor, of `rows` layers of 1 mm, through whose surface all heat goes: 1/q = H/k + 1/h.
template <int D>
double slabFlux(int rows, double transfer) {
  Case c;
  c.dimensions = D, c.spacing = 1e-3;
  c.time = {50, 5000};
  c.heat = HeatSettings{.ambient = 300, .transfer = transfer};
  Material m;
  m.name = "slab", m.density = 1000, m.dynamicViscosity = 5000, m.bulkViscosity = 5e5, m.bulkModulus = 1;
  m.specificHeat = 10, m.conductivity = 1;
  c.materials = {m};
  const Vec<3> top{D == 2 ? 0.016 : 0.008, D == 2 ? 1e-3 * rows : 0.008, D == 2 ? 0 : 1e-3 * rows};
  Body slab, floor;
  slab.name = "slab", slab.shape.max = top, slab.temperature = 350;
  floor.name = "floor", floor.kind = BodyKind::Wall, floor.temperature = 400;
  floor.shape.max = top, floor.shape.max[D - 1] = 0, floor.shape.min[D - 1] = -4e-3;
  c.bodies = {slab, floor};
  c.domain.max = top;
  c.domain.min[D - 1] = -4e-3, c.domain.max[D - 1] += 4e-3;
  for (int k = 0; k < D - 1; ++k) c.domain.periodic[static_cast<std::size_t>(k)] = true;
  std::vector<std::string> notes;
  Simulation<D> s(c, createParticles<D>(c, notes));
  for (int k = 0; k < 100; ++k) s.advance();
  const double between[2] = {6e-3, 1e-3 * (rows - 6)};  // away from both ends
  double low = 0, high = 0;
  const Particles<D>& p = s.particles();
  for (std::uint32_t i = 0; i < p.fluidCount; ++i) {
    if (std::abs(p.position[i][D - 1] - between[0]) < 0.6e-3) low += p.temperature[i];
    if (std::abs(p.position[i][D - 1] - between[1]) < 0.6e-3) high += p.temperature[i];
  }
  const double perLayer = 2.0 * p.fluidCount / rows;  // both layers beside each place
  return (low - high) / perLayer / (between[1] - between[0]);
}

TEST(HeatSteps, LoseTheHeatOfASlabThroughItsSurface) {
  for (const double transfer : {20.0, 200.0, 2000.0})
    EXPECT_NEAR(slabFlux<2>(20, transfer) / (100 / (0.02 + 1 / transfer)), 1, 1.5e-3) << transfer;
  EXPECT_NEAR(slabFlux<3>(20, 200) / (100 / (0.02 + 1 / 200.0)), 1, 1.5e-3);
}

TEST(HeatSteps, ContinueFromACopyWithTheSameBits) {
  const Case c = gob();
  Simulation<2> whole(c, gobParticles(c));
  for (int k = 0; k < 5; ++k) whole.advance();
  Particles<2> state = stateOf(whole);
  ASSERT_TRUE(state.has.temperatures);
  Simulation<2> resumed(c, std::move(state), whole.step(), whole.time());
  for (int k = 0; k < 5; ++k) whole.advance(), resumed.advance();
  expectSameBits(stateOf(whole), stateOf(resumed));
}

TEST(HeatSteps, NeedTemperatures) {
  const Case c = gob();
  Particles<2> p = gobParticles(c);
  p.has.temperatures = false;
  p.temperature.resize(0);
  EXPECT_THROW(Simulation<2>(c, std::move(p)), InputError);
  Case cold = gob();
  cold.heat.reset();
  cold.materials[0].viscosityShift.reset();
  Simulation<2> without(cold, gobParticles(c));
  without.advance();
  EXPECT_FALSE(without.particles().has.temperatures);
}

TEST(HeatSteps, SayWhatFailed) {
  const Case c = gob({"heat.max_iterations=1", "heat.tolerance=1e-20"});
  Simulation<2> s(c, gobParticles(c));
  try {
    s.advance();
    FAIL() << "one iteration was enough";
  } catch (const RunError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("the temperatures did not converge"));
    EXPECT_THAT(error.what(), testing::HasSubstr("heat.max_iterations"));
  }
  for (const double T : s.particles().temperature) EXPECT_EQ(T, 1375);  // nothing was accepted
}

}  // namespace
}  // namespace treacle::test
