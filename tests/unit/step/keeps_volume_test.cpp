#include "support/isph_cases.hpp"
#include "support/same_bits.hpp"
#include "support/scene.hpp"
#include "support/state_of.hpp"
#include "treacle/model/case_keys.hpp"
#include "treacle/mph/mph_particles.hpp"
#include "treacle/step/simulation.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace treacle::test {
namespace {

/// A ring of fluid in a drum that turns at 25 rad/s, without gravity.
Case ringCase(SchemeKind scheme = SchemeKind::Accurate) {
  Case c;
  c.dimensions = 2;
  c.spacing = 1e-3;
  c.domain.min = {-0.026, -0.026, 0}, c.domain.max = {0.026, 0.026, 0};
  c.time.step = 1e-3, c.time.end = 1;
  c.method = defaultMethod(scheme);
  c.watch.density = 0;
  Material honey;
  honey.name = "honey", honey.density = 1400, honey.dynamicViscosity = 10;
  honey.bulkViscosity = 1e4, honey.bulkModulus = 1e6;
  c.materials = {honey};
  Body fluid, drum;
  fluid.name = "fluid", fluid.kind = BodyKind::Fluid;
  fluid.shape.kind = drum.shape.kind = ShapeKind::Sphere;
  fluid.shape.radius = 0.02, fluid.shape.innerRadius = 0.01;
  drum.name = "drum", drum.kind = BodyKind::Wall;
  drum.shape.radius = 0.024, drum.shape.innerRadius = 0.02;
  drum.rotation = Rotation{{0, 0, 0}, {0, 0, 1}, 25};
  c.bodies = {fluid, drum};
  return c;
}

/// Mean square of the distance from the centre [m2].
double meanSquare(const Particles<2>& p) {
  double sum = 0;
  for (std::uint32_t i = 0; i < p.fluidCount; ++i) sum += norm2(p.position[i]);
  return sum / p.fluidCount;
}

/// What fluid that turns with its drum goes outwards in a turn, as a share of the mean square of its radius.
double growth(SchemeKind scheme) {
  const Case c = ringCase(scheme);
  Simulation<2> s(c, created<2>(c));
  for (int k = 0; k < 100; ++k) s.advance();  // it has taken the drum's speed
  const double before = meanSquare(s.particles());
  for (int k = 0; k < 250; ++k) s.advance();
  return meanSquare(s.particles()) / before - 1;
}

TEST(KeepsVolume, FluidThatTurnsStaysOnItsCircles) {
  EXPECT_NEAR(growth(SchemeKind::Accurate), 0, 5e-3);
  EXPECT_GT(std::abs(growth(SchemeKind::Published)), 2e-2) << "what this is about";
}

TEST(KeepsVolume, ContinuesFromACopyWithTheSameBits) {
  Case c = ringCase();
  c.method.tension = true;
  Simulation<2> whole(c, created<2>(c));
  for (int k = 0; k < 7; ++k) whole.advance();
  Simulation<2> resumed(c, stateOf(whole), whole.step(), whole.time());
  for (int k = 0; k < 5; ++k) whole.advance(), resumed.advance();
  expectSameBits(stateOf(whole), stateOf(resumed));
}

TEST(KeepsVolume, TheDensityInsideIsMeasured) {
  const Case c = ringCase();
  Simulation<2> s(c, created<2>(c));
  const Diagnostics d = s.advance().diagnostics;
  EXPECT_NEAR(d.meanDensityRatio, 1, 2e-3);
  EXPECT_GT(d.interiorParticles, 0.3 * s.particles().fluidCount);
}

/// Of fluid at rest that a step expands by 0.1 %: its pressure over the bulk modulus.
double heldAfter(double open, double n, double ambient) {
  const Scene<2> s = makeScene<2>({.scheme = SchemeKind::Accurate});
  MphPairs<2> pairs = s.pairs();
  pairs.ambientPressure = ambient;
  const double density = n * pairs.restDensity;
  return heldPressureOf<2>(pairs, 0, 1e-3, {{&density, 1}, {&open, 1}}, -1, 0) / pairs.bulkModulus(0);
}

TEST(KeepsVolume, TensionIsHeldInsideDownToTheAmbientPressure) {
  const double inside = heldAfter(0, 1, 1e9);
  EXPECT_NEAR(inside, -1e-3 * divergenceShare, 1e-12);
  EXPECT_EQ(heldAfter(0.4, 0.95, 1e9), 0) << "at a free surface";
  EXPECT_EQ(heldAfter(0, 0.5, 1e9), 0) << "nearly alone";
  EXPECT_LT(heldAfter(0, 0.95, 1e9), inside) << "a gap is drawn together";
  EXPECT_EQ(heldAfter(0, 1, 0), 0);
}

/// A particle that neighbours crowd from one side.
TEST(KeepsVolume, ParticlesThatBearTensionAreShiftedToWhereNeighboursLack) {
  const Scene<2> s = makeScene<2>({.scheme = SchemeKind::Accurate});
  const MphPairs<2>& pairs = s.pairs();
  const double dt = 1e-3, n = pairs.restDensity, l = pairs.spacing;
  const auto way = [&](double open, double crowding) {
    return dt *
           (spreadVelocityOf<2>(pairs, 0, dt, {{&n, 1}, {&open, 1}}, {2, 3}, {crowding / l, 0}) - Vec<2>{2, 3});
  };
  const double share = shiftingShare * pairs.bulkModulus(0) * dt / pairs.bulkViscosity(0);
  EXPECT_NEAR(way(0, 0.1)[0], -share * 0.1 * l, 1e-12 * l);
  EXPECT_EQ(way(0, 0.1)[1], 0);
  EXPECT_NEAR(way(0, 1e6)[0], -longestShift * l, 1e-12 * l);
  EXPECT_EQ(way(0.4, 0.1)[0], 0) << "at a free surface";
}

}  // namespace
}  // namespace treacle::test
