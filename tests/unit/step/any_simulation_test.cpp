#include "treacle/step/run/any_simulation.hpp"
#include "support/state_of.hpp"

#include "treacle/core/error.hpp"
#include "treacle/model/case/case_error.hpp"
#include "treacle/model/particles/create.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace treacle::test {
namespace {

/// A block of syrup in free fall.
Case fallingBlock(int dimensions) {
  Case c;
  c.dimensions = dimensions;
  c.spacing = 1e-3;
  c.domain = {{-0.02, -0.02, dimensions == 3 ? -0.02 : 0}, {0.03, 0.03, dimensions == 3 ? 0.03 : 0}, {}};
  c.gravity = {1, -10, 0};
  c.materials = {{"syrup", 1000, 10, 1e4, 1e6}};
  c.time = {1e-3, 5e-3};
  Body block;
  block.name = "block";
  block.shape.max = {0.01, 0.006, dimensions == 3 ? 0.005 : 0};
  c.bodies = {block};
  return c;
}

AnyParticles anyParticlesOf(const Case& c) {
  std::vector<std::string> notes;
  return createParticles(c, notes);
}

template <int D>
void expectSameSteps() {
  const Case c = fallingBlock(D);
  AnySimulation any(c, anyParticlesOf(c));
  std::vector<std::string> notes;
  Simulation<D> simulation(c, createParticles<D>(c, notes));
  EXPECT_EQ(any.numbers(), anyParticlesOf(c).numbers());
  for (int k = 0; k < 3; ++k) {
    const StepReport a = any.advance(), b = simulation.advance();
    EXPECT_EQ(a.iterations, b.iterations);
    EXPECT_EQ(a.residual, b.residual);
    EXPECT_EQ(a.diagnostics.kineticEnergy, b.diagnostics.kineticEnergy);
  }
  EXPECT_EQ(any.step(), simulation.step());
  EXPECT_EQ(any.time(), simulation.time());
  EXPECT_EQ(any.bytes(), simulation.bytes());
  AnyParticles copied(5 - D);  // of other dimensions
  any.copyParticles(copied);
  const Particles<D>& p = copied.of<D>();
  EXPECT_TRUE(std::ranges::equal(p.position.span(), stateOf(simulation).position.span()));
  EXPECT_TRUE(std::ranges::equal(p.velocity.span(), stateOf(simulation).velocity.span()));
  // From where it is, as after an interruption.
  AnySimulation resumed(c, std::move(copied), BackendKind::Cpu, any.step(), any.time());
  EXPECT_EQ(resumed.advance().residual, simulation.advance().residual);
  EXPECT_EQ(resumed.step(), 4);
  EXPECT_EQ(resumed.time(), simulation.time());
}

TEST(AnySimulation, StepsLikeTheSimulationThatItChose) {
  expectSameSteps<2>();
  expectSameSteps<3>();
}

/// All particles fall alike: what is given them stays on top of what gravity adds.
TEST(AnySimulation, GivenVelocitiesAndPositionsAreGoneOnFrom) {
  const Case c = fallingBlock(2);
  AnySimulation simulation(c, anyParticlesOf(c));
  simulation.advance();
  const FieldMemory x = simulation.field(FluidField::Position);
  ASSERT_EQ(x.components, 2);
  std::vector<double> place(2 * x.count), speed(2 * x.count, 0.5);
  simulation.copyField(FluidField::Position, place.data());
  for (std::size_t i = 0; i < x.count; ++i) place[2 * i] += 0.01;
  simulation.giveFluid({place, speed, {}});
  const StepReport report = simulation.advance();
  // An implicit step: u = 0.5 + g dt, and x follows by u dt.
  EXPECT_NEAR(report.diagnostics.maxSpeed, std::hypot(0.501, 0.49), 1e-6);
  EXPECT_NEAR(report.diagnostics.frontX, *std::ranges::max_element(place) + 0.501e-3, 1e-8);
}

TEST(AnySimulation, RefusesToGiveTheFluidWhatCannotBe) {
  const Case c = fallingBlock(2);
  AnySimulation simulation(c, anyParticlesOf(c));
  const std::size_t n = simulation.field(FluidField::Velocity).count;
  const std::vector<double> outside(2 * n, 1.0), few(2, 0.0), endless(2 * n, HUGE_VAL), warm(n, 300.0);
  EXPECT_THROW(simulation.giveFluid({outside, {}, {}}), InputError);
  EXPECT_THROW(simulation.giveFluid({{}, few, {}}), InputError);
  EXPECT_THROW(simulation.giveFluid({{}, endless, {}}), InputError);
  EXPECT_THROW(simulation.giveFluid({{}, {}, warm}), InputError);
  EXPECT_EQ(simulation.field(FluidField::Temperature).data, nullptr);
  EXPECT_EQ(simulation.advance().step, 1);
}

TEST(AnySimulation, RefusesWhatItCannotRun) {
  const Case c = fallingBlock(2);
  EXPECT_THROW(AnySimulation(c, AnyParticles(3)), InputError);
  Case bad = c;
  bad.time.step = 0;
  EXPECT_THROW(AnySimulation(bad, anyParticlesOf(c)), CaseError);
  if (!cudaCompiled) {
    EXPECT_THROW(AnySimulation(c, anyParticlesOf(c), BackendKind::Cuda), InputError);
  }
}

}  // namespace
}  // namespace treacle::test
