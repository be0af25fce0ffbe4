#include "support/oracle.hpp"
#include "support/tolerances.hpp"

#include <gtest/gtest.h>

namespace treacle::test {
namespace {

template <int D>
void checkNumberDensity(Walls walls, SchemeKind scheme) {
  Scene<D> s = makeScene<D>({.walls = walls, .scheme = scheme});
  const Oracle<D> oracle(s);
  std::vector<double> n(s.pairs().activeCount);
  numberDensity<D>(s.context, s.pairs(), n);
  for (std::uint32_t i = 0; i < s.pairs().activeCount; ++i) {
    if (i >= s.n() && n[i] == 0) continue;  // walls without fluid next to them are left out
    ASSERT_NEAR(n[i], oracle.numberDensity(i), kernelTolerance) << "particle " << i;
  }
  for (std::uint32_t i = s.n(); i < s.pairs().activeCount; ++i)
    for (std::uint32_t j = 0; j < s.n() && n[i] == 0; ++j) ASSERT_GT(norm(oracle.difference(i, j)), oracle.hp);
}

TEST(NumberDensity, EqualsTheSumOverAllParticles) {
  for (const SchemeKind scheme : bothSchemes) {
    checkNumberDensity<2>(Walls::Floor, scheme);
    checkNumberDensity<3>(Walls::Floor, scheme);
    checkNumberDensity<2>(Walls::None, scheme);
  }
}

template <int D>
void checkGradientAndDivergence(SchemeKind scheme) {
  Scene<D> s = makeScene<D>({.scheme = scheme});
  const Oracle<D> oracle(s);
  const Matrix c = oracle.gradientMatrix();
  const std::uint32_t active = s.pairs().activeCount;

  Vector q = Vector::Zero(oracle.count());
  q.setHead(randomVector(active, 2));
  // Walls out of the fluid's reach have no column, and their q does not matter.
  std::vector<double> qOf(q.data(), q.data() + active);
  std::vector<Vec<D>> y(s.n(), Vec<D>{});
  addPressureGradient<D>(s.context, s.pairs(), qOf, -1.0, y);
  const Vector expected = -(c * q);
  EXPECT_LT((flat<D>(y) - expected).norm(), operatorTolerance * expected.norm());

  Vector u = Vector::Zero(D * active);
  u.setHead(randomVector(s.unknowns(), 3));
  std::vector<double> div(active);
  const auto velocity = unflat<D>(u);
  divergence<D>(s.context, s.pairs(), velocity, div);
  const Vector expectedDiv = (c.transpose() * u.head(s.unknowns())).head(active);
  EXPECT_LT((Vector(div) - expectedDiv).norm(), operatorTolerance * expectedDiv.norm());
}

TEST(PressureGradient, AndDivergenceAreEachOthersTranspose) {
  for (const SchemeKind scheme : bothSchemes) {
    checkGradientAndDivergence<2>(scheme);
    checkGradientAndDivergence<3>(scheme);
  }
}

TEST(Divergence, IsZeroWhenFluidAndWallsMoveTogether) {
  for (const SchemeKind scheme : bothSchemes) {
    Scene<3> s = makeScene<3>({.scheme = scheme});
    const std::vector<Vec<3>> u(s.pairs().activeCount, Vec<3>{0.3, -1.2, 2.0});
    std::vector<double> div(s.pairs().activeCount);
    divergence<3>(s.context, s.pairs(), u, div);
    for (double d : div) ASSERT_EQ(d, 0);
  }
}

template <int D>
void checkWallDensity(SchemeKind scheme) {
  Scene<D> s = makeScene<D>({.scheme = scheme});
  const Oracle<D> oracle(s);
  std::vector<double> n(s.n());
  wallDensity<D>(s.context, s.pairs(), n);
  int touching = 0;
  for (std::uint32_t i = 0; i < s.n(); ++i) {
    double expected = 0;
    for (std::uint32_t j = s.n(); j < oracle.count(); ++j)
      expected += oracle.densityWeight(norm(oracle.difference(i, j)));
    ASSERT_NEAR(n[i], expected, kernelTolerance) << "particle " << i;
    touching += expected > 0;
  }
  EXPECT_GT(touching, 0);
}

TEST(WallDensity, IsTheSumOverWallsAlone) {
  for (const SchemeKind scheme : bothSchemes) {
    checkWallDensity<2>(scheme);
    checkWallDensity<3>(scheme);
  }
}

/// -dD/du / dV of the moving walls' share: with the fluid at rest the drag is V's coupling to the walls.
TEST(WallDrag, IsTheDissipationGradientOfMovingWalls) {
  Scene<2> s = makeScene<2>();
  for (Material& m : s.c.materials) m.bulkViscosity = 0;
  prepare(s);
  const Oracle<2> oracle(s);
  Vector u = Vector::Zero(2 * oracle.count());
  u.setTail(randomVector(2 * (oracle.count() - s.n()), 8));
  std::vector<Vec<2>> y(s.n(), Vec<2>{});
  const auto velocity = unflat<2>(u);
  addWallDrag<2>(s.context, s.pairs(), std::span(velocity).first(s.pairs().activeCount), y);
  const double scale = flat<2>(y).cwiseAbs().maxCoeff();
  for (Index k = 0; k < s.unknowns(); k += 7) {
    Vector plus = u, minus = u;
    plus[k] += 1;  // D is quadratic: central differences are exact
    minus[k] -= 1;
    const double gradient = (oracle.dissipation(plus) - oracle.dissipation(minus)) / 2 / s.volume();
    ASSERT_NEAR(flat<2>(y)[k], -gradient, operatorTolerance * scale);
  }
}

}  // namespace
}  // namespace treacle::test
