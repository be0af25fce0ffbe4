#include "support/same_bits.hpp"
#include "support/state_of.hpp"
#include "support/stretched_body.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace treacle::test {
namespace {

std::vector<int> advance(Simulation<2>& simulation, int steps) {
  std::vector<int> iterations;
  for (int k = 0; k < steps; ++k) iterations.push_back(simulation.advance().iterations);
  return iterations;
}

void expectSameState(const Particles<2>& a, const Particles<2>& b) {
  expectSameBits(a, b);
  EXPECT_EQ(a.modes.pressure, b.modes.pressure);
}

TEST(DeflatedSteps, TakeFewerIterationsToTheSameVelocities) {
  StretchedBody plain, deflated;
  plain.c.solver.tolerance = deflated.c.solver.tolerance = 1e-18;
  Simulation<2> a = plain.start(0), b = deflated.start(8);
  const std::vector<int> before = advance(a, 3);
  EXPECT_EQ(advance(b, 3), before) << "only looked and recorded";
  EXPECT_EQ(a.particles().modeCount(), 0u);
  EXPECT_EQ(b.particles().modeCount(), 8u);
  for (int step = 4; step <= 12; ++step) EXPECT_LE(1.1 * b.advance().iterations, a.advance().iterations) << step;

  const Particles<2> p = stateOf(a), q = stateOf(b);
  std::vector<Vec<2>> u(p.count);
  for (std::uint32_t i = 0; i < p.count; ++i) u[p.id[i]] = p.velocity[i];
  double difference = 0, largest = 0;
  for (std::uint32_t i = 0; i < p.count; ++i) {
    difference = std::max(difference, norm(q.velocity[i] - u[q.id[i]]));
    largest = std::max(largest, norm(q.velocity[i]));
  }
  EXPECT_LT(difference, 5e-8 * largest);  // measured: 8e-9
}

TEST(DeflatedSteps, ContinueFromACopyWithTheSameBits) {
  // In the copy modes are not known, worth taking, and taken.
  for (const int before : {1, 2, 5}) {
    SCOPED_TRACE(before);
    StretchedBody flow;
    Simulation<2> whole = flow.start(8);
    advance(whole, before);
    Simulation<2> resumed(flow.c, stateOf(whole), whole.step(), whole.time());
    EXPECT_EQ(advance(resumed, 4), advance(whole, 4));
    EXPECT_GT(whole.particles().modeCount(), 0u);
    expectSameState(stateOf(resumed), stateOf(whole));
  }
}

TEST(DeflatedSteps, DropModesOfACaseThatHasNone) {
  StretchedBody flow;
  Simulation<2> before = flow.start(8);
  advance(before, 5);
  EXPECT_EQ(before.particles().modeCount(), 8u);
  for (const int most : {0, 3}) {
    flow.c.solver.deflation = most;
    Simulation<2> after(flow.c, stateOf(before), before.step(), before.time());
    advance(after, 1);
    EXPECT_EQ(after.particles().modeCount(), most == 0 ? 0u : 8u);
  }
}

TEST(DeflatedSteps, AFailedStageDropsTheModes) {
  StretchedBody flow;
  Simulation<2> before = flow.start(8);
  advance(before, 5);
  flow.c.solver.projected.iterationBound = 3;
  Simulation<2> after(flow.c, stateOf(before), before.step(), before.time());
  EXPECT_GT(after.advance().fallbacks, 0);
  EXPECT_EQ(after.particles().modeCount(), 0u);
  EXPECT_EQ(after.particles().modes.age, ModeAge{});
}

TEST(KeptEigenvalue, IsKnownForSomeSolvesAndUntilOneTakesLonger) {
  KeptEigenvalue kept;
  EXPECT_FALSE(kept.isKnown());
  kept.solved(5);
  EXPECT_FALSE(kept.isKnown());
  const auto solvesUntilDue = [&](const auto& iterations) {
    kept.estimated(3.5);
    int k = 0;
    for (; kept.isKnown(); ++k) kept.solved(iterations(k));
    return k;
  };
  EXPECT_EQ(solvesUntilDue([](int k) { return 5 + k % 2; }), KeptEigenvalue::longest) << "one more is none";
  EXPECT_EQ(solvesUntilDue([](int k) { return k < 2 ? 5 : 9; }), 3);
  EXPECT_EQ(solvesUntilDue([](int) { return 12; }), 1) << "it grows on";
  EXPECT_EQ(solvesUntilDue([](int) { return 12; }), KeptEigenvalue::longest);
  EXPECT_EQ(solvesUntilDue([](int) { return 5; }), KeptEigenvalue::longest);
  EXPECT_EQ(kept.value, 3.5);
}

TEST(KeptEigenvalue, IsOfTheFirstStepAndNewAfterTen) {
  StretchedBody flow;
  Simulation<2> simulation = flow.start(0);
  advance(simulation, 1);
  const KeptEigenvalue first = simulation.particles().modes.pressure;
  EXPECT_TRUE(first.isKnown());
  EXPECT_EQ(first.due, KeptEigenvalue::longest - 1);
  advance(simulation, 1);
  EXPECT_EQ(simulation.particles().modes.pressure.value, first.value);
  int renewed = 0;
  double value = first.value;
  for (int step = 3; step <= 25; ++step) {
    advance(simulation, 1);
    const KeptEigenvalue& kept = simulation.particles().modes.pressure;
    renewed += kept.value != value;
    EXPECT_NEAR(kept.value, value, 0.05 * value) << "what is estimated with leaves a tenth";
    value = kept.value;
  }
  EXPECT_GE(renewed, 2);
}

TEST(ModeAge, IsDueAtTheSecondSolveAfterManyAndWhenSolvesGrowLonger) {
  ModeAge age;
  EXPECT_FALSE(age.isDue());
  age.solved(12);
  EXPECT_TRUE(age.isDue());
  const auto solvesUntilDue = [&](auto&& iterations) {
    age.taken();
    int solves = 0;
    while (!age.isDue()) age.solved(iterations(solves++));
    return solves;
  };
  EXPECT_EQ(solvesUntilDue([](int) { return 9; }), ModeAge::longest);
  EXPECT_EQ(solvesUntilDue([](int k) { return 5 + k % 2; }), ModeAge::longest) << "one more is none";
  EXPECT_EQ(solvesUntilDue([](int k) { return k < 20 ? 9 : 11; }), 21);
  EXPECT_EQ(solvesUntilDue([](int k) { return k < 2 ? 9 : 11; }), ModeAge::shortest);
}

}  // namespace
}  // namespace treacle::test
