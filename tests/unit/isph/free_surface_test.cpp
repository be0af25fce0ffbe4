#include "support/isph_scene.hpp"
#include "treacle/core/pseudo_random.hpp"

#include <gtest/gtest.h>

#include <map>

namespace treacle::test {
namespace {

constexpr SchemeKind schemes[] = {SchemeKind::Published, SchemeKind::Accurate};

/// A block of fluid in the middle of an open domain.
template <int D>
IsphScene<D> block(SchemeKind scheme, Vec<D, int> count, double jitter = 0) {
  Vec<3> size{};
  for (int k = 0; k < D; ++k) size[k] = count[k] + 10;
  Case c = waterCase(D, size);
  c.method.scheme = scheme;
  auto points = latticeAt<D>(Vec<D>::filled(5.5 * c.spacing), count, c.spacing);
  for (std::uint32_t i = 0; i < points.size(); ++i)
    for (int k = 0; k < D; ++k) points[i][k] += jitter * c.spacing * pseudoRandom(D * i + k);
  return {c, particlesAt<D>(points)};
}

/// Whether a particle, by its number in the block, stands in the block's outer layer.
template <int D>
bool isOuter(std::uint32_t id, const Vec<D, int>& count) {
  bool outer = false;
  for (int k = 0; k < D; id /= count[k], ++k) {
    const int place = static_cast<int>(id) % count[k];
    outer = outer || place == 0 || place == count[k] - 1;
  }
  return outer;
}

template <int D>
void checkBlock(SchemeKind scheme, Vec<D, int> count, double jitter) {
  const IsphScene<D> s = block<D>(scheme, count, jitter);
  for (std::uint32_t i = 0; i < s.n(); ++i)
    EXPECT_EQ(s.surface[i] != 0, isOuter<D>(s.particles.id[i], count))
        << D << "D, jitter " << jitter << ": density " << s.density[i] << ", lack of neighbours "
        << norm(s.deficit[i]) * s.c.spacing;
}

TEST(FreeSurface, OfABlockIsItsOuterLayer) {
  for (const SchemeKind scheme : schemes)
    for (const double jitter : {0.0, 0.02}) {
      checkBlock<2>(scheme, {12, 9}, jitter);
      checkBlock<2>(scheme, {40, 40}, jitter);
      checkBlock<3>(scheme, {9, 8, 7}, jitter);
    }
}

TEST(FreeSurface, SingleParticlesPairsAndThreadsAreAllSurface) {
  for (const SchemeKind scheme : schemes) {
    for (int length : {1, 2, 20}) {
      EXPECT_EQ(block<2>(scheme, {length, 1}).surfaceCount(), static_cast<std::uint32_t>(length));
      EXPECT_EQ(block<3>(scheme, {length, 1, 1}).surfaceCount(), static_cast<std::uint32_t>(length));
    }
    EXPECT_EQ(block<2>(scheme, {20, 2}).surfaceCount(), 40u);
    EXPECT_EQ(block<3>(scheme, {20, 2, 2}).surfaceCount(), 80u);
    EXPECT_EQ(block<3>(scheme, {9, 9, 1}).surfaceCount(), 81u);
    EXPECT_EQ(block<3>(scheme, {9, 9, 2}).surfaceCount(), 162u);
  }
}

/// Fluid that fills a periodic domain.
template <int D>
IsphScene<D> full(SchemeKind scheme, double jitter) {
  Case c = waterCase(D, {12, 12, D == 3 ? 12.0 : 0});
  c.method.scheme = scheme;
  for (int k = 0; k < D; ++k) c.domain.periodic[k] = true;
  const auto everywhere = [](const Vec<D>&) { return true; };
  return {c, jitteredLattice<D>(c, jitter, 3, everywhere, [](const Vec<D>&) { return false; })};
}

TEST(FreeSurface, AFullDomainHasNone) {
  for (const SchemeKind scheme : schemes)
    for (const double jitter : {0.0, 0.05}) {
      EXPECT_EQ(full<2>(scheme, jitter).surfaceCount(), 0u);
      EXPECT_EQ(full<3>(scheme, jitter).surfaceCount(), 0u);
    }
  for (const double density : full<3>(SchemeKind::Accurate, 0).density) EXPECT_NEAR(density, 1, 1e-13);
}

template <int D>
void checkTank(SchemeKind scheme) {
  Case c = waterCase(D, {20, 20, D == 3 ? 20.0 : 0});
  c.method.scheme = scheme;
  const double l = c.spacing;
  const auto inTank = [&](const Vec<D>& x) {
    bool inside = x[D - 1] > 4 * l;
    for (int k = 0; k < D - 1; ++k) inside = inside && x[k] > 4 * l && x[k] < 16 * l;
    return inside;
  };
  const IsphScene<D> s(c, jitteredLattice<D>(
                              c, 0, 1, [&](const Vec<D>& x) { return inTank(x) && x[D - 1] < 12 * l; },
                              [&](const Vec<D>& x) { return !inTank(x); }));
  // In a tank only the top is free, at the walls, too.
  for (std::uint32_t i = 0; i < s.n(); ++i)
    EXPECT_EQ(s.surface[i] != 0, s.particles.position[i][D - 1] > 11 * l) << D << "D: density " << s.density[i];
}

TEST(FreeSurface, OfATankIsItsTop) {
  for (const SchemeKind scheme : schemes) {
    checkTank<2>(scheme);
    checkTank<3>(scheme);
  }
}

TEST(FreeSurface, ParticlesJammedIntoWallsCount) {
  Case c = waterCase(3, {10, 10, 10});
  const double l = c.spacing;
  // One particle in the place of one in a full block of walls.
  const Vec<3> place = Vec<3>::filled(5.5 * l);
  const IsphScene<3> s(c, jitteredLattice<3>(
                              c, 0, 1, [&](const Vec<3>& x) { return norm(x - place) < 0.1 * l; },
                              [](const Vec<3>&) { return true; }));
  ASSERT_EQ(s.n(), 1u);
  EXPECT_NEAR(s.density[0], 1, 1e-12);
  EXPECT_EQ(s.surface[0], Place::Free);
}

}  // namespace
}  // namespace treacle::test
