#include "support/isph_cases.hpp"
#include "support/isph_oracle.hpp"
#include "support/state_of.hpp"

#include <gtest/gtest.h>
#include <omp.h>
#include "treacle/core/pseudo_random.hpp"

namespace treacle::test {
namespace {

TEST(IsphRun, TimeStepFollowsTheCourantNumberAndMeetsTheEnd) {
  Case c = tankCase(2, 10, 10);
  c.time = {2e-3, 0.0123, 0.2};
  Simulation<2> simulation(c, [&] {
    Particles<2> p = created<2>(c);
    for (std::uint32_t i = 0; i < p.fluidCount; ++i) p.velocity[i] = {0, 2};
    return p;
  }());
  double speed = 2, time = 0;
  int limited = 0;
  while (!c.atEnd(simulation.step(), simulation.time())) {
    const StepReport report = simulation.advance();
    EXPECT_LE(report.timeStep, c.time.step);
    EXPECT_LE(report.timeStep * speed, 0.2 * c.spacing * (1 + 1e-12));
    limited += std::abs(report.timeStep * speed - 0.2 * c.spacing) < 1e-9 * c.spacing;
    time += report.timeStep;
    EXPECT_DOUBLE_EQ(report.time, time);
    speed = report.diagnostics.maxSpeed;
    ASSERT_LT(simulation.step(), 100);
  }
  EXPECT_GE(limited, 10);
  EXPECT_NEAR(simulation.time(), c.time.end, 1e-15);
}

TEST(IsphRun, ShiftingLeavesTheSurfaceWhereItsVelocityTakesIt) {
  Case c = tankCase(2, 12, 10);
  c.method.scheme = SchemeKind::Published;  // nothing else moves particles off their ways
  c.method.isph.shifting = 0.5;
  Particles<2> start = created<2>(c);
  for (std::uint32_t i = 0; i < start.fluidCount; ++i)
    for (int k = 0; k < 2; ++k) start.position[i][k] += 0.1 * c.spacing * pseudoRandom(2 * i + k);
  const Particles<2> before = copyOf(start);
  const IsphScene<2> s(c, copyOf(start));
  std::vector<bool> surface(start.count);
  for (std::uint32_t i = 0; i < s.n(); ++i) surface[s.particles.id[i]] = s.surface[i];
  Simulation<2> simulation(c, std::move(start));
  simulation.advance();
  const Particles<2>& p = simulation.particles();
  int shifted = 0;
  for (std::uint32_t i = 0; i < p.fluidCount; ++i) {
    const double way = norm(p.position[i] - before.position[p.id[i]] - c.time.step * p.velocity[i]);
    EXPECT_LE(way, 0.1 * c.spacing * (1 + 1e-9));
    EXPECT_TRUE(!surface[p.id[i]] || way <= 1e-15) << way;
    shifted += way > 1e-3 * c.spacing;
  }
  EXPECT_GT(shifted, 50);
}

/// A tank whose water has been stirred.
Particles<2> stirred(const Case& c) {
  Particles<2> p = created<2>(c);
  for (std::uint32_t i = 0; i < p.fluidCount; ++i)
    for (int k = 0; k < 2; ++k) p.velocity[i][k] = 0.1 * pseudoRandom(2 * i + k);
  return p;
}

/// What the twin tests count on: rounding alone does not drive runs apart in a few steps.
TEST(IsphRun, RunsWithUnlikeRoundingStayTogether) {
  Case c = tankCase(2, 24, 20);
  c.solver.tolerance = 1e-24;
  for (Body& body : c.bodies)
    if (body.kind == BodyKind::Wall) body.oscillation = {{0.005, 0, 0}, 0.1, 0.3};
  const auto after = [&](PreconditionerKind preconditioner, Precision precision) {
    c.solver.preconditioner = preconditioner;
    c.solver.precision = precision;
    Particles<2> start = stirred(c);
    for (std::uint32_t i = 0; i < start.fluidCount; ++i)
      for (int k = 0; k < 2; ++k) start.position[i][k] += 0.05 * c.spacing * pseudoRandom(2 * i + k);
    Simulation<2> simulation(c, std::move(start));
    for (int k = 0; k < 20; ++k) simulation.advance();
    const Particles<2> end = stateOf(simulation);
    std::vector<Vec<2>> x(end.count);
    for (std::uint32_t i = 0; i < end.count; ++i) x[end.id[i]] = end.position[i];
    return x;
  };
  using enum PreconditionerKind;
  const auto reference = after(HatMultigrid, Precision::Double);
  const auto apart = [&](const std::vector<Vec<2>>& x) {
    double most = 0;
    for (std::size_t i = 0; i < x.size(); ++i) most = std::max(most, norm(x[i] - reference[i]));
    return most / c.spacing;
  };
  // Measured: 6e-10, 2e-10, 5e-8, mostly by the loose solve of the arrangement.
  EXPECT_LE(apart(after(Jacobi, Precision::Double)), 2e-9);
  EXPECT_LE(apart(after(CellMultigrid, Precision::Double)), 2e-9);
  EXPECT_LE(apart(after(HatMultigrid, Precision::Mixed)), 2e-7);
}

TEST(IsphRun, ResultsDoNotDependOnTheNumberOfThreads) {
  Case c = tankCase(2, 40, 30);  // enough for loops to run in parallel
  for (const double viscosity : {1e-3, 1e3}) {
    c.materials[0].dynamicViscosity = viscosity;
    const auto after = [&](int threads) {
      omp_set_num_threads(threads);
      Simulation<2> simulation(c, stirred(c));
      for (int k = 0; k < 4; ++k) simulation.advance();
      omp_set_num_threads(1);
      return stateOf(simulation);
    };
    EXPECT_TRUE(sameBits(after(1), after(3)));
  }
}

TEST(IsphRun, AContinuedRunGivesTheSameBits) {
  Case c = tankCase(2, 14, 10);
  c.time.courant = 0.1;
  for (Body& body : c.bodies)
    if (body.kind == BodyKind::Wall) body.oscillation = {{0.01, 0, 0}, 0.1, 0.3};
  Simulation<2> whole(c, stirred(c));
  for (int k = 0; k < 8; ++k) whole.advance();
  Simulation<2> first(c, stirred(c));
  for (int k = 0; k < 5; ++k) first.advance();
  Simulation<2> second(c, stateOf(first), first.step(), first.time());
  for (int k = 0; k < 3; ++k) second.advance();
  EXPECT_EQ(second.step(), 8);
  EXPECT_EQ(second.time(), whole.time());
  EXPECT_TRUE(sameBits(stateOf(whole), stateOf(second)));
}

/// With a roof on its fluid.
Case fullTankCase(int dimensions, double width, double depth) {
  Case c = tankCase(dimensions, width, depth);
  Body roof = c.bodies[0];  // a fluid that fills the tank
  roof.name = "roof", roof.kind = BodyKind::Wall;
  roof.shape.min[dimensions - 1] = roof.shape.max[dimensions - 1];
  roof.shape.max[dimensions - 1] += tankWall * c.spacing;
  c.bodies.push_back(roof);
  return c;
}

/// A tank that is full to its roof: nothing says how high the pressure is but that it is not negative.
template <int D>
void checkFullTank(double width, double depth, int steps) {
  const Case c = fullTankCase(D, width, depth);
  Simulation<D> simulation(c, created<D>(c));
  for (int k = 0; k < steps; ++k) {
    const StepReport report = simulation.advance();
    EXPECT_EQ(report.fallbacks, 0) << report.failures;
    EXPECT_LE(report.iterations, 12);
    EXPECT_LE(report.diagnostics.maxSpeed, 0.1 * std::sqrt(2 * 9.81 * depth * c.spacing));
  }
  const Particles<D>& p = simulation.particles();
  EXPECT_EQ(*std::min_element(p.pressure.begin(), p.pressure.begin() + p.fluidCount), 0);
  // In units of that of a layer; the least one stands half a layer below the roof.
  const auto level = [&](std::uint32_t i) {
    return p.pressure[i] / (1000 * 9.81 * c.spacing) + p.position[i][D - 1] / c.spacing;
  };
  const double mean = fluidMean(p, level);
  EXPECT_NEAR(mean, tankCorner + depth - 0.5, 1);
  EXPECT_LE(fluidMean(p, [&](std::uint32_t i) { return std::abs(level(i) - mean); }), 0.05 * depth);
}

TEST(IsphRun, AFullTankHasThePressureOfItsDepth) {
  checkFullTank<2>(12, 10, 100);
  checkFullTank<3>(7, 6, 30);
}

/// The pressure equation is singular in the full ones alone.
TEST(IsphRun, FullTanksStandBesideAnOpenOne) {
  constexpr double width = 12, depth = 10, pitch = width + 3 * tankWall;
  Case c = fullTankCase(2, width, depth);
  const std::vector<Body> full = c.bodies, open = tankCase(2, width, depth - 2).bodies;
  for (const int tank : {1, 2})
    for (Body body : tank == 1 ? open : full) {
      body.name += std::to_string(tank);
      body.shape.min[0] += tank * pitch * c.spacing, body.shape.max[0] += tank * pitch * c.spacing;
      c.bodies.push_back(body);
    }
  c.domain.max[0] += 2 * pitch * c.spacing;
  Simulation<2> simulation(c, created<2>(c));
  for (int k = 0; k < 100; ++k) {
    const StepReport report = simulation.advance();
    EXPECT_EQ(report.fallbacks, 0) << report.failures;
    EXPECT_LE(report.iterations, 14);
    EXPECT_LE(report.diagnostics.maxSpeed, 0.1 * std::sqrt(2 * 9.81 * depth * c.spacing));
  }
  const Particles<2>& p = simulation.particles();
  for (const int tank : {0, 1, 2}) {
    double least = std::numeric_limits<double>::infinity(), sum = 0, square = 0, count = 0;
    for (std::uint32_t i = 0; i < p.fluidCount; ++i) {
      const double x = p.position[i][0] / c.spacing - tankCorner - tank * pitch;
      if (x < 0 || x > width) continue;
      const double level = p.pressure[i] / (1000 * 9.81 * c.spacing) + p.position[i][1] / c.spacing - tankCorner;
      least = std::min(least, p.pressure[i]);
      sum += level, square += level * level, ++count;
    }
    const double mean = sum / count;
    EXPECT_EQ(count, width * (tank == 1 ? depth - 2 : depth));
    EXPECT_LE(least, tank == 1 ? 100 : 0);
    EXPECT_NEAR(mean, tank == 1 ? depth - 2 : depth - 0.5, tank == 1 ? 0.2 : 1) << "tank " << tank;
    EXPECT_LE(std::sqrt(square / count - mean * mean), 0.05 * depth) << "tank " << tank;
  }
}

/// Vortices that fill a periodic square, where only differences of pressures have a meaning.
TEST(IsphRun, PressuresHaveAMeanOfZeroWhereNothingSaysHowHighTheyAre) {
  Case c = waterCase(2, Vec<3>::filled(20));
  c.domain.periodic = {true, true, false};
  c.gravity = {};
  c.method.isph.negativePressure = true;
  Body& vortices = c.bodies.emplace_back();
  vortices.name = "vortices", vortices.kind = BodyKind::Fluid;
  vortices.shape.max = Vec<3>::filled(20 * c.spacing);
  Particles<2> start = created<2>(c);
  const double k = 2 * M_PI / (20 * c.spacing), speed = 0.1;
  for (std::uint32_t i = 0; i < start.fluidCount; ++i) {
    const double x = k * start.position[i][0], y = k * start.position[i][1];
    start.velocity[i] = {speed * std::sin(x) * std::cos(y), -speed * std::cos(x) * std::sin(y)};
  }
  Simulation<2> simulation(c, std::move(start));
  for (int step = 0; step < 10; ++step) {
    const StepReport report = simulation.advance();
    EXPECT_EQ(report.fallbacks, 0) << report.failures;
    EXPECT_LE(report.iterations, 12);
  }
  const Particles<2>& p = simulation.particles();
  const double unit = c.materials[0].density * speed * speed / 4;
  EXPECT_LE(std::abs(fluidMean(p, [&](std::uint32_t i) { return p.pressure[i]; })), 1e-12 * unit);
  // p = rho U^2 / 4 (cos 2kx + cos 2ky)
  const double error = fluidMean(p, [&](std::uint32_t i) {
    const Vec<2> x = p.position[i];
    return std::abs(p.pressure[i] / unit - std::cos(2 * k * x[0]) - std::cos(2 * k * x[1]));
  });
  EXPECT_LE(error, 0.2);
}

TEST(IsphRun, DiagnosticsHoldTheDensities) {
  const Case c = tankCase(2, 16, 12);
  Simulation<2> simulation(c, created<2>(c));
  const IsphScene<2> s(c, created<2>(c));
  const IsphOracle<2> oracle(s);
  double mean = 0, error = 0, interior = 0;
  for (std::uint32_t i = 0; i < s.n(); ++i) {
    mean += oracle.density(i) / s.n();
    if (s.surface[i]) continue;
    error += std::abs(oracle.density(i) - 1);
    ++interior;
  }
  for (const Diagnostics& d : {simulation.diagnostics(), simulation.advance().diagnostics}) {
    EXPECT_NEAR(d.meanDensityRatio, mean, 1e-12);
    EXPECT_NEAR(d.meanDensityError, error / interior, 1e-12);
    EXPECT_EQ(d.interiorParticles, interior);
  }
}

}  // namespace
}  // namespace treacle::test
