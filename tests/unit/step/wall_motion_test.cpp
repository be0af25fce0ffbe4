#include "treacle/step/walls/wall_motion.hpp"
#include "treacle/core/pseudo_random.hpp"

#include "support/isph_cases.hpp"
#include "support/wall_motions.hpp"

#include <gtest/gtest.h>

namespace treacle::test {
namespace {

const Body shaken = [] {
  Body body;
  body.kind = BodyKind::Wall;
  body.velocity = {0.1, 0, -0.2};
  body.oscillation = {{0.02, -0.01, 0}, 0.5, 0.7};
  return body;
}();

/// Where the body is at time t, from where it started.
Vec<3> displacement(double t) {
  const Oscillation& o = shaken.oscillation;
  return t * shaken.velocity + (std::sin(2 * M_PI * t / o.period + o.phase) - std::sin(o.phase)) * o.amplitude;
}

TEST(WallMotion, VelocityTakesTheWallToItsPlaceAtTheEndOfTheStep) {
  Vec<3> way{};
  double t = 0;
  for (int k = 0; k < 100; ++k) {
    const double dt = 0.01 * (1 + 0.5 * pseudoRandom(k));
    way += dt * wallVelocity(shaken, t, dt);
    t += dt;
    ASSERT_LE(norm(way - displacement(t)), 1e-15 * (k + 10));
  }
}

/// Steps that end where others begin, but for rounding, see a jump there once.
TEST(WallMotion, JumpsOnce) {
  Body body;
  body.kind = BodyKind::Wall;
  body.displacement[1].emplace();
  for (const char* jump : {"t > 0.01 ? 1 : 0", "t > 0.02 ? 1 : 0", "t > 0.0125 ? 1 : 0", "t >= 0.03 ? 1 : 0"}) {
    body.displacement[1]->expression = jump;
    for (const double dt : {1e-3, 7e-4}) {
      double way = 0;
      for (int k = 0; k < 60; ++k) way += dt * wallVelocity(body, k * dt, dt)[1];
      EXPECT_NEAR(way, 1, 1e-12) << jump << ", steps of " << dt;
    }
  }
}

TEST(WallMotion, AccelerationIsThatOfTheDisplacement) {
  const double e = 1e-4;
  for (double t = 0; t < 1; t += 0.037) {
    const Vec<3> a = (1 / (e * e)) * (displacement(t + e) - 2.0 * displacement(t) + displacement(t - e));
    EXPECT_LE(norm(wallAcceleration(shaken, t) - a), 1e-5 * 4 * M_PI * M_PI / 0.25);
  }
}

/// By a formula, by a table, and turned by an angle: whatever the steps are.
TEST(WallMotion, FollowsFunctionsOfTime) {
  Body body = shaken;
  body.displacement = {TimeFunction{0, "0.02*t^2"}, TimeFunction{0, "", {0, 0.3, 0.5}, {0.1, 0.2, 0.2}}, {}};
  body.rotation = Rotation{.center = {0, 0.1, 0}, .axis = {0, 0, 1}, .angle = TimeFunction{0, "sin(2*t)"}};
  Vec<2> way{}, x{0.3, 0.2};
  double t = 0;
  for (int k = 0; k < 100; ++k) {
    const double dt = 0.01 * (1 + 0.5 * pseudoRandom(k));
    way = way + dt * resized<2>(wallVelocity(body, t, dt));
    x = x + dt * wallMotion<2>({}, body, t, dt).chordAt(x);
    t += dt;
    Vec<3> expected = displacement(t);
    expected[0] += 0.02 * t * t, expected[1] += t < 0.3 ? t / 3 : 0.1;
    ASSERT_LE(norm(way - resized<2>(expected)), 1e-14 * (k + 10));
    const double angle = std::sin(2 * t);
    const Vec<2> arm{0.3 * std::cos(angle) - 0.1 * std::sin(angle), 0.3 * std::sin(angle) + 0.1 * std::cos(angle)};
    ASSERT_LE(norm(x - resized<2>(expected) - Vec<2>{0, 0.1} - arm), 1e-13);
    const WallMotion<2> m = wallMotion<2>({}, body, t, 0);
    EXPECT_NEAR(m.spin[2], 2 * std::cos(2 * t), 1e-8);
    EXPECT_NEAR(m.sine, std::sin(angle), 1e-14);
  }
}

TEST(WallMotion, WithoutOscillationIsTheBodysVelocity) {
  Body body = shaken;
  body.oscillation = {};
  EXPECT_EQ(wallVelocity(body, 3, 0.1), body.velocity);
  EXPECT_EQ(wallAcceleration(body, 3), (Vec<3>{}));
}

TEST(WallMotion, EveryWallTakesTheVelocityAndTheChordOfItsBody) {
  Context<Cpu> context;
  const auto motions = randomMotions<2>({{-1, -1}, {1, 1}, {true, false, false}}, 5);
  for (const std::size_t walls : {0, 1, 33, 1000}) {
    std::vector<std::uint8_t> body;
    for (std::size_t i = 0; i < walls; ++i) body.push_back(static_cast<std::uint8_t>(i * i % 5));
    const std::vector<Vec<2>> position = randomVelocities<2>(walls, 3);
    std::vector<Vec<2>> velocity(walls), chord(walls);
    setWallVelocities<2>(context, {motions, body, position}, velocity);
    setWallChords<2>(context, {motions, body, position}, chord);
    for (std::size_t i = 0; i < walls; ++i) {
      ASSERT_LE(norm(velocity[i] - motions[body[i]].velocityAt(position[i])), 1e-13);
      ASSERT_LE(norm(chord[i] - motions[body[i]].chordAt(position[i])), 1e-13);
    }
  }
}

Case shakenTank(double width, double depth, const Oscillation& o) {
  Case c = tankCase(2, width, depth);
  for (Body& body : c.bodies)
    if (body.kind == BodyKind::Wall) body.oscillation = o;
  return c;
}

TEST(WallMotion, WallsOfASimulationAreWhereTheirMotionPutsThem) {
  // With steps of unequal length, for both methods.
  Case c = shakenTank(10, 8, {{0.01, 0.002, 0}, 0.2, 0.4});
  c.bodies[2].oscillation = {};
  c.bodies[2].velocity = {-0.05, 0, 0};
  c.time.courant = 0.1;
  for (const MethodKind method : {MethodKind::Isph, MethodKind::MphI}) {
    c.method.kind = method;
    if (method == MethodKind::MphI) {
      c.materials[0] = {"syrup", 1000, 10, 1e4, 1e5};
      c.solver = {};
    }
    Particles<2> p = created<2>(c);
    const Particles<2> start = copyOf(p);
    for (std::uint32_t i = 0; i < start.count; ++i) ASSERT_EQ(start.id[i], i);
    Simulation<2> simulation(c, std::move(p));
    for (int k = 0; k < 20; ++k) simulation.advance();
    const double t = simulation.time();
    const Particles<2>& now = simulation.particles();
    for (std::uint32_t i = now.fluidCount; i < now.count; ++i) {
      const Oscillation& o = c.bodies[now.body[i]].oscillation;
      Vec<2> way = t * resized<2>(c.bodies[now.body[i]].velocity);
      if (o.period > 0)
        way += (std::sin(2 * M_PI * t / o.period + o.phase) - std::sin(o.phase)) * resized<2>(o.amplitude);
      ASSERT_LE(norm(now.position[i] - start.position[now.id[i]] - way), 1e-14);
    }
  }
}

TEST(WallMotion, WaterInANarrowShakenTankGoesAlong) {
  // Its first mode has a period of sqrt(4 pi w / g) = 0.36 s: shaken slowly, it rides with the tank.
  const Oscillation slow{{0.02, 0, 0}, 1.5, -M_PI / 2};
  const Case c = shakenTank(10, 16, slow);
  Simulation<2> simulation(c, created<2>(c));
  const double start = centreOfMass(simulation.particles())[0];
  const double top = 2 * M_PI / slow.period * slow.amplitude[0];
  double worst = 0, last = 0, mean = 0;
  while (simulation.time() < 0.75 - 1e-9) {
    last = simulation.time();
    simulation.advance();
    const double wall = wallVelocity(c.bodies[1], last, c.time.step)[0];
    worst = std::max(worst, std::abs(meanVelocity(simulation.particles())[0] - wall) / top);
    mean += wall * c.time.step;
  }
  EXPECT_NEAR(mean, 0.04, 1e-12) << "from end to end";
  // Measured: 0.026 of the spacing, 0.060.
  EXPECT_NEAR(centreOfMass(simulation.particles())[0] - start, 0.04, 0.04 * c.spacing);
  EXPECT_LT(worst, 0.075);
}

TEST(WallMotion, AcceleratedTanksHoldTheirWaterByPressure) {
  // In a tank that accelerates evenly, say falls with g, water does not feel its weight.
  Case c = shakenTank(12, 10, {});
  const double period = 4;
  for (Body& body : c.bodies)
    if (body.kind == BodyKind::Wall) {
      const double omega = 2 * M_PI / period;
      body.oscillation = {{0, 9.81 / (omega * omega), 0}, period, M_PI / 2};  // at rest, downwards with g
    }
  c.time.end = 0.05;
  c.domain.min[1] -= 0.1;
  Simulation<2> falling(c, created<2>(c));
  for (int k = 0; k < 20; ++k) falling.advance();
  Case still = shakenTank(12, 10, {});
  Simulation<2> standing(still, created<2>(still));
  for (int k = 0; k < 20; ++k) standing.advance();
  const auto pressure = [](const Simulation<2>& s) {
    return fluidMean(s.particles(), [&](std::uint32_t i) { return s.particles().pressure[i]; });
  };
  EXPECT_LT(pressure(falling), 0.004 * pressure(standing));  // measured: 0.0021
}

}  // namespace
}  // namespace treacle::test
