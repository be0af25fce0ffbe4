#include "support/isph_cases.hpp"
#include "support/layer_with_gap.hpp"
#include "support/ring_in_drum.hpp"
#include "support/same_bits.hpp"
#include "support/scene.hpp"
#include "support/state_of.hpp"
#include "treacle/model/case/case_keys.hpp"
#include "treacle/mph/tension.hpp"
#include "treacle/step/run/simulation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace treacle::test {
namespace {

/// In a drum that turns at 25 rad/s.
Case ringCase(SchemeKind scheme = SchemeKind::Accurate) {
  Case c = ringInDrum(scheme);
  c.bodies[1].rotation = Rotation{{0, 0, 0}, {0, 0, 1}, 25};
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
  const Case c = ringCase();
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

/// The tension over the bulk modulus after a step of 1 ms. It is 0 before.
double tensionAfter(double open, double n, double limit) {
  const Scene<2> s = makeScene<2>({.scheme = SchemeKind::Accurate});
  MphPairs<2> pairs = s.pairs();
  pairs.tensionLimit = limit;
  const double density = n * pairs.restDensity, walls = 0;
  const Places around{{&density, 1}, {&open, 1}, {&n, 1}, {&walls, 1}};
  const Covered lack = lackOf<2>(pairs, 0, around);
  const double mean = lack[1] > 0 ? lack[0] / lack[1] : 0;
  return tensionOf<2>(pairs, 0, 1e-3, around, mean, 0) / pairs.bulkModulus(0);
}

TEST(KeepsVolume, TensionFollowsTheDensityDownToItsLimit) {
  const double inside = tensionAfter(0, 0.99, 1e9);
  EXPECT_LT(inside, 0);
  EXPECT_EQ(tensionAfter(0, 1.01, 1e9), 0) << "nothing lacks";
  EXPECT_NEAR(tensionAfter(0, 0.996, 1e9), 0.4 * inside, 1e-12);
  EXPECT_GT(tensionAfter(0, 0.94, 1e9), 1.5 * inside) << "beside a gap";
  EXPECT_EQ(tensionAfter(0.4, 0.8, 1e9), 0) << "at a free surface";
  EXPECT_EQ(tensionAfter(0, 0.5, 1e9), 0) << "nearly alone";
  EXPECT_EQ(tensionAfter(0, 0.99, 0), 0) << "where it bears none";
}

/// What a wall fills does not lack: where the surface of a fluid ends at a wall, and where it is covered by one.
TEST(KeepsVolume, TheDensityAtRestIsKnownWhereASurfaceMeetsAWall) {
  const double open = 0.34, missing = 1 - Cover::of(open, 1).rest;
  for (const double wall : {0.1, 0.34, 0.5})
    EXPECT_NEAR(1 - Cover::of((1 - wall) * open, 1, wall).rest, (1 - wall) * missing, 1e-12);
  EXPECT_EQ(Cover::of(0, 1, 0.3).rest, 1);
  EXPECT_EQ(Cover::of(0.03, 1).tells, 1);
  EXPECT_EQ(Cover::of(0.1, 1).tells, 0) << "though it bears what its neighbours tell:";
  EXPECT_EQ(Cover::of(0.1, 1).bears, 1);
}

/// Of the particle at the origin of a lattice whose other particles, at integers, are moved or left out.
template <int D, class F>
double resistanceIn(F&& moved) {
  const Scene<D> s = makeScene<D>({.scheme = SchemeKind::Accurate});
  const MphPairs<D>& pairs = s.pairs();
  double n = 0, wide = 0;
  Vec<D> away{};
  constexpr int reach = 5, depth = D == 3 ? reach : 0;
  for (int z = -depth; z <= depth; ++z)
    for (int y = -reach; y <= reach; ++y)
      for (int x = -reach; x <= reach; ++x) {
        if (x == 0 && y == 0 && z == 0) continue;
        const std::optional<Vec<3>> place = moved(Vec<3>{double(x), double(y), double(z)});
        if (!place) continue;
        const Vec<D> d = resized<D>(pairs.spacing * *place);
        const ExactDistance r(norm2(d));
        n += pairs.terms.density(pairs.terms.densityFactor, r);
        wide += pairs.terms.openness(r);
        away += pairs.terms.openness(r) * d;
      }
  return Cover::resists(pairs.opennessFactor() * norm(away), n / pairs.restDensity, pairs.wideScale * wide, 0);
}

template <int D>
void checkResistance() {
  using Place = std::optional<Vec<3>>;
  const auto gap = [](double width) {
    return resistanceIn<D>([width](Vec<3> x) -> Place {
      return Vec<3>{x[0], x[1] + (x[1] > 0 ? width : 0), x[2]};
    });
  };
  const auto sheet = [](int below, int above) {
    return resistanceIn<D>(
        [=](Vec<3> x) -> Place { return x[1] >= -below && x[1] <= above ? Place(x) : Place(); });
  };
  EXPECT_EQ(gap(0), 1);
  for (const double width : {0.35, 0.5, 0.8, 1.0}) EXPECT_LE(gap(width), 1e-3) << width;
  EXPECT_GT(gap(0.05), 0.8);
  EXPECT_EQ(gap(2.5), 1) << "the other side is out of reach";
  for (int rows = 1; rows < 7; ++rows)
    for (int row = 0; row < rows; ++row)
      EXPECT_EQ(sheet(row, rows - 1 - row), 1) << "row " << row << " of a sheet of " << rows;
  for (int row = 0; row < 3; ++row) {
    EXPECT_EQ(sheet(9, row), 1) << "row " << row << " below a free surface";
    const auto corner = [row](Vec<3> x) { return x[0] <= row && x[1] <= row ? Place(x) : Place(); };
    EXPECT_EQ(resistanceIn<D>(corner), 1) << "row " << row << " at an edge";
  }
  EXPECT_EQ(resistanceIn<D>([](Vec<3> x) -> Place {
              return Vec<3>{1.5 * x[0], x[1] / 1.5, x[2]};
            }),
            1)
      << "a strained lattice";
}

/// The bulk viscosity holds no gap open, and all else together.
TEST(KeepsVolume, BulkViscosityIsLeftOutNextToGaps) {
  checkResistance<2>();
  checkResistance<3>();
}

/// The viscosity mu alone holds the layer above the gap: it sinks within some mu / (rho g h) = 0.09 s, and not
/// within lambda / (rho g h).
void checkSinking(bool onTheFloor, double share) {
  const Case c = layerWithGap(onTheFloor);
  Simulation<2> s(c, created<2>(c));
  const auto upper = [&] {
    double height = 0, count = 0;
    for (std::uint32_t i = 0; i < s.particles().fluidCount; ++i)
      if (s.particles().body[i] == 1) height += s.particles().position[i][1], ++count;
    return height / count;
  };
  const double start = upper(), gap = 5e-4;
  for (int k = 0; k < 200; ++k) s.advance();
  EXPECT_NEAR(start - upper(), gap, share * gap);
}

TEST(KeepsVolume, FluidSinksOverAGapInIt) { checkSinking(false, 0.02); }
TEST(KeepsVolume, FluidSinksOntoAWall) { checkSinking(true, 0.1); }

/// The gradient of the density's weight is its derivative.
TEST(KeepsVolume, TheForceOfATensionIsTheGradientOfTheDensity) {
  const Scene<2> s = makeScene<2>({.scheme = SchemeKind::Accurate});
  const MphTerms<2>& terms = s.pairs().terms;
  const double l = s.pairs().spacing, step = 1e-5 * l;
  const auto w = [&](double r) { return terms.density(terms.densityFactor, ExactDistance(r * r)); };
  for (const double r : {0.4 * l, l, 2.2 * l, 3.3 * l})
    EXPECT_NEAR(terms.densityGradient(ExactDistance(r * r)) * r, (w(r - step) - w(r + step)) / (2 * step),
                1e-7 * w(0.1 * l) / l);
  EXPECT_EQ(terms.densityGradient(ExactDistance(13 * l * l)), 0);
}

/// Tensions that differ pull all fluid together, and walls by as much as walls pull the fluid, whatever materials.
TEST(KeepsVolume, TensionForcesHaveNoSum) {
  Scene<2> s = makeScene<2>({.seed = 3, .jitter = 0.3, .scheme = SchemeKind::Accurate});
  const MphPairs<2>& pairs = s.pairs();
  std::vector<double> tension(pairs.activeCount);
  for (std::uint32_t i = 0; i < pairs.activeCount; ++i) tension[i] = -1.0 * (i % 7);
  std::vector<Vec<2>> force(pairs.activeCount);
  tensionForces<2>(s.context, pairs, pairs.fluidList, tension, force);
  tensionForces<2>(s.context, pairs, pairs.wallList, tension, force);
  Vec<2> sum{};
  double size = 0;
  for (const Vec<2>& f : force) sum += f, size += norm(f);
  EXPECT_GT(size, 0);
  EXPECT_LE(norm(sum), 1e-12 * size);
}

TEST(KeepsVolume, TheSofterOfTwoMaterialsTellsTheirTension) {
  Scene<2> s = makeScene<2>({.scheme = SchemeKind::Accurate});
  MphPairs<2> pairs = s.pairs();
  pairs.materials.bulkModulus[0] = 1e6, pairs.materials.bulkModulus[1] = 1e2;
  const auto pair = [&](Substance a, double p, Substance b, double q) {
    return pairTension(tensionShare(pairs, a, b), p, q);
  };
  EXPECT_EQ(pair(0, -3, 0, -5), -8) << "the sum inside of a material";
  EXPECT_NEAR(pair(0, -7, 1, -7), -14, 1e-12) << "which all of one tension have";
  EXPECT_NEAR(pair(0, -7, 1, -3), -6, 1e-3);
  EXPECT_NEAR(pair(0, -7, 1, -3), pair(1, -3, 0, -7), 1e-12);
  pairs.materials.bulkModulus[0] = pairs.materials.bulkModulus[1] = 0;
  EXPECT_EQ(pair(0, -3, 1, -5), -8);
}

/// A particle that neighbours crowd from one side.
TEST(KeepsVolume, ParticlesUnderTensionAreShiftedToWhereNeighboursLack) {
  const Scene<2> s = makeScene<2>({.scheme = SchemeKind::Accurate});
  const MphPairs<2>& pairs = s.pairs();
  const double dt = 1e-3, l = pairs.spacing, kappa = pairs.bulkModulus(0);
  const auto way = [&](double tension, double crowding) {
    const double sums[] = {crowding / l, 0, 2 / dt / shiftPerRate};
    return dt * (spreadVelocityOf<2>(pairs, 0, dt, tension, sums, {2, 3}) - Vec<2>{2, 3});
  };
  EXPECT_NEAR(way(-kappa, 0.01)[0], -0.01 * l, 1e-12 * l);
  EXPECT_EQ(way(-kappa, 0.01)[1], 0);
  EXPECT_NEAR(way(-0.5 * shiftedFrom * kappa, 0.01)[0], -0.005 * l, 1e-12 * l);
  EXPECT_NEAR(way(-kappa, 1e6)[0], -longestShift * l, 1e-12 * l);
  EXPECT_EQ(way(0, 0.01)[0], 0) << "without tension";
}

/// Whether a particle has neighbours across a periodic end.
bool meetsImages(const MphPairs<2>& pairs, std::uint32_t i) {
  for (std::uint32_t j = 0; j < pairs.activeCount; ++j) {
    const Vec<2> d = pairs.difference(i, j);
    if (norm(d) < pairs.terms.pressureRadius && norm(d - (pairs.position[j] - pairs.position[i])) > 0) return true;
  }
  return false;
}

/// A rigid rotation shifts nothing, a strain does.
TEST(KeepsVolume, NothingIsShiftedInFluidThatTurnsAsAWhole) {
  Scene<2> s = makeScene<2>({.seed = 3, .jitter = 0.3, .scheme = SchemeKind::Accurate});
  const MphPairs<2>& pairs = s.pairs();
  std::vector<Vec<2>> u(pairs.activeCount), transport(pairs.fluidCount);
  const std::vector<double> tension(pairs.activeCount, -1e9);
  for (const double strain : {0.0, 1.0}) {
    for (std::uint32_t i = 0; i < pairs.activeCount; ++i)
      u[i] = {-pairs.position[i][1] + strain * pairs.position[i][0], pairs.position[i][0]};
    spreadVelocities<2>(s.context, pairs, 1e-3, u, tension, transport);
    double shift = 0;
    for (std::uint32_t i = 0; i < pairs.fluidCount; ++i)
      if (!meetsImages(pairs, i)) shift = std::max(shift, norm(transport[i] - u[i]));
    if (strain == 0)
      EXPECT_LE(shift, 1e-12 * pairs.spacing);
    else
      EXPECT_GT(shift, 0.01 * pairs.spacing);
  }
}

}  // namespace
}  // namespace treacle::test
