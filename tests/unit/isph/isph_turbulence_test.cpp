#include "treacle/isph/isph_turbulence.hpp"

#include "support/isph_scene.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace treacle::test {
namespace {

TEST(WallLaw, HasTheStressOfTheLogarithmicProfile) {
  const double density = 1000, mu = 1e-3, friction = 0.05, nu = mu / density;
  for (const double y : {12.0, 30.0, 300.0, 1e4, 1e6}) {
    const double d = y * nu / friction, u = friction * std::log(9.8 * y) / 0.41;
    EXPECT_NEAR(wallLawViscosity(u, d, density, mu) * u / d, density * friction * friction, 1e-9) << y;
    EXPECT_EQ(wallLawViscosity(-u, d, density, mu), wallLawViscosity(u, d, density, mu));
  }
}

TEST(WallLaw, IsLaminarNextToTheWall) {
  const double density = 1000, mu = 1e-3, friction = 0.05, d = 5 * mu / density / friction;
  EXPECT_EQ(wallLawViscosity(5 * friction, d, density, mu), mu);
  EXPECT_EQ(wallLawViscosity(0, d, density, mu), mu);
  EXPECT_NEAR(wallLawViscosity(1, 11.54 * 11.53 * mu / density, density, mu), mu, 2e-3 * mu) << "where they meet";
}

/// Water in a lattice on a floor, periodic across.
template <int D>
IsphScene<D> layerOnFloor(double gap) {
  Vec<3> size{20, 30, D == 3 ? 10.0 : 0};
  Case c = waterCase(D, size);
  c.domain.periodic = {true, false, D == 3};
  c.method.isph.smagorinsky = 0.2;
  const double l = c.spacing;
  Vec<D, int> fluid = Vec<D, int>::filled(10), wall = Vec<D, int>::filled(10);
  fluid[0] = wall[0] = 20;
  wall[1] = 4;
  Vec<D> first = Vec<D>::filled(l / 2), floor = first;
  first[1] += (3.5 + gap) * l;
  return {c, particlesAt<D>(latticeAt<D>(first, fluid, l), latticeAt<D>(floor, wall, l))};
}

/// What EddyTerm finds in fluid with the velocities velocity(x), walls at rest.
template <int D>
struct Eddies {
  std::vector<float> eddy, wall;

  template <class Velocity>
  Eddies(IsphScene<D>& s, const Velocity& velocity) : eddy(s.n()), wall(s.n()) {
    std::vector<Vec<D>> v(s.particles.count);
    for (std::uint32_t i = 0; i < s.n(); ++i) v[i] = velocity(s.particles.position[i]);
    s.pairs.mostEddyViscosity = 1e3;
    std::vector<SmoothFlow<D>> flow(s.n());
    const BothTerms<DensityTerm<D>, SmoothFlowTerm<D>> both{{s.density.data(), s.deficit.data(), s.surface.data()},
                                                            {v.data(), s.particles.pressure.data(), flow.data()}};
    sumOnFluid(s.context, s.pairs, both);
    s.findAcrossWalls();
    sumOnFluid(s.context, s.pairs, EddyTerm<D>{v.data(), flow.data(), eddy.data(), wall.data()});
  }
};

template <int D>
void checkShear() {
  IsphScene<D> s = layerOnFloor<D>(0.5);
  const double rate = 3, length = 0.2 * s.c.spacing;
  const Eddies<D> found(s, [&](const Vec<D>& x) {
    Vec<D> v{};
    v[0] = rate * x[1];
    return v;
  });
  int inside = 0;
  for (std::uint32_t i = 0; i < s.n(); ++i) {
    const double height = s.particles.position[i][1] / s.c.spacing - 4;
    if (height < 3 || height > 7) continue;
    ++inside;
    ASSERT_NEAR(found.eddy[i], 1000 * length * length * rate, 1e-5 * found.eddy[i]);
    ASSERT_EQ(found.wall[i], 1e-3F) << "no wall is near";
  }
  EXPECT_GT(inside, 50);
}

TEST(EddyViscosity, IsThatOfSmagorinskyInALinearShear) {
  checkShear<2>();
  checkShear<3>();
}

/// The floor's surface is half a spacing above its upper particles. Speeds along it count, those towards it do
/// not.
template <int D>
void checkFloor(double gap, double tolerance) {
  IsphScene<D> s = layerOnFloor<D>(gap);
  const double u = 2, l = s.c.spacing;
  const Eddies<D> found(s, [&](const Vec<D>&) {
    Vec<D> v{};
    v[0] = u, v[1] = -7;
    return v;
  });
  int near = 0;
  for (std::uint32_t i = 0; i < s.n(); ++i) {
    const double distance = s.particles.position[i][1] - 4 * l;
    if (distance > (gap + 0.1) * l) continue;
    ++near;
    const double expected = wallLawViscosity(u, distance, 1000, 1e-3) / distance;
    ASSERT_NEAR(found.wall[i] / distance, expected, tolerance * expected);
  }
  EXPECT_GE(near, 20);
}

TEST(EddyViscosity, AtWallsHasTheFrictionOfTheLawOfTheWall) {
  checkFloor<2>(0.5, 1e-6);
  checkFloor<3>(0.5, 1e-6);
  checkFloor<2>(1.5, 0.2);
  checkFloor<3>(1.5, 0.2);
}

}  // namespace
}  // namespace treacle::test
