#include "support/isph_cases.hpp"
#include "support/rigid_cases.hpp"
#include "support/state_of.hpp"
#include "treacle/step/run/simulation.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace treacle::test {
namespace {

/// A blob with a block in it, which fall together: their velocities are the integral of gravity.
void checkFall(Case c, double tolerance) {
  c.time.step = 1e-3;
  c.gravity = {0, 0, 0};
  c.gravityInTime[0] = TimeFunction{.expression = "3*cos(200*t)"};
  c.gravityInTime[1] = TimeFunction{.times = {0, 5e-3, 5e-3 + 1e-9, 1}, .values = {0, 0, -10, -10}};
  Simulation<2> simulation(c, created<2>(c));
  for (int k = 0; k < 20; ++k) {
    const StepReport report = simulation.advance();
    const Particles<2> p = stateOf(simulation);
    // Velocities belong to the middle of a step, if forces do; the first step has a whole one of acceleration.
    const double t = report.time - c.middleShare() * 1e-3, first = c.middleShare() * 1e-3;
    const Vec<2> expected{3 * (std::sin(200 * t) / 200 + first), -10 * std::max(0.0, t - 5e-3)};
    for (std::uint32_t i = 0; i < p.fluidCount; ++i) EXPECT_LE(norm(p.velocity[i] - expected), tolerance);
    const RigidBody& block = report.rigid[1];
    EXPECT_LE(norm(resized<2>(block.velocity) - expected), tolerance);
  }
}

TEST(VaryingGravity, AcceleratesByItsIntegral) {
  checkFall(blockCase(2, 1400), 1e-5);
  checkFall(withIsph(blockCase(2, 1400), 5), 1e-4);
}

TEST(VaryingGravity, ContinuesWithTheSameBits) {
  Case c = blockCase(2, 300);
  c.gravityInTime[1] = TimeFunction{.expression = "-10*sin(300*t)"};
  Simulation<2> whole(c, created<2>(c));
  for (int k = 0; k < 5; ++k) whole.advance();
  Simulation<2> rest(c, stateOf(whole), whole.step(), whole.time());
  for (int k = 0; k < 5; ++k) {
    const StepReport a = whole.advance(), b = rest.advance();
    EXPECT_EQ(a.iterations, b.iterations);
  }
  EXPECT_TRUE(sameBits(stateOf(whole), stateOf(rest)));
}

}  // namespace
}  // namespace treacle::test
