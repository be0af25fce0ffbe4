#include "support/scene.hpp"
#include "support/state_of.hpp"
#include "treacle/core/error.hpp"
#include "treacle/step/run/simulation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <omp.h>

#include <vector>

namespace treacle::test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// A lattice of fluid that starts to fall onto a floor.
Scene<2> fallingScene() {
  Scene<2> s = makeScene<2>({.jitter = 0.02});
  s.c.gravity[1] = -10;
  for (auto& u : s.particles.velocity) u = {};
  TimeSettings& t = s.c.time;
  t.automatic = true;
  t.step = 4e-3, t.least = 1e-6, t.end = 0.05;
  t.tolerance = 0.02;
  s.c.output.interval = 0.01;
  return s;
}

std::vector<Vec<2>> positions(const Particles<2>& p) {
  std::vector<Vec<2>> byId(p.count);
  for (std::uint32_t i = 0; i < p.count; ++i) byId[p.id[i]] = p.position[i];
  return byId;
}

struct Motion {
  std::vector<double> times;
  std::vector<Vec<2>> positions;
  int rejected = 0;
};

Motion runToEnd(Simulation<2>& simulation, const Case& c) {
  Motion run;
  while (!c.atEnd(simulation.step(), simulation.time())) {
    const StepReport report = simulation.advance();
    EXPECT_LE(report.error, c.time.tolerance);
    EXPECT_GT(report.error, 0);
    run.times.push_back(report.time);
    run.rejected += report.rejected;
  }
  run.positions = positions(stateOf(simulation));
  return run;
}

TEST(AutomaticSteps, GrowFromRestAndMeetTheFrames) {
  Scene<2> s = fallingScene();
  Simulation<2> simulation(s.c, std::move(s.particles));
  const Motion run = runToEnd(simulation, s.c);
  EXPECT_GT(run.rejected, 0) << "the first one tried is the longest";
  EXPECT_LT(run.times[0], 1e-3);
  for (int k = 1; k < 5; ++k) EXPECT_THAT(run.times, testing::Contains(k * 0.01));
  EXPECT_EQ(run.times.back(), 0.05);
}

TEST(AutomaticSteps, DoNotDependOnTheNumberOfThreads) {
  std::vector<Motion> runs;
  const int before = omp_get_max_threads();
  for (const int threads : {1, 3}) {
    omp_set_num_threads(threads);
    Scene<2> s = fallingScene();
    Simulation<2> simulation(s.c, std::move(s.particles));
    runs.push_back(runToEnd(simulation, s.c));
  }
  omp_set_num_threads(before);
  EXPECT_EQ(runs[0].times, runs[1].times);
  EXPECT_EQ(runs[0].positions, runs[1].positions);
}

TEST(AutomaticSteps, GoOnFromACopyAsWithoutIt) {
  Scene<2> s = fallingScene();
  Simulation<2> simulation(s.c, std::move(s.particles));
  for (int k = 0; k < 7; ++k) simulation.advance();
  Particles<2> copy;
  simulation.copyParticles(copy);
  EXPECT_EQ(copy.steps, simulation.particles().steps);
  EXPECT_GT(copy.steps.last, 0);
  EXPECT_GT(copy.steps.planned, 0);
  EXPECT_GT(copy.steps.rate, 0);
  Simulation<2> other(s.c, std::move(copy), simulation.step(), simulation.time());
  const Motion a = runToEnd(simulation, s.c), b = runToEnd(other, s.c);
  EXPECT_EQ(a.times, b.times);
  EXPECT_EQ(a.positions, b.positions);
}

/// A step that was rejected has left nothing behind but in the solver, to whose tolerance results are the same.
TEST(AutomaticSteps, AreThoseOfTheirLengthWhateverWasTriedBefore) {
  Scene<2> s = fallingScene(), fixed = fallingScene();
  s.c.solver.tolerance = fixed.c.solver.tolerance = 1e-20;
  Simulation<2> simulation(s.c, std::move(s.particles));
  const StepReport report = simulation.advance();
  ASSERT_GT(report.rejected, 0);
  fixed.c.time = {report.timeStep, 1};
  Simulation<2> same(fixed.c, std::move(fixed.particles));
  EXPECT_EQ(same.advance().rejected, 0);
  const auto a = positions(stateOf(simulation)), b = positions(stateOf(same));
  for (std::size_t i = 0; i < a.size(); ++i) ASSERT_LT(norm(a[i] - b[i]), 1e-12);
}

/// Without a preconditioner long steps need more iterations than short ones.
TEST(AutomaticSteps, AreTakenShorterWhereTheSolverFails) {
  Scene<2> s = fallingScene();
  s.c.time.tolerance = 0.5;
  s.c.solver.preconditioner = PreconditionerKind::None;
  s.c.solver.krylov = KrylovKind::Cr;
  s.c.solver.maxIterations = 60;
  Simulation<2> simulation(s.c, std::move(s.particles));
  const StepReport report = simulation.advance();
  EXPECT_GT(report.rejected, 0);
  EXPECT_LT(report.timeStep, 4e-3 / 4 * (1 + 1e-9));
  EXPECT_LT(report.error, 0.1) << "it is not the tolerance that made it short";

  Scene<2> hopeless = fallingScene();
  hopeless.c.solver = s.c.solver;
  hopeless.c.solver.maxIterations = 1;
  Simulation<2> fails(hopeless.c, std::move(hopeless.particles));
  EXPECT_THROW(fails.advance(), RunError);
  EXPECT_EQ(fails.step(), 0);
}

TEST(AutomaticSteps, WarnOnceWhereTheyMayNotBeAsShortAsTheyShould) {
  Scene<2> s = fallingScene();
  s.c.time.least = s.c.time.step;
  s.c.time.tolerance = 1e-6;
  Simulation<2> simulation(s.c, std::move(s.particles));
  EXPECT_THAT(simulation.advance().warnings,
              ElementsAre(AllOf(HasSubstr("but the step cannot be shorter: time.min_step is "),
                                Not(HasSubstr("by default")))));
  EXPECT_THAT(simulation.advance().warnings, IsEmpty());

  Scene<2> open = fallingScene();
  open.c.time.least = open.c.time.step / 1e4;
  open.c.time.tolerance = 1e-12;
  Simulation<2> byDefault(open.c, std::move(open.particles));
  EXPECT_THAT(byDefault.advance().warnings, ElementsAre(HasSubstr(", by default a 10,000th of max_step = ")));
}

}  // namespace
}  // namespace treacle::test
