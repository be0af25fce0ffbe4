#include "treacle/mph/conduction.hpp"

#include "support/oracle.hpp"
#include "support/tolerances.hpp"
#include "treacle/model/materials/enthalpy.hpp"
#include "treacle/mph/free_surface.hpp"
#include "treacle/mph/viscosity_scale.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <random>

namespace treacle::test {
namespace {

/// The body on a floor, of two materials, and what conducts: fluid and floor.
template <int D>
struct WarmScene {
  Scene<D> s;
  std::vector<WallHeat> walls;
  std::vector<double> scale;
  Conduction terms;

  explicit WarmScene(SchemeKind scheme, const WallHeat& wall = {400, 2e-4})
      : s(makeScene<D>({.scheme = scheme})), walls{wall}, scale(s.n()) {
    s.c.materials[0].conductivity = 2, s.c.materials[1].conductivity = 0.5;
    terms = {HeatTable::make(s.c), walls.data(), s.particles.body.data(), nullptr};
    conductionScale<D>(s.context, s.pairs(), terms, scale);
    terms.scale = scale.data();
  }

  std::vector<double> conducted(std::span<const double> T, double extra = 0) {
    std::vector<double> y(s.n()), e(s.n(), extra);
    conduct<D>(s.context, s.pairs(), terms, e, T, y);
    return y;
  }
  std::vector<double> random(unsigned seed) const {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    std::vector<double> values(s.n());
    for (double& x : values) x = unit(generator);
    return values;
  }
};

/// From all pairs, with the viscous block of the oracle: kappa = k s c r^2 / (D + 2).
template <int D>
void checkAgainstAllPairs(SchemeKind scheme) {
  WarmScene<D> w(scheme);
  const Oracle<D> oracle(w.s);
  const std::uint32_t n = w.s.n();
  const auto radius = [&](std::uint32_t i, std::uint32_t j) { return norm(oracle.difference(i, j)); };
  const auto block = [&](double r) { return r < oracle.hv ? oracle.viscousBlock(r) : 0; };
  std::vector<double> scale(n);
  for (std::uint32_t i = 0; i < n; ++i) {
    double moment = 0;
    for (std::uint32_t j = 0; j < oracle.count(); ++j)
      if (j != i) moment += block(radius(i, j)) * std::pow(radius(i, j), 4);
    scale[i] = std::min(2.0 * D * (D + 2) / moment, 4.0);
    ASSERT_NEAR(w.scale[i], scale[i], 1e-12 * scale[i]);
  }
  const std::vector<double> T = w.random(3);
  const std::vector<double> found = w.conducted(T, 7);
  std::vector<double> ofFluid(n);
  std::vector<HeatExchange> ofWalls(n);
  conductionDiagonal<D>(w.s.context, w.s.pairs(), w.terms, ofFluid, ofWalls);
  double size = 0;
  for (const double x : ofFluid) size = std::max(size, x);
  for (std::uint32_t i = 0; i < n; ++i) {
    const double k = oracle.material(i).conductivity;
    double sum = 0, product = 7 * T[i], coefficient = 0;
    for (std::uint32_t j = 0; j < oracle.count(); ++j) {
      if (j == i) continue;
      const double r = radius(i, j), c = block(r) * r * r / (D + 2);
      if (j < n) {
        const double other = oracle.material(j).conductivity;
        const double kappa = 2 * k * other / (k + other) * 0.5 * (scale[i] + scale[j]) * c;
        sum += kappa;
        product += kappa * (T[i] - T[j]);
      } else if (w.s.wallSurface.empty()) {
        coefficient += k * scale[i] * c * r / (r + k * 2e-4);
      }
    }
    ASSERT_NEAR(ofFluid[i], sum, 1e-12 * size);
    ASSERT_NEAR(found[i], product, 1e-12 * size);
    if (!w.s.wallSurface.empty()) continue;
    ASSERT_NEAR(ofWalls[i].coefficient, coefficient, 1e-12 * size);
    ASSERT_NEAR(ofWalls[i].gain, 400 * coefficient, 400e-12 * size);
  }
}

TEST(Conduction, IsTheSumOverAllPairs) {
  for (const SchemeKind scheme : bothSchemes) {
    checkAgainstAllPairs<2>(scheme);
    checkAgainstAllPairs<3>(scheme);
  }
}

template <int D>
void checkConservation(SchemeKind scheme) {
  WarmScene<D> w(scheme);
  const std::vector<double> a = w.random(5), b = w.random(6), ya = w.conducted(a), yb = w.conducted(b);
  const auto dot = [](const std::vector<double>& x, const std::vector<double>& y) {
    return std::inner_product(x.begin(), x.end(), y.begin(), 0.0);
  };
  const double size =
      std::accumulate(ya.begin(), ya.end(), 0.0, [](double s, double x) { return s + std::abs(x); });
  EXPECT_NEAR(std::accumulate(ya.begin(), ya.end(), 0.0), 0, 1e-13 * size);
  EXPECT_NEAR(dot(a, yb), dot(b, ya), 1e-12 * size);
  EXPECT_GT(dot(a, ya), 0);
  for (const double y : w.conducted(std::vector<double>(w.s.n(), 321.5))) EXPECT_EQ(y, 0);
}

TEST(Conduction, ConservesHeat) {
  for (const SchemeKind scheme : bothSchemes) {
    checkConservation<2>(scheme);
    checkConservation<3>(scheme);
  }
}

/// A wall at rest that touches the fluid conducts, an adiabatic one does not, and a bad conductor less.
template <int D>
void checkWalls(SchemeKind scheme) {
  const auto sumOf = [&](const WallHeat& wall) {
    WarmScene<D> w(scheme, wall);
    std::vector<double> ofFluid(w.s.n());
    std::vector<HeatExchange> ofWalls(w.s.n());
    conductionDiagonal<D>(w.s.context, w.s.pairs(), w.terms, ofFluid, ofWalls);
    double sum = 0;
    for (const HeatExchange& e : ofWalls) {
      EXPECT_GE(e.coefficient, 0);
      EXPECT_NEAR(e.gain, wall.temperature * e.coefficient, 1e-12 * e.gain);
      sum += e.coefficient;
    }
    return sum;
  };
  EXPECT_EQ(sumOf({0, 0}), 0);
  const double touching = sumOf({300, 0}), behind = sumOf({300, 1e-3}), far = sumOf({300, 1e-1});
  EXPECT_GT(touching, 1.2 * behind);
  EXPECT_GT(behind, 20 * far);
  EXPECT_GT(far, 0);
}

TEST(Conduction, MeetsWallsThroughTheirResistance) {
  for (const SchemeKind scheme : bothSchemes) {
    checkWalls<2>(scheme);
    checkWalls<3>(scheme);
  }
}

/// A lattice that fills a part of the periodic domain.
template <int D>
Scene<D> lattice(SchemeKind scheme, const Where<D>& where) {
  Scene<D> s;
  s.c = sceneCase(D, false, scheme);
  s.particles = jitteredLattice<D>(s.c, 0, 1, where, [](const Vec<D>&) { return false; });
  for (auto& m : s.particles.material) m = 0;
  prepare(s);
  return s;
}

/// Within a material that freezes, the fluxes are those of Kirchhoff's transformation: differences of the integral
/// of k(T). Between materials k is the harmonic mean.
template <int D>
void checkFreezing(SchemeKind scheme) {
  WarmScene<D> w(scheme);
  w.s.c.materials[0].freezing = Freezing{.solidus = 320, .liquidus = 330, .solidConductivity = 6};
  const EnthalpyTable table = EnthalpyTable::make(w.s.c.materials);
  std::vector<double> T = w.random(5), k, conducted, atWalls;
  for (std::uint32_t i = 0; i < w.s.n(); ++i) {
    T[i] = 300 + 50 * T[i];
    const Enthalpy& h = table.of[w.s.particles.material[i]];
    k.push_back(h.conductivity(T[i])), conducted.push_back(h.conducted(T[i]));
  }
  for (const Enthalpy& h : table.of) atWalls.push_back(h.conducted(400));
  w.terms.own = {T.data(), k.data(), conducted.data(), atWalls.data()};
  const std::vector<double> found = w.conducted(T);
  std::vector<double> ofFluid(w.s.n());
  std::vector<HeatExchange> ofWalls(w.s.n());
  conductionDiagonal<D>(w.s.context, w.s.pairs(), w.terms, ofFluid, ofWalls);
  const Oracle<D> oracle(w.s);
  double total = 0, size = 0;
  for (std::uint32_t i = 0; i < w.s.n(); ++i) {
    double expected = 0, toWalls = 0;
    for (std::uint32_t j = 0; j < oracle.count(); ++j) {
      const double r = norm(oracle.difference(i, j));
      if (j == i || r >= oracle.hv) continue;
      const double c = oracle.viscousBlock(r) * r * r / (D + 2);
      if (j >= w.s.n()) {
        if (w.s.wallSurface.empty()) {
          const int m = w.s.particles.material[i];
          const double mean = (table.of[m].conducted(400) - conducted[i]) / (400 - T[i]);
          toWalls += w.scale[i] * mean * c * r / (r + mean * 2e-4);
        }
        continue;
      }
      const double both = 0.5 * (w.scale[i] + w.scale[j]) * c;
      const bool same = w.s.particles.material[i] == w.s.particles.material[j];
      expected += both * (same ? conducted[i] - conducted[j] : 2 * k[i] * k[j] / (k[i] + k[j]) * (T[i] - T[j]));
    }
    size = std::max(size, std::abs(expected));
    total += found[i];
    ASSERT_NEAR(found[i], expected, 1e-8 * size + 1e-12);
    if (w.s.wallSurface.empty()) {
      ASSERT_NEAR(ofWalls[i].coefficient, toWalls, 1e-11 * toWalls);
    }
  }
  EXPECT_NEAR(total, 0, 1e-9 * size);
}

TEST(Conduction, FollowsKirchhoffWithinAMaterialThatFreezes) {
  for (const SchemeKind scheme : bothSchemes) {
    checkFreezing<2>(scheme);
    checkFreezing<3>(scheme);
  }
}

/// In a full lattice the sum is a Laplacian: of a cosine that goes around the domain k^2 times itself, but for an
/// error of second order in the radius (measured: at most 3 % where the domain is 20 spacings long, 6 % where 14).
template <int D>
void checkLaplacian(SchemeKind scheme) {
  WarmScene<D> w(scheme);
  w.s = lattice<D>(scheme, [](const Vec<D>&) { return true; });
  w.s.c.materials[0].conductivity = 2;
  w.scale.assign(w.s.n(), 0);
  w.terms = {HeatTable::make(w.s.c), w.walls.data(), w.s.particles.body.data(), nullptr};
  conductionScale<D>(w.s.context, w.s.pairs(), w.terms, w.scale);
  w.terms.scale = w.scale.data();
  const double k = 2 * M_PI / w.s.c.domain.max[0];
  std::vector<double> T;
  for (std::uint32_t i = 0; i < w.s.n(); ++i) T.push_back(std::cos(k * w.s.pairs().position[i][0]));
  const std::vector<double> found = w.conducted(T);
  for (std::uint32_t i = 0; i < w.s.n(); ++i) EXPECT_NEAR(found[i], 2 * k * k * T[i], 0.07 * 2 * k * k);
}

TEST(Conduction, IsALaplacianInALattice) {
  for (const SchemeKind scheme : bothSchemes) {
    checkLaplacian<2>(scheme);
    checkLaplacian<3>(scheme);
  }
}

template <int D>
double surfaceOf(Scene<D>& s) {
  std::vector<double> area(s.n());
  surfaceArea<D>(s.context, s.pairs(), SurfaceColour<D>::make(s.pairs()), area);
  return s.volume() * std::accumulate(area.begin(), area.end(), 0.0);
}

/// A slab in a periodic domain has two flat surfaces, each as large as the domain is wide.
TEST(FreeSurface, OfALatticeIsItsPlane) {
  const auto check = []<int D>(Scene<D> s) {
    EXPECT_NEAR(surfaceOf(s) / (2 * std::pow(s.c.domain.max[0], D - 1)), 1, 1e-9);
  };
  check(lattice<2>(SchemeKind::Accurate, [](const Vec<2>& x) { return x[1] < 10e-3; }));
  check(lattice<3>(SchemeKind::Accurate, [](const Vec<3>& x) { return x[2] < 10e-3; }));
}

/// A disc and a ball, whose surfaces the lattice knows only in steps; in order, and with particles displaced by up
/// to 0.45 spacings along each axis.
template <int D>
void checkBall(double jitter) {
  const double l = 1e-3, radius = D == 2 ? 8 * l : 6 * l,
               middle = sceneCase(D, false, SchemeKind::Accurate).domain.max[0] / 2;
  Scene<D> s =
      lattice<D>(SchemeKind::Accurate, [=](const Vec<D>& x) { return norm(x - Vec<D>::filled(middle)) < radius; });
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(-jitter * l, jitter * l);
  for (Vec<D>& x : s.particles.position)
    for (int k = 0; k < D; ++k) x[k] += unit(random);
  prepare(s);
  const double volume = s.n() * s.volume(),
               r = D == 2 ? std::sqrt(volume / M_PI) : std::cbrt(0.75 * volume / M_PI);
  EXPECT_NEAR(surfaceOf(s) / (D == 2 ? 2 * M_PI * r : 4 * M_PI * r * r), 1, 0.04) << D << ' ' << jitter;
}

TEST(FreeSurface, OfABallIsItsSphereInDisorderToo) {
  for (const double jitter : {0.0, 0.3, 0.45}) checkBall<2>(jitter), checkBall<3>(jitter);
}

/// Inside a fluid there is hardly any where rows have come apart by a third of a spacing, and none at a wall.
TEST(FreeSurface, IsNotInside) {
  const double l = 1e-3;
  Scene<2> s;
  s.c = sceneCase(2, false, SchemeKind::Accurate);
  s.particles = jitteredLattice<2>(
      s.c, 0, 1, [l](const Vec<2>& x) { return x[1] > 5 * l && x[1] < 15 * l; },
      [l](const Vec<2>& x) { return x[1] < 5 * l || x[1] > 15 * l; });
  for (std::uint32_t i = 0; i < s.particles.fluidCount; ++i) {
    s.particles.material[i] = 0;
    Vec<2>& x = s.particles.position[i];
    x[1] += x[1] > 10 * l ? l / 6 : -l / 6;
  }
  prepare(s);
  EXPECT_LT(surfaceOf(s), 0.06 * s.c.domain.max[0]);
}

}  // namespace
}  // namespace treacle::test
