#include "treacle/mph/mph_repulsion.hpp"
#include "support/oracle.hpp"
#include "support/tolerances.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace treacle::test {
namespace {

constexpr double rate = 1e3;  // 1 / dt of the scene

/// Jittered so far that particles come close to each other and to the floor.
template <int D>
Scene<D> crowd(unsigned seed = 1) {
  return makeScene<D>({.seed = seed, .jitter = 0.49, .scheme = SchemeKind::Accurate});
}

/// Forces per active particle.
template <int D>
std::vector<Vec<D>> forces(Scene<D>& s) {
  std::vector<Vec<D>> force(s.pairs().activeCount, Vec<D>{});
  const std::span<Vec<D>> all(force);
  addRepulsion<D>(s.context, s.pairs(), rate, all.first(s.n()));
  addRepulsionOnWalls<D>(s.context, s.pairs(), rate, all.subspan(s.n()));
  return force;
}

/// The largest force on a wall particle.
template <int D>
double checkForces(unsigned seed) {
  Scene<D> s = crowd<D>(seed);
  const Oracle<D> oracle(s);
  const std::vector<Vec<D>> found = forces(s);
  Vec<D> total{};
  double largest = 0, onWalls = 0;
  for (const Vec<D>& f : found) total += f, largest = std::max(largest, norm(f));
  for (std::uint32_t i = 0; i < s.pairs().activeCount; ++i) {
    Vec<D> expected{};
    for (std::uint32_t j = 0; j < (i < s.n() ? oracle.count() : s.n()); ++j) expected += oracle.repulsion(i, j);
    EXPECT_LE(norm(found[i] - expected), operatorTolerance * largest) << "particle " << i;
    if (i >= s.n()) onWalls = std::max(onWalls, norm(expected));
  }
  EXPECT_GT(largest, 0);
  EXPECT_LE(norm(total), operatorTolerance * largest);
  return onWalls;
}

TEST(Repulsion, IsEqualAndOppositeAndTheSumOverAllPairs) {
  double onWalls[2] = {};
  for (const unsigned seed : {1u, 2u, 3u, 4u}) {
    onWalls[0] += checkForces<2>(seed);
    onWalls[1] += checkForces<3>(seed);
  }
  EXPECT_GT(onWalls[0], 0);
  EXPECT_GT(onWalls[1], 0);
}

template <int D>
void checkPower() {
  Scene<D> s = crowd<D>();
  const std::uint32_t active = s.pairs().activeCount;
  const std::vector<Vec<D>> force = forces(s);
  const auto powerOf = [&](const std::vector<Vec<D>>& u) {
    std::vector<double> power(s.n());
    repulsionPower<D>(s.context, s.pairs(), rate, u, power);
    double sum = 0;
    for (const double p : power) sum += p;
    return sum;
  };
  const std::vector<Vec<D>> u = unflat<D>(randomVector(Index{D} * active, 4));
  double expected = 0, size = 0;
  for (std::uint32_t i = 0; i < active; ++i)
    expected += dot(force[i], u[i]), size += std::abs(dot(force[i], u[i]));
  EXPECT_GT(size, 0);
  EXPECT_NEAR(powerOf(u), expected, operatorTolerance * size);
  EXPECT_EQ(powerOf(std::vector<Vec<D>>(active, u[0])), 0);
}

TEST(Repulsion, WorksOnWhatMovesApartOnly) {
  checkPower<2>();
  checkPower<3>();
}

TEST(Repulsion, IsNotThereOnALatticeAndInThePublishedScheme) {
  Scene<2> lattice = makeScene<2>({.jitter = 0, .scheme = SchemeKind::Accurate});
  Scene<2> published = makeScene<2>({.jitter = 0.4});
  for (const Vec<2>& f : forces(lattice)) ASSERT_EQ(f, Vec<2>{});
  for (const Vec<2>& f : forces(published)) ASSERT_EQ(f, Vec<2>{});
}

/// However many particles are close: the stiffness of the repulsion times dt is at most their part of V, so that
/// the explicit force is as stable as an implicit one.
TEST(Repulsion, IsNotStifferThanTheViscosityOfItsPairs) {
  const MphTerms<2>& terms = crowd<2>().pairs().terms;
  const double reach = terms.repulsionRadius;
  for (double r = 0.02 * reach; r < reach; r *= 1.1) {
    const auto force = [&](double a) { return a * terms.repulsionShape(ExactDistance(a * a)); };
    const double h = 1e-4 * r, stiffness = (force(r - h) - force(r + h)) / (2 * h);
    EXPECT_LE(stiffness, 1.05 * terms.resistanceShape(ExactDistance(r * r)));
  }
}

}  // namespace
}  // namespace treacle::test
