#include "support/isph_cases.hpp"
#include "support/sheet_cases.hpp"
#include "support/state_of.hpp"
#include "treacle/step/run/simulation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

namespace treacle::test {
namespace {

/// What both sides of the divided tank hold, and how high, by twice the mean height.
template <int D>
struct Sides {
  int left = 0, right = 0;
  double leftHeight = 0, rightHeight = 0;

  explicit Sides(const Particles<D>& p) {
    for (std::uint32_t i = 0; i < p.fluidCount; ++i) {
      const bool isLeft = p.position[i][0] < 0.5;
      ++(isLeft ? left : right);
      (isLeft ? leftHeight : rightHeight) += 2 * p.position[i][D - 1];
    }
    leftHeight /= left, rightHeight /= std::max(right, 1);
  }
};

/// Each side keeps its level, and the sheet bears the difference of the pressures.
template <int D>
void expectDivided(MethodKind method, double bound) {
  constexpr double high = 0.75, low = 0.375;
  Case c = dividedTank(D, high, low, method);
  if (method == MethodKind::MphI) c.output.balance = true;
  Simulation<D> s(c, created<D>(c));
  const Sides<D> before(stateOf(s));
  StepReport report;
  for (int k = 0; k < (D == 2 ? 100 : 60); ++k) report = s.advance();
  const Sides<D> after(stateOf(s));
  EXPECT_EQ(after.left, before.left);
  EXPECT_EQ(after.right, before.right);
  EXPECT_NEAR(after.leftHeight, high, 0.01 * high);
  EXPECT_NEAR(after.rightHeight, low, 0.01 * low);
  if (method == MethodKind::Isph) return;
  const double load = 1000 * 10 * (high * high - low * low) / 2;
  EXPECT_NEAR(report.loads.back().force[0], load, bound * load);
}

TEST(ThinSheet, BearsWhatStandsHigherOnOneSide) {
  expectDivided<2>(MethodKind::MphI, 0.01);
  expectDivided<3>(MethodKind::MphI, 0.01);
}

TEST(ThinSheet, KeepsLevelsApartInIsph) { expectDivided<2>(MethodKind::Isph, 0); }

/// A hole lets the fluid through: the test above can fail.
TEST(ThinSheet, LetsFluidThroughAHole) {
  Case c = dividedTank(2, 0.75, 0.375);
  c.bodies.back().where = "y > 0.25";
  Simulation<2> s(c, created<2>(c));
  const Sides<2> before(stateOf(s));
  for (int k = 0; k < 200; ++k) s.advance();
  EXPECT_GT(Sides<2>(stateOf(s)).right, before.right + 5);
}

/// Fluid follows a paddle on both of its sides and stays on its own, whichever way the paddle has turned.
TEST(ThinSheet, StirsWithoutLettingFluidThrough) {
  Case c = paddleTank(2);
  c.gravity = {};
  c.output.balance = true;
  const double l = c.spacing, before = 1.0;
  Simulation<2> s(c, created<2>(c));
  double power = 0;
  for (int k = 0; k < 300; ++k) {
    const StepReport report = s.advance();
    power = report.loads.back().torque[2] * 4;
    EXPECT_NEAR(report.diagnostics.meanDensityRatio, before, 0.004);
  }
  EXPECT_LT(power, 0);
  // Whoever is close to the paddle moves with it.
  const Particles<2> p = stateOf(s);
  const double angle = 4 * s.time();
  const Vec<2> along{std::cos(angle), std::sin(angle)}, across{-along[1], along[0]};
  int close = 0;
  for (std::uint32_t i = 0; i < p.fluidCount; ++i) {
    const Vec<2> d = p.position[i] - Vec<2>{0.5, 0.375};
    const double x = dot(d, along), y = dot(d, across);
    if (std::abs(x) > 0.15 || std::abs(y) > 0.75 * l) continue;
    ++close;
    EXPECT_NEAR(dot(p.velocity[i], across), 4 * x, 0.1 * 4 * 0.2);
    EXPECT_EQ(sides::of(p.side[i], 0), y > 0 ? sides::Back : sides::Front) << x << ", " << y;
  }
  EXPECT_GT(close, 5);
}

TEST(ThinSheet, GoesOnFromACopyWithTheSameBits) {
  const Case c = paddleTank(2);
  Simulation<2> whole(c, created<2>(c));
  for (int k = 0; k < 10; ++k) whole.advance();
  Simulation<2> rest(c, copyOf(stateOf(whole)), whole.step(), whole.time());
  for (int k = 0; k < 10; ++k) whole.advance(), rest.advance();
  EXPECT_TRUE(sameBits(stateOf(whole), stateOf(rest)));
}

}  // namespace
}  // namespace treacle::test
