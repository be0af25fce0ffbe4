#include "support/loaded_walls.hpp"
#include "support/same_bits.hpp"
#include "support/state_of.hpp"
#include "treacle/io/case/case_reader.hpp"
#include "treacle/model/particles/create.hpp"
#include "treacle/step/method/buoyancy_terms.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace treacle::test {
namespace {

TEST(Buoyancy, IsTheWeightOfTheDensityThatExpansionTakesOff) {
  Case c;
  c.dimensions = 2;
  c.gravity = {0, -10, 0};
  c.heat.emplace().ambient = 290;
  c.materials = {Material{.name = "oil", .density = 800, .thermalExpansion = 1e-3},
                 Material{.name = "water", .density = 1000, .thermalExpansion = 2e-4, .expansionTemperature = 300},
                 Material{.name = "rock", .density = 3000}};
  const std::uint8_t material[] = {0, 1, 2};
  const Vec<2> position[] = {{0.1, 0}, {0.2, 0}, {0.3, 0}};
  const double T[] = {310, 250, 500};
  const Buoyancy<2> buoyancy{ExpansionTable::make(c), FrameForce<2>::of(c, 0, 0), material, position, T};
  EXPECT_NEAR(buoyancy.on(0)[1], 800 * 1e-3 * 20 * 10, 1e-10);
  EXPECT_NEAR(buoyancy.on(1)[1], -1000 * 2e-4 * 50 * 10, 1e-10);
  EXPECT_EQ(buoyancy.on(2)[1], 0);
  for (const std::size_t i : {0, 1, 2}) EXPECT_EQ(buoyancy.on(i)[0], 0);
  const double volume[] = {1, 1, 1.25};
  const Buoyancy<2> swollen{ExpansionTable::make(c), FrameForce<2>::of(c, 0, 0), material, position, T, volume};
  EXPECT_NEAR(swollen.on(2)[1], 3000 * 0.2 * 10, 1e-10);
}

/// In a frame that turns, warm fluid is driven to the axis: by -rho beta (T - T_r) omega^2 r.
TEST(Buoyancy, FollowsTheGravityThatTheFrameSees) {
  Case c;
  c.dimensions = 2;
  c.gravity = {};
  c.heat.emplace().ambient = 300;
  c.materials = {Material{.name = "oil", .density = 1000, .thermalExpansion = 1e-3}};
  FrameForce<2> frame;
  frame.turns = true, frame.spin = {0, 0, 20};
  const std::uint8_t material[] = {0};
  const Vec<2> position[] = {{0.1, 0}};
  const double T[] = {310};
  const Buoyancy<2> buoyancy{ExpansionTable::make(c), frame, material, position, T};
  EXPECT_NEAR(buoyancy.on(0)[0], -1000 * 1e-3 * 10 * 400 * 0.1, 1e-9);
}

/// The energy that buoyancy gives is in the balance.
template <int D>
void checkBuoyantEnergy(SchemeKind scheme) {
  LoadedWalls<D> start(WallsMove::Apart, 1, scheme);
  start.c.heat.emplace();
  for (Material& m : start.c.materials) m.specificHeat = 3, m.conductivity = 0.5;
  start.c.materials[0].thermalExpansion = 0.2;
  start.c.bodies[0].temperature = 310;
  start.particles.has.temperatures = true;
  start.particles.temperature.resize(start.particles.fluidCount);
  for (std::uint32_t i = 0; i < start.particles.fluidCount; ++i)
    start.particles.temperature[i] = 300 + 5e3 * start.particles.position[i][D - 1];
  Simulation<D> s = start.template simulation<Cpu>();
  for (int k = 0; k < 3; ++k) {
    const Diagnostics before = s.diagnostics();
    const StepReport report = s.advance();
    const StepEnergy energy(before, report);
    EXPECT_NEAR(energy.gained + energy.lost, energy.given, 5e-12 * energy.scale());
    EXPECT_GT(std::abs(report.timeStep * report.balance->buoyancyPower), 1e-4 * energy.scale());
  }
}

TEST(BuoyancySteps, BalanceTheirEnergy) {
  for (const SchemeKind scheme : bothSchemes) {
    checkBuoyantEnergy<2>(scheme);
    checkBuoyantEnergy<3>(scheme);
  }
}

/// The root-mean-square speed of a layered fluid after some steps, in parts of the velocity that the difference of
/// weights gives in that time to what falls freely.
double speedOfLayers(double warmingUpwards) {
  const std::string cavity = std::string(TREACLE_CASES) + "/../tests/validation/cases/heated-cavity.toml";
  const std::vector<std::string> overrides = {
      "\"warm side\".temperature=0",
      "\"cold side\".temperature=0",
      "gravity.acceleration=[0, -88]",
      "fluid.bulk_modulus=4e5",
      "time.step=5e-4",
      "filling.temperature='300 + " + std::to_string(warmingUpwards) + " * (y - 0.01) + 2 * cos(pi * x / 0.02)'"};
  Case c = readCase(cavity, overrides);
  std::vector<std::string> notes;
  Simulation<2> s(c, createParticles<2>(c, notes));
  constexpr int steps = 200;
  for (int k = 0; k < steps; ++k) s.advance();
  double squares = 0;
  for (std::uint32_t i = 0; i < s.particles().fluidCount; ++i) squares += norm2(s.particles().velocity[i]);
  return std::sqrt(squares / s.particles().fluidCount) / (88 * 0.02 * 2 * steps * c.time.step);
}

/// Warm fluid above cold fluid rests: what disturbs it comes to its level. Below, it turns the fluid over.
TEST(BuoyancySteps, KeepLayersOfWhichTheLightestIsAboveAtRest) {
  const double stable = speedOfLayers(5000), unstable = speedOfLayers(-5000);
  EXPECT_LT(stable, 0.02);  // 0.011
  EXPECT_GT(unstable, 50 * stable);
}

}  // namespace
}  // namespace treacle::test
