#include "treacle/mph/wall_surfaces.hpp"
#include "support/scene.hpp"

#include <gtest/gtest.h>

namespace treacle::test {
namespace {

constexpr double l = 1e-3;

/// One face, or two, given from the particle [spacings].
WallSurface<2> surface(const Vec<2>& a, const Vec<2>& b = {}) {
  return {{converted<float>(l * a), converted<float>(l * b)}};
}
/// The factor of fluid at `above` with a wall particle at the origin [spacings].
double factor(const WallSurface<2>& s, const Vec<2>& above, double slip = 0) {
  return wallFactor(s, -l * above, l, slip * l);
}

TEST(WallFactor, ExtrapolatesThroughAPlane) {
  const WallSurface<2> floor = surface({0, 1.5});
  EXPECT_NEAR(factor(floor, {0, 2}), 2 / 0.5, 1e-6);
  EXPECT_NEAR(factor(floor, {-2, 3.5}), 3.5 / 2, 1e-6) << "only distances from the plane count";
}

TEST(WallFactor, IsOneWhereNoSurfaceIsKnown) { EXPECT_EQ(factor(surface({}), {0, 2}), 1); }

TEST(WallFactor, IsBoundedForFluidThatTouchesTheWallOrIsInIt) {
  const WallSurface<2> floor = surface({0, 0.5});
  for (const double y : {0.6, 0.5, 0.1, -0.4}) EXPECT_NEAR(factor(floor, {0.3, y}), 0.75 / 0.25, 1e-6) << y;
}

TEST(WallFactor, FallsWithTheSlipLength) {
  const WallSurface<2> floor = surface({0, 1.5});
  EXPECT_NEAR(factor(floor, {0, 2}, 0.5), 2 / (0.5 + 0.5), 1e-6);
  EXPECT_NEAR(factor(floor, {0, 2}, 1e6), 0, 1e-5);
}

TEST(WallFactor, TakesTheSideOfAPlateOnWhichTheFluidIs) {
  const WallSurface<2> plate = surface({0, 0.5}, {0, -1.5});
  EXPECT_NEAR(factor(plate, {0, 1}), 1 / 0.5, 1e-6);
  EXPECT_NEAR(factor(plate, {0, -2}), 2 / 0.5, 1e-6);
  EXPECT_NEAR(factor(plate, {0, -3.5}), 3.5 / 2, 1e-6);
}

TEST(WallFactor, TakesTheFaceOfAnEdgeThatTheLineCrosses) {
  const WallSurface<2> edge = surface({0.5, 0}, {0, 1});
  EXPECT_NEAR(factor(edge, {1, 0.5}), 1 / 0.5, 1e-6) << "beside";
  EXPECT_NEAR(factor(edge, {0.2, 2}), 2 / 1.0, 1e-6) << "above";
  EXPECT_NEAR(factor(edge, {1, 1.5}), 1 / 0.5, 1e-6) << "in front of both: in by the right one";
}

/// Fluid at lattice points on a floor, in simple shear along it that is zero at its surface: no force on any
/// particle that has all its neighbours.
template <int D>
void checkShear(double slip) {
  Scene<D> s;
  s.c = sceneCase(D, false, SchemeKind::Accurate);
  s.c.method.viscosityCorrection = 0;  // the viscosity is to be the same everywhere, below the surface, too
  for (Material& m : s.c.materials) m.slipLength = slip * l;
  const double floor = 4 * l;
  s.particles = jitteredLattice<D>(
      s.c, 0, 1, [&](const Vec<D>& x) { return x[D - 1] > floor && x[D - 1] < 13 * l; },
      [&](const Vec<D>& x) { return x[D - 1] < floor; });
  s.particles.wallSurface.resize(s.particles.wallCount());
  for (std::uint32_t k = 0; k < s.particles.wallCount(); ++k) {
    s.particles.wallSurface[k] = {};
    s.particles.wallSurface[k].face[0][D - 1] =
        static_cast<float>(floor - s.particles.position[s.particles.fluidCount + k][D - 1]);
  }
  prepare(s);
  MphOperator<D> a;
  a.prepare(s.context, s.pairs(), s.terms());
  std::vector<Vec<D>> u(s.n()), y(s.n());
  for (std::uint32_t i = 0; i < s.n(); ++i) u[i][0] = s.particles.position[i][D - 1] - floor + slip * l;
  a.multiply(s.context, u, y);
  // What the force of one neighbour alone would be.
  const double scale = s.c.materials[0].dynamicViscosity / l;
  int checked = 0;
  for (std::uint32_t i = 0; i < s.n(); ++i) {
    if (s.particles.position[i][D - 1] > 9 * l) continue;
    const Vec<D> force = y[i] - s.pairs().inertia(i) * u[i];
    ASSERT_LT(norm(force), 1e-6 * scale) << "single precision of the surfaces";
    ++checked;
  }
  EXPECT_GT(checked, 50);
}

TEST(WallFactor, ShearAlongAWallIsWithoutForces) {
  checkShear<2>(0);
  checkShear<3>(0);
}
TEST(WallFactor, ShearAlongAWallWithSlipIsWithoutForces) { checkShear<2>(0.4); }

/// The surfaces of a wall that has turned are where its particles have gone.
template <int D>
void checkTurning() {
  Body body;
  body.kind = BodyKind::Wall;
  body.rotation = Rotation{{2 * l, 3 * l, l}, D == 2 ? Vec<3>{0, 0, 1} : Vec<3>{1, 2, -1}, 3};
  const Vec<D> center = resized<D>(body.rotation->center);
  Vec<D> particle = center, face{};
  for (int k = 0; k < D; ++k) particle[k] += (k + 1) * l, face[k] = (2 - k) * l;
  Vec<D> end = particle + face;  // of the face: goes with the wall, too
  const double dt = 0.01;
  const int steps = 80;
  for (int step = 0; step < steps; ++step) {
    const WallMotion<D> m = wallMotion<D>({}, body, step * dt, dt);
    particle += dt * m.chordAt(particle);
    end += dt * m.chordAt(end);
  }
  const WallMotion<D> motion = wallMotion<D>({}, body, steps * dt, dt);
  EXPECT_LT(norm(motion.turned(face) - (end - particle)), 1e-12 * l);

  const std::vector<WallSurface<D>> known{{{converted<float>(face), {}}}};
  const std::vector<WallMotion<D>> motions{WallMotion<D>{}, motion};
  const std::vector<std::uint8_t> bodies{1};
  std::vector<WallSurface<D>> placed(1);
  Context<Cpu> context;
  placeSurfaces<D>(context, {known, motions}, bodies, placed);
  EXPECT_LT(norm(converted<double>(placed[0].face[0]) - (end - particle)), 1e-6 * l);
  EXPECT_EQ(norm(placed[0].face[1]), 0);
  placeSurfaces<D>(context, {known, {}}, bodies, placed);
  EXPECT_EQ(placed[0], known[0]) << "walls that do not turn";
}

TEST(WallSurfaces, TurnWithTheirWalls) {
  checkTurning<2>();
  checkTurning<3>();
}

}  // namespace
}  // namespace treacle::test
