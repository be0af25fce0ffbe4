#include "support/loaded_walls.hpp"
#include "support/same_bits.hpp"
#include "support/state_of.hpp"
#include "treacle/io/case/case_reader.hpp"
#include "treacle/model/particles/create.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

namespace treacle::test {
namespace {

Rheology grease() {
  return {.model = RheologyModel::Bingham, .yieldStress = 20, .plasticViscosity = 5, .regularisation = 20};
}

/// The 2D dam break of another fluid.
Case damBreak(const Rheology& rheology) {
  Case c = readCase(std::string(TREACLE_CASES) + "/dam-break-2d.toml");
  c.materials[0].rheology = rheology;
  c.materials[0].dynamicViscosity = 0;
  return c;
}

/// The same of a Newtonian one.
Case newtonianDamBreak(double viscosity) {
  Case c = damBreak({});
  c.materials[0].rheology.reset();
  c.materials[0].dynamicViscosity = viscosity;
  return c;
}

Particles<2> particlesOf(const Case& c) {
  std::vector<std::string> notes;
  return createParticles<2>(c, notes);
}

Particles<2> stateAfter(const Case& c, int steps, int* iterations = nullptr) {
  Simulation<2> s(c, particlesOf(c));
  for (int k = 0; k < steps; ++k) {
    const StepReport report = s.advance();
    EXPECT_EQ(report.fallbacks, 0) << "step " << k;
    if (iterations) *iterations = std::max(*iterations, report.iterations);
  }
  Particles<2> state;
  s.copyParticles(state);
  return state;
}

double difference(const Particles<2>& a, const Particles<2>& b) {
  std::vector<Vec<2>> u(a.count);
  for (std::uint32_t i = 0; i < a.count; ++i) u[a.id[i]] = a.velocity[i];
  double most = 0, speed = 0;
  for (std::uint32_t i = 0; i < b.count; ++i) {
    most = std::max(most, norm(b.velocity[i] - u[b.id[i]]));
    speed = std::max(speed, norm(b.velocity[i]));
  }
  return most / speed;
}

TEST(RheologySteps, OfAFluidThatIsNewtonianAreItsSteps) {
  Case newtonian = newtonianDamBreak(10);
  newtonian.solver.tolerance = 1e-22;
  Case powerLaw = newtonian;
  powerLaw.materials[0].dynamicViscosity = 0;
  powerLaw.materials[0].rheology = Rheology{.model = RheologyModel::PowerLaw, .consistency = 10, .flowIndex = 1};
  const Particles<2> a = stateAfter(newtonian, 10), b = stateAfter(powerLaw, 10);
  EXPECT_LT(difference(a, b), 1e-8);  // measured: 2e-10
  EXPECT_TRUE(a.shearRate.empty());
  EXPECT_EQ(b.shearRate.size(), b.fluidCount);
  EXPECT_GT(*std::max_element(b.shearRate.begin(), b.shearRate.end()), 1);
}

template <int D>
void checkEnergy(SchemeKind scheme) {
  LoadedWalls<D> start(WallsMove::Apart, 1, scheme);
  start.c.materials[0].rheology = grease();
  start.c.materials[0].dynamicViscosity = 0;
  Simulation<D> s = start.template simulation<Cpu>();
  for (int k = 0; k < 3; ++k) {
    const Diagnostics before = s.diagnostics();
    const StepEnergy energy(before, s.advance());
    EXPECT_NEAR(energy.gained + energy.lost, energy.given, 5e-12 * energy.scale());
  }
}

/// Two materials of which one is a Bingham fluid, between walls that move.
TEST(RheologySteps, CloseTheEnergyBalance) {
  for (const SchemeKind scheme : bothSchemes) {
    checkEnergy<2>(scheme);
    checkEnergy<3>(scheme);
  }
}

TEST(RheologySteps, ContinueFromACopyWithTheSameBits) {
  const Case c = damBreak(grease());
  Simulation<2> whole(c, particlesOf(c));
  for (int k = 0; k < 5; ++k) whole.advance();
  Particles<2> state = stateOf(whole);
  ASSERT_TRUE(state.has.shearRates);
  Simulation<2> resumed(c, std::move(state), whole.step(), whole.time());
  for (int k = 0; k < 5; ++k) whole.advance(), resumed.advance();
  expectSameBits(stateOf(whole), stateOf(resumed));
}

TEST(RheologySteps, ContinueWithAStateOfAnotherFluid) {
  Case newtonian = newtonianDamBreak(10);
  Particles<2> state = stateAfter(newtonian, 3);
  Simulation<2> other(damBreak(grease()), std::move(state), 3, 3e-3);
  other.advance();
  Particles<2> yielding = stateOf(other);
  ASSERT_TRUE(yielding.has.shearRates);
  EXPECT_GT(*std::max_element(yielding.shearRate.begin(), yielding.shearRate.end()), 0);
  Simulation<2> back(newtonian, std::move(yielding), 4, 4e-3);
  back.advance();
  EXPECT_FALSE(back.particles().has.shearRates);
}

/// A fluid whose particles have twice the viscosity of their material is one of twice the viscosity.
TEST(RheologySteps, HaveTheFactorsOfTheirParticles) {
  Case thick = newtonianDamBreak(20);
  thick.solver.tolerance = 1e-22;
  Case twice = thick;
  twice.materials[0].dynamicViscosity = 10;
  twice.bodies[0].viscosityFactor = 2;
  EXPECT_LT(difference(stateAfter(thick, 10), stateAfter(twice, 10)), 1e-8);
  twice.materials[0].dynamicViscosity = 0;
  twice.materials[0].rheology = grease();
  thick.materials[0].rheology = grease();
  thick.materials[0].dynamicViscosity = 0;
  thick.materials[0].rheology->yieldStress *= 2, thick.materials[0].rheology->plasticViscosity *= 2;
  thick.rheology = twice.rheology = {10, 1e-6};
  EXPECT_LT(difference(stateAfter(thick, 5), stateAfter(twice, 5)), 1e-6);
}

/// Particles keep theirs while others pass them, and a state without them has ones.
TEST(RheologySteps, KeepTheFactorsOfParticles) {
  Case c = newtonianDamBreak(10);
  Particles<2> before = particlesOf(c);
  c.bodies[0].viscosityFactorExpression = "1 + 100*x";
  std::vector<double> given(before.fluidCount);
  for (std::uint32_t i = 0; i < before.fluidCount; ++i) given[before.id[i]] = 1 + 100 * before.position[i][0];
  const Particles<2> after = stateAfter(c, 30);
  for (std::uint32_t i = 0; i < after.fluidCount; ++i) ASSERT_EQ(after.viscosityFactor[i], given[after.id[i]]);
  Simulation<2> from(c, std::move(before));
  from.advance();
  EXPECT_EQ(from.particles().viscosityFactor[0], 1);
  c.bodies[0].viscosityFactorExpression = "x - 1";
  EXPECT_THROW(particlesOf(c), InputError);
}

/// Solves of a step that are repeated come to viscosities that their own shear rates have.
TEST(RheologySteps, SettleWithinAStep) {
  for (const double n : {0.5, 2.0}) {
    Case c = damBreak({.model = RheologyModel::PowerLaw,
                       .consistency = 10,
                       .flowIndex = n,
                       .leastViscosity = 1,
                       .mostViscosity = 1e3});
    c.rheology = {60, 1e-7};
    const Particles<2> exact = stateAfter(c, 3);
    c.rheology = {1, 0.01};
    const double once = difference(exact, stateAfter(c, 3));
    c.rheology = {4, 0};
    EXPECT_LT(difference(exact, stateAfter(c, 3)), 0.3 * once) << n;
    EXPECT_GT(once, 1e-3) << n;
  }
}

/// Once the flow is known the first guess has its viscosities, and one solve of a step is nearly as good as many.
/// With those of the step before it would leave 3e-3 and 3e-4.
TEST(RheologySteps, WantOneSolveInTheLongRun) {
  for (const auto& [n, bound] : {std::pair{0.5, 5e-4}, {2.0, 1e-5}}) {  // measured: 3.4e-4, 5e-6
    Case c = damBreak({.model = RheologyModel::PowerLaw,
                       .consistency = 10,
                       .flowIndex = n,
                       .leastViscosity = 1,
                       .mostViscosity = 1e3});
    c.rheology = {60, 1e-7};
    Simulation<2> exact(c, particlesOf(c));
    for (int k = 0; k < 30; ++k) exact.advance();
    c.rheology.iterations = 1;
    Simulation<2> once(c, stateOf(exact), exact.step(), exact.time());
    for (int k = 0; k < 3; ++k) exact.advance(), once.advance();
    EXPECT_LT(difference(stateOf(exact), stateOf(once)), bound) << n;
  }
}

/// A square whose weight does not reach the yield stress creeps as fast as the regularisation says: its stress is
/// below the yield stress, its rate of the order of 1/m.
TEST(RheologySteps, HoldAPile) {
  for (const double m : {100.0, 1000.0}) {
    Case c = damBreak(
        {.model = RheologyModel::Bingham, .yieldStress = 80, .plasticViscosity = 0.5, .regularisation = m});
    c.time.step = 2e-3;
    c.materials[0].bulkModulus = 1e5;
    const Particles<2> state = stateAfter(c, 250);
    const Rheology& rheology = *c.materials[0].rheology;
    double speed = 0, rate = 0;
    for (std::uint32_t i = 0; i < state.fluidCount; ++i) {
      speed = std::max(speed, norm(state.velocity[i]));
      rate = std::max(rate, state.shearRate[i]);
    }
    EXPECT_LT(rheology.viscosity(rate) * rate, 80) << m;  // measured: 79
    EXPECT_LT(rate * m, 6) << m;                          // measured: 5.1
    EXPECT_LT(speed * m, 0.9 * 20e-3) << m;               // measured: 0.80 of the height
  }
}

/// Viscosities from 1 to 6000 Pa s within a few spacings, measured: at most 18 iterations.
TEST(RheologySteps, OfALargeRangeOfViscositiesTakeFewIterations) {
  Case c = damBreak({.model = RheologyModel::HerschelBulkley,
                     .consistency = 0.5,
                     .flowIndex = 1,
                     .yieldStress = 30,
                     .regularisation = 200});
  c.rheology.iterations = 1;
  int iterations = 0;
  const Particles<2> state = stateAfter(c, 60, &iterations);
  const auto [least, most] = std::minmax_element(state.shearRate.begin(), state.shearRate.end());
  EXPECT_GT(c.materials[0].rheology->viscosity(*least) / c.materials[0].rheology->viscosity(*most), 1000);
  EXPECT_LE(iterations, 30);
}

}  // namespace
}  // namespace treacle::test
