#include "treacle/step/run/step_control.hpp"

#include "treacle/model/case/case.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

namespace treacle::test {
namespace {

constexpr double spacing = 1e-3;  // [m]

Case automaticCase(double tolerance, double longest, double end) {
  Case c;
  c.spacing = spacing;
  c.time.automatic = true;
  c.time.tolerance = tolerance;
  c.time.step = longest;
  c.time.least = 1e-6 * longest;
  c.time.end = end;
  c.time.courant = 100;
  return c;
}

/// A particle on a line, moved as MPH-I moves one: by the velocity at the end of a step that `velocity` makes of
/// place and velocity at its start.
struct Particle {
  double x = 0, u = 0;  // [m], [m/s]
};
using Velocity = std::function<double(const Particle&, double step)>;

/// Where inertia counts for nothing the velocity follows from the place: x' = 1e-4 / x, x = sqrt(x0^2 + 2e-4 t).
double creeping(const Particle& p, double) { return 1e-4 / p.x; }
double creptTo(double t) { return std::sqrt(1e-4 + 2e-4 * t); }

/// Where it does: u' = (0.1 - u) / 0.02, u = 0.1 (1 - exp(-t / 0.02)).
constexpr double steady = 0.1, delay = 0.02;  // [m/s], [s]
double relaxing(const Particle& p, double step) { return (p.u + step / delay * steady) / (1 + step / delay); }
double relaxedWay(double t) { return steady * (t - delay * (1 - std::exp(-t / delay))); }

StepChange changeOf(double before, double after) { return {std::abs(after), std::abs(after - before)}; }

struct Way {
  std::vector<double> times{0}, places;  // at the start and after each step [s], [m]
  std::vector<double> steps{};           // [s]
  int rejected = 0;

  /// Largest error of the way so far, as a part of it, at any time; and that at the end.
  double largestError(const std::function<double(double)>& exact) const {
    double largest = 0;
    for (std::size_t k = 1; k < times.size(); ++k) largest = std::max(largest, errorAt(k, exact));
    return largest;
  }
  double lastError(const std::function<double(double)>& exact) const { return errorAt(times.size() - 1, exact); }

 private:
  double errorAt(std::size_t k, const std::function<double(double)>& exact) const {
    const double right = exact(times[k]);
    return std::abs(places[k] - right) / (right - places[0]);
  }
};

/// By automatic steps to the end of the case.
Way follow(const Case& c, Particle p, const Velocity& velocity) {
  const StepControl control(c);
  StepMemory memory;
  Way way{.places = {p.x}};
  while (!c.atEnd(0, way.times.back())) {
    const StepControl::Step step = control.next(memory, way.times.back(), std::abs(p.u));
    const double u = velocity(p, step.length);
    if (!control.accept(step.length, control.error(changeOf(p.u, u), step.length, memory), 0, memory)) {
      ++way.rejected;
      continue;
    }
    p = {p.x + step.length * u, u};
    way.times.push_back(step.end);
    way.places.push_back(p.x);
    way.steps.push_back(step.length);
  }
  return way;
}

/// What a step makes of the place, less what is right, over half of the change of the velocity times the step.
double localErrorRatio(const Particle& p, double exactPlace, const Velocity& velocity, double step) {
  const double u = velocity(p, step);
  return (p.x + step * u - exactPlace) / (0.5 * step * std::abs(u - p.u));
}

TEST(StepControl, EstimatesTheErrorThatAStepAddsToPositions) {
  for (const double step : {1e-3, 1e-4}) {
    // Of a creeping particle that has come here by such a step: it is ahead, since it is being slowed down.
    Particle p{0.01, 0};
    const double before = std::sqrt(p.x * p.x - 2e-4 * step);
    p.u = 1e-4 / before;
    EXPECT_NEAR(localErrorRatio(p, std::sqrt(p.x * p.x + 2e-4 * step), creeping, step), 1, 20 * step);
    // Of one that gathers speed: implicit, so that it is ahead, too.
    const double t = 0.01;
    const Particle q{relaxedWay(t), steady * (1 - std::exp(-t / delay))};
    EXPECT_NEAR(localErrorRatio(q, relaxedWay(t + step), relaxing, step), 1, 40 * step);
  }
}

TEST(StepControl, ErrorIsProportionalToTheStep) {
  const StepControl control(automaticCase(0.02, 1, 1));
  // Far beyond a spacing, a part of the way; near by, the root of a part of a spacing.
  for (const double speed : {10.0, 1e-3}) {
    const auto error = [&](double step) { return control.error({speed, 0.1 * step}, step, {.last = step}); };
    EXPECT_NEAR(error(2e-3) / error(1e-3), 2, 1e-12);
  }
  EXPECT_DOUBLE_EQ(control.error({10, 1}, 1, {}), 0.05);
  EXPECT_DOUBLE_EQ(control.error({10, 1}, 1, {.last = 3}), 0.025) << "changed over both steps";
  EXPECT_DOUBLE_EQ(control.error({1, 1}, 1e-5, {}), std::sqrt(1e-5 / (2 * spacing)));
  EXPECT_EQ(control.error({}, 1, {}), 0);
}

TEST(StepControl, ErrorsOfWaysAreInProportionToTheTolerance) {
  struct Flow {
    Particle start;
    Velocity velocity;
    std::function<double(double)> exact;
    double end;  // [s]
  };
  const Flow flows[] = {{{0.01, 0.01}, creeping, creptTo, 20}, {{0, 0}, relaxing, relaxedWay, 0.03}};
  for (const Flow& flow : flows) {
    double last = 0, lastSteps = 0;
    for (const double tolerance : {0.04, 0.02, 0.01, 0.005}) {
      const Way way = follow(automaticCase(tolerance, flow.end, flow.end), flow.start, flow.velocity);
      const double error = way.lastError(flow.exact);
      const auto steps = static_cast<double>(way.steps.size());
      EXPECT_LT(error, tolerance);  // measured: 0.37 to 0.5 of it
      EXPECT_LE(way.rejected, 3);
      if (last > 0) {
        EXPECT_NEAR(std::log2(last / error), 1, 0.25) << tolerance;  // measured: 0.79 to 0.96
        EXPECT_NEAR(std::log2(steps / lastSteps), 1, 0.25) << tolerance;
      }
      last = error, lastSteps = steps;
    }
  }
}

/// Equal steps are too long at first, where the flow is fast.
TEST(StepControl, KeepsTheErrorBelowTheToleranceAtAllTimes) {
  const double end = 20;
  const Way way = follow(automaticCase(0.01, end, end), {0.01, 0.01}, creeping);
  EXPECT_LT(way.largestError(creptTo), 0.01);
  EXPECT_GT(way.steps.back(), 30 * way.steps.front());
  Way equal{.places = {0.01}};
  const auto count = static_cast<double>(way.steps.size());
  while (equal.times.back() < end) {
    equal.places.push_back(equal.places.back() + end / count * creeping({equal.places.back(), 0}, 0));
    equal.times.push_back(equal.times.back() + end / count);
  }
  EXPECT_GT(equal.largestError(creptTo), 5 * way.largestError(creptTo));
}

TEST(StepControl, StartsFromRestByTheSpacing) {
  const double g = 10, tolerance = 0.02;
  const Way way = follow(automaticCase(tolerance, 0.1, 0.1), {},
                         [&](const Particle& p, double step) { return p.u + g * step; });
  const double expected = tolerance * std::sqrt(2 * spacing / g);
  EXPECT_LE(way.steps.front(), expected);
  EXPECT_GT(way.steps.front(), 0.6 * expected);
  EXPECT_LE(way.rejected, 4);
}

TEST(StepControl, GrowsAtMostTwofoldAndStaysWhereItIsWhereNothingChanges) {
  const Case c = automaticCase(0.02, 1, 1000);
  const StepControl control(c);
  StepMemory memory{.last = 1e-3, .planned = 1.0 / 1024, .rate = 1e-9};
  for (double longest = 1.0 / 1024; longest < 1;) {
    ASSERT_TRUE(control.accept(memory.planned, 0, 0, memory));
    ASSERT_EQ(memory.planned, 2 * longest);
    longest = memory.planned;
  }
  // A rate that fits a step of a quarter: little more or less than that changes nothing.
  memory = {.last = 0.25, .planned = 0.25, .rate = 0.017 / 0.25};
  for (const double factor : {1.0, 1 + 1e-12, 0.97, 1.03, 1 - 1e-12}) {
    ASSERT_TRUE(control.accept(0.25, 0.017 * factor, 0, memory));
    EXPECT_EQ(memory.planned, 0.25);
  }
  ASSERT_FALSE(control.accept(0.25, 0.0201, 0, memory));
  EXPECT_LT(memory.planned, 0.25);
  EXPECT_GT(memory.planned, 0.15);
}

TEST(StepControl, MeetsFramesAndTheEndExactlyByEqualSteps) {
  Case c = automaticCase(0.02, 0.03, 0.35);
  c.output.interval = 0.1;
  const StepControl control(c);
  const StepMemory memory;
  std::vector<double> times{0}, steps;
  while (!c.atEnd(0, times.back())) {
    const StepControl::Step step = control.next(memory, times.back(), 0);
    EXPECT_NEAR(step.end - times.back(), step.length, 1e-16);
    EXPECT_LE(step.length, 0.03);
    times.push_back(step.end);
    steps.push_back(step.length);
  }
  ASSERT_EQ(steps.size(), 14u);  // 4 of 25 ms to each frame, 2 to the end
  for (const double step : steps) EXPECT_NEAR(step, 0.025, 1e-15);
  for (int k = 1; k <= 3; ++k) EXPECT_EQ(times[4 * k], k * 0.1);
  EXPECT_EQ(times.back(), 0.35);
  EXPECT_EQ(control.next(memory, 0.4, 0).length, 0.03) << "beyond the end";
}

TEST(StepControl, KeepsToWhatPressedParticlesBear) {
  const StepControl control(automaticCase(0.02, 1, 1000));
  StepMemory memory{.last = 0.25, .planned = 0.25, .rate = 1e-9};
  ASSERT_TRUE(control.accept(0.25, 0, 2, memory));
  EXPECT_EQ(memory.planned, 0.0625) << "half of what they bear";
  ASSERT_TRUE(control.accept(0.0625, 0, 0.5, memory));
  EXPECT_EQ(memory.planned, 0.0625);
  ASSERT_TRUE(control.accept(0.0625, 0, 0.125, memory));
  EXPECT_EQ(memory.planned, 0.125);
  EXPECT_FALSE(control.flows(0.9e-3 * spacing / 0.1, 0.1));
  EXPECT_TRUE(control.flows(1.1e-3 * spacing / 0.1, 0.1));
}

TEST(StepControl, KeepsToItsBounds) {
  Case c = automaticCase(0.02, 0.1, 10);
  c.time.least = 0.01;
  c.time.courant = 0.5;
  const StepControl control(c);
  StepMemory memory;
  EXPECT_DOUBLE_EQ(control.next(memory, 0, 5e-4).length, 0.02 * spacing / 5e-4) << "the first one";
  memory.last = 0.1;
  EXPECT_DOUBLE_EQ(control.next(memory, 0, 0.02).length, 0.5 * spacing / 0.02);
  EXPECT_NEAR(control.next(memory, 0, 1).length, 0.01, 1e-12) << "not shorter than the least";
  EXPECT_TRUE(control.accept(0.01, 1, 0, memory)) << "nothing shorter is to be had";
  EXPECT_EQ(memory.planned, 0.01);
  EXPECT_FALSE(control.shorten(0.01, memory));
  EXPECT_TRUE(control.shorten(0.1, memory));
  EXPECT_LE(memory.planned, 0.025);
  EXPECT_GE(memory.planned, 0.01);
  memory = {.last = 0.025};  // of steps that were not automatic
  EXPECT_EQ(control.next(memory, 0, 0).length, 0.025);
  memory.planned = 1e9;  // of another run
  EXPECT_EQ(control.next(memory, 0, 0).length, 0.1);
}

TEST(stepChange, isTheRootMeanSquareOverTheFluid) {
  const std::vector<Vec<2>> before{{0, 0}, {3, 4}}, after{{1, 0}, {3, 5}};
  Context<Cpu> context;
  const StepChange d = stepChange<2>(context, {before, after});
  EXPECT_DOUBLE_EQ(d.speed, std::sqrt((1 + 34) / 2.0));
  EXPECT_DOUBLE_EQ(d.change, 1);
  EXPECT_EQ(stepChange<2>(context, {}).change, 0);
  EXPECT_EQ(stepChange<2>(context, {}).speed, 0);
}

}  // namespace
}  // namespace treacle::test
