#include "treacle/step/method/first_guess.hpp"

#include "support/scene.hpp"
#include "treacle/step/run/simulation.hpp"

#include <gtest/gtest.h>

namespace treacle::test {
namespace {

constexpr double dt = 1e-3;

/// The guesses for velocities u(t) = u0 + u1 t + u2 t^2 of a few particles, remembered over a few steps.
struct Path {
  Context<Cpu> context;
  std::vector<Vec<2>> acceleration = std::vector<Vec<2>>(3), jerk = acceleration;
  double square;

  explicit Path(double theSquare) : square(theSquare) {}

  FlowMemory<2> memory() { return {acceleration, jerk}; }
  std::vector<Vec<2>> at(double t) const {
    std::vector<Vec<2>> u;
    for (double k : {1.0, -2.0, 0.5})
      u.push_back(Vec<2>{0.1 * k, 0.2} + t * Vec<2>{3 * k, -4} + t * t * square * Vec<2>{k, 1});
    return u;
  }
  void step(int k) { stepTo(k * dt, dt, dt); }
  void stepTo(double t, double length, double lastStep) {
    updateFlowMemory<2>(context, length, lastStep, at(t - length), at(t), memory());
  }
  /// Largest error of the guess for the step to `t` from the velocities at t - length.
  double error(FirstGuess order, double t, double length = dt, double lastStep = dt) {
    std::vector<Vec<2>> guess(3);
    extrapolate<2>(context, Extrapolation<2>::make(order, length, lastStep), at(t - length), memory(), guess);
    const std::vector<Vec<2>> exact = at(t);
    double largest = 0;
    for (std::size_t i = 0; i < 3; ++i) largest = std::max(largest, norm(guess[i] - exact[i]));
    return largest;
  }
};

TEST(FirstGuess, ContinuesPolynomialsOfItsOrder) {
  Path straight(0), curved(1e3);
  for (int k = 1; k <= 3; ++k) straight.step(k), curved.step(k);
  EXPECT_GT(straight.error(FirstGuess::Last, 4 * dt), 4e-3);
  EXPECT_LT(straight.error(FirstGuess::Linear, 4 * dt), 1e-14);
  EXPECT_LT(straight.error(FirstGuess::Quadratic, 4 * dt), 1e-14);
  EXPECT_GT(curved.error(FirstGuess::Linear, 4 * dt), 1e-3);
  EXPECT_LT(curved.error(FirstGuess::Quadratic, 4 * dt), 1e-14);
}

TEST(FirstGuess, IsOfLowerOrderWhileThePastIsShort) {
  Path path(1e3);
  for (const FirstGuess order : {FirstGuess::Linear, FirstGuess::Quadratic})
    EXPECT_EQ(path.error(order, dt), path.error(FirstGuess::Last, dt));
  path.step(1);
  EXPECT_EQ(path.error(FirstGuess::Quadratic, 2 * dt), path.error(FirstGuess::Linear, 2 * dt));
  path.step(2);
  EXPECT_LT(path.error(FirstGuess::Quadratic, 3 * dt), 1e-14);
}

TEST(FirstGuess, FollowsAChangeOfTheTimeStep) {
  Path path(0);
  for (int k = 1; k <= 3; ++k) path.step(k);
  EXPECT_LT(path.error(FirstGuess::Quadratic, 3 * dt + dt / 4, dt / 4), 1e-14);
}

TEST(FirstGuess, ContinuesCurvesOverStepsOfAnyLength) {
  Path path(1e3);
  double t = 0, last = dt;
  for (const double length : {dt, 2 * dt, dt / 3, 1.5 * dt, dt / 5}) {
    t += length;
    if (t > 4 * dt) {
      EXPECT_LT(path.error(FirstGuess::Quadratic, t, length, last), 1e-14) << length;
    }
    path.stepTo(t, length, last);
    last = length;
  }
  // That the coefficients of equal steps are no use is what makes this a test.
  EXPECT_GT(path.error(FirstGuess::Quadratic, t + dt, dt, dt), 1e-5);
}

template <int D>
Scene<D> fallingScene(FirstGuess order, double jitter = 0.2) {
  Scene<D> s = makeScene<D>({.jitter = jitter});
  s.c.gravity[D - 1] = -10;
  s.c.solver.krylov = KrylovKind::Cr;
  s.c.solver.preconditioner = PreconditionerKind::BucketMultigrid;
  s.c.solver.precision = Precision::Double;
  s.c.solver.firstGuess = order;
  return s;
}

template <int D>
std::vector<Vec<D>> byId(const Particles<D>& p, const Buffer<Vec<D>>& field) {
  std::vector<Vec<D>> sorted(1 + *std::ranges::max_element(p.id));
  for (std::uint32_t i = 0; i < field.size(); ++i) sorted[p.id[i]] = field[i];
  return sorted;
}

/// Each particle's memory is that of its own path, wherever the sort puts it.
template <int D>
void checkMemory() {
  Scene<D> s = fallingScene<D>(FirstGuess::Quadratic);
  for (auto* field : {&s.particles.acceleration, &s.particles.jerk})
    for (auto& x : *field) x = Vec<D>::filled(1e30);  // whatever lies there counts for nothing
  Simulation<D> simulation(s.c, std::move(s.particles));
  const Particles<D>& p = simulation.particles();
  const std::vector<std::uint32_t> orderAtStart(p.id.begin(), p.id.end());
  std::vector<Vec<D>> u[4];
  for (int step = 0; step <= 30; ++step) {
    for (int k = 3; k > 0; --k) u[k] = u[k - 1];
    u[0] = byId<D>(p, p.velocity);
    const auto acceleration = byId<D>(p, p.acceleration), jerk = byId<D>(p, p.jerk);
    const double h = s.c.time.step;
    for (std::uint32_t i = 0; i < p.fluidCount; ++i) {
      const std::uint32_t id = p.id[i];
      const Vec<D> change = step < 2 ? Vec<D>{} : u[0][id] - u[1][id];
      const Vec<D> second = step < 3 ? Vec<D>{} : u[0][id] - 2.0 * u[1][id] + u[2][id];
      ASSERT_LE(norm(h * acceleration[id] - change), 1e-14) << "step " << step;
      ASSERT_LE(norm(h * h * jerk[id] - second), 1e-14) << "step " << step;
    }
    simulation.advance();
  }
  EXPECT_NE(orderAtStart, std::vector<std::uint32_t>(p.id.begin(), p.id.end())) << "nothing was sorted";
}

TEST(FirstGuess, MemoryStaysWithItsParticle) {
  checkMemory<2>();
  checkMemory<3>();
}

struct Outcome {
  int iterations = 0;
  std::vector<Vec<2>> position;
};

Outcome run(FirstGuess order, int steps) {
  Scene<2> s = fallingScene<2>(order, 0.02);
  for (auto& u : s.particles.velocity) u = {};
  s.c.solver.tolerance = 1e-14;
  Simulation<2> simulation(s.c, std::move(s.particles));
  Outcome r;
  for (int k = 0; k < steps; ++k) r.iterations += simulation.advance().iterations;
  r.position = byId<2>(simulation.particles(), simulation.particles().position);
  return r;
}

TEST(FirstGuess, TheThirdStepIsTheFirstThatItChanges) {
  for (const FirstGuess order : {FirstGuess::Linear, FirstGuess::Quadratic}) {
    EXPECT_EQ(run(FirstGuess::Last, 2).position, run(order, 2).position);
    EXPECT_NE(run(FirstGuess::Last, 3).position, run(order, 3).position);
  }
}

TEST(FirstGuess, SavesIterationsAndChangesNoResult) {
  constexpr int steps = 40;
  const Outcome last = run(FirstGuess::Last, steps);
  for (const FirstGuess order : {FirstGuess::Linear, FirstGuess::Quadratic}) {
    const Outcome r = run(order, steps);
    EXPECT_LT(r.iterations, 0.9 * last.iterations);
    for (std::size_t i = 0; i < r.position.size(); ++i)
      ASSERT_LT(norm(r.position[i] - last.position[i]), 1e-8);  // [m]; particles are 1 mm apart
  }
}

}  // namespace
}  // namespace treacle::test
