#include "treacle/mph/surface_tension.hpp"

#include "support/scene.hpp"
#include "support/tolerances.hpp"
#include "treacle/mph/mph_particles.hpp"
#include "treacle/mph/mph_sums.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace treacle::test {
namespace {

/// A block of fluid that fills the domain across and leaves a plane surface below and above.
template <int D>
Case slabCase() {
  Case c = sceneCase(D, false, SchemeKind::Accurate);
  c.materials[0].surfaceTension = 0.07;
  for (int k = 0; k < D; ++k) {
    c.domain.min[k] = 0, c.domain.max[k] = 22 * c.spacing;
    c.domain.periodic[k] = k != D - 1;
  }
  return c;
}

/// What surface tension does to the fluid of a case.
template <int D>
struct Surface {
  Context<Cpu> context;
  Particles<D> particles;
  MphNeighbourhood<D> neighbourhood;
  SurfaceTerms<D> terms;
  std::vector<SurfaceSums<D>> sums;
  std::vector<SurfaceSlope<D>> slope;
  ClusterList<Cpu> walls;  // those of a step do not reach as far
  std::vector<WallSums<D>> atWalls;
  std::vector<Adhesion<D>> adhesion;
  std::vector<Vec<D>> smoothed, normal, force, unshared, even, ofWalls;
  std::vector<Vec<D>> stress, core;  // force and unshared before bendSurface()
  std::vector<SurfaceFit> fit, fitted;

  Surface(const Case& c, Particles<D>&& of)
      : particles(std::move(of)), neighbourhood(c), terms(SurfaceTerms<D>::make(c)) {
    std::fill(particles.material.data(), particles.material.data() + particles.count, 0);
    neighbourhood.sort(context, particles);
    neighbourhood.buildLists(context, particles);
    const std::uint32_t n = pairs().fluidCount;
    sums.resize(n), slope.resize(n), force.resize(n), unshared.resize(n), smoothed.resize(n), normal.resize(n);
    ofWalls.resize(n), fit.resize(n), fitted.resize(n), even.assign(n, Vec<D>{});
    atWalls.resize(pairs().activeCount - n), adhesion.resize(pairs().activeCount);
    buildClusterList<D>(context, pairs().grid, neighbourhood.ranges(), pairs().position,
                        {n, pairs().ownEnd(), {c.interactionRadius(), 0}, true}, walls);
    const SurfaceForces<D> forces{force, unshared, smoothed, normal, fit, ofWalls};
    const std::span<Adhesion<D>> adheres = adhesion;
    surfaceSlope<D>(context, pairs(), terms, sums, slope, adheres.first(n));
    wallAdhesion<D>(context, pairs(), terms, walls.view(), atWalls, adheres.subspan(n));
    surfaceForces<D>(context, pairs(), terms, sums, slope, adhesion, forces);
    stress = force, core = unshared;
    bendSurface<D>(context, pairs(), terms, forces, fitted);
    evenAlongSurface<D>(context, pairs(), terms, {normal, fit, force, even});
  }
  const MphPairs<D>& pairs() const { return neighbourhood.pairs(); }
};

template <int D>
struct Slab : Surface<D> {
  Case c = slabCase<D>();

  explicit Slab(double jitter)
      : Surface<D>(slabCase<D>(), jitteredLattice<D>(
                                      slabCase<D>(), jitter, 1,
                                      [l = slabCase<D>().spacing](const Vec<D>& x) {
                                        return x[D - 1] > 4 * l && x[D - 1] < 18 * l;
                                      },
                                      [](const Vec<D>&) { return false; })) {}
};

/// Tension of both surfaces from the virial of the pairs, as what their forces do along the first axis.
template <int D>
double tensionOf(const Slab<D>& s) {
  const MphPairs<D>& pairs = s.pairs();
  double virial = 0;
  for (std::uint32_t i = 0; i < pairs.fluidCount; ++i)
    for (std::uint32_t j = 0; j < i; ++j) {
      const Vec<D> d = pairs.difference(i, j);
      const auto stress = [&](const SurfaceSlope<D>& of) {
        return norm2(of.m) * d[0] - of.tie * dot(of.m, d) * of.m[0];
      };
      virial += s.terms.gradient(norm2(d)) * d[0] * (stress(s.slope[i]) + stress(s.slope[j]));
    }
  double area = 1;
  for (int k = 0; k < D - 1; ++k) area *= s.c.domain.max[k];
  return virial * std::pow(s.c.spacing, D) / (2 * area);
}

template <int D>
void checkPlane() {
  const Slab<D> s(0);
  EXPECT_NEAR(tensionOf(s) / 0.07, 1, 0.02);  // 0.983 in 2D and 0.985 in 3D
  double most = 0;
  for (std::size_t i = 0; i < s.force.size(); ++i)
    most = std::max({most, norm(s.stress[i]), norm(s.force[i] + s.unshared[i])});
  EXPECT_LE(most, 1e-9 * 0.07 / (s.c.spacing * s.c.spacing));
}

TEST(SurfaceTension, IsThatOfThePlaneSurfaceWhichBearsNoForce) {
  checkPlane<2>();
  checkPlane<3>();
}

template <int D>
void checkMomentum() {
  const Slab<D> s(0.3);
  Vec<D> total{};
  double sum = 0;
  for (std::size_t i = 0; i < s.force.size(); ++i) total += s.force[i] + s.unshared[i], sum += norm(s.stress[i]);
  EXPECT_GT(sum, 0);
  EXPECT_LE(norm(total), operatorTolerance * sum);
  EXPECT_NEAR(tensionOf(s) / 0.07, 1, 0.45);  // 1.34 in 2D and 1.38 in 3D: a rough surface is larger
}

TEST(SurfaceTension, ForcesAreEqualAndOpposite) {
  checkMomentum<2>();
  checkMomentum<3>();
}

template <int D>
void checkEven() {
  const Slab<D> s(0.3);
  Vec<D> change{};
  double sum = 0, before = 0, after = 0;
  for (std::size_t i = 0; i < s.force.size(); ++i) {
    change += s.even[i] - s.force[i], sum += norm(s.force[i]);
    for (int k = 0; k < D - 1; ++k) before += s.force[i][k] * s.force[i][k], after += s.even[i][k] * s.even[i][k];
  }
  EXPECT_LE(norm(change), operatorTolerance * sum);
  EXPECT_LE(after, 0.4 * before);
}

TEST(SurfaceTension, ForcesAlongTheSurfaceAreSharedAmongNeighbours) {
  checkEven<2>();
  checkEven<3>();
}

/// A disc or a ball of the lattice, with its centre in the middle of the domain.
template <int D>
struct Drop : Surface<D> {
  int spacings;  // in the radius

  explicit Drop(int inRadius)
      : Surface<D>(dropCase(inRadius), jitteredLattice<D>(
                                           dropCase(inRadius), 0, 1,
                                           [inRadius, c = dropCase(inRadius)](const Vec<D>& x) {
                                             return norm(x - Vec<D>::filled(c.domain.max[0] / 2)) <
                                                    inRadius * c.spacing;
                                           },
                                           [](const Vec<D>&) { return false; })),
        spacings(inRadius) {}
  static Case dropCase(int inRadius) {
    Case c = slabCase<D>();
    for (int k = 0; k < D; ++k) c.domain.max[k] = 2 * (inRadius + 2) * c.spacing, c.domain.periodic[k] = false;
    return c;
  }
  double spacing() const { return dropCase(spacings).spacing; }
  Vec<D> fromMiddle(std::uint32_t i) const {
    return this->pairs().position[i] - Vec<D>::filled((spacings + 2) * spacing());
  }
  /// What bendSurface() adds [N/m3].
  Vec<D> bend(std::uint32_t i) const {
    return this->force[i] + this->unshared[i] - this->stress[i] - this->core[i];
  }
};

/// Mean depth of the tension of a plane surface, from its pairs.
template <int D>
double depthOf(const Slab<D>& s) {
  double sum = 0, moment = 0;
  for (std::uint32_t i = 0; i < s.pairs().fluidCount; ++i)
    for (std::uint32_t j = 0; j < i; ++j) {
      const Vec<D> d = s.pairs().difference(i, j);
      const double height = s.pairs().position[i][D - 1] + d[D - 1] / 2;
      if (height < 11 * s.c.spacing) continue;
      const double part = s.terms.gradient(norm2(d)) * d[0] * d[0] * (norm2(s.slope[i].m) + norm2(s.slope[j].m));
      sum += part, moment += part * (18 * s.c.spacing - height);
    }
  return moment / sum;
}

/// Along a curved surface the tension is lessened by gamma delta over the radius, where delta is the depth at
/// which it acts and, for each direction that is curved, the second moment of w in the plane of the surface: over
/// that, in a drop of so many spacings, by the virial.
template <int D>
double bending(int inRadius) {
  const Drop<D> s(inRadius);
  const double volume = std::pow(s.spacing(), D), pi = std::numbers::pi;
  const double h = Drop<D>::dropCase(inRadius).interactionRadius();
  // 13/12 times 6.5/pi B(3/2, 6.5) and, in 3D, 1/(195 B(3/2, 6.5)) of h, B being Euler's function: p(1/2) and
  // moments of w without a lattice.
  const double delta = depthOf(Slab<D>(0)) + (D == 2 ? 0.1135 : 2 * 0.1097) * h;
  double virial = 0, torque = 0, size = 0;
  Vec<D> total{};
  for (std::uint32_t i = 0; i < s.pairs().fluidCount; ++i) {
    const Vec<D> bend = s.bend(i), x = s.fromMiddle(i);
    virial += volume * dot(bend, x);
    total += bend, size += norm(bend);
    torque += x[0] * bend[1] - x[1] * bend[0];
  }
  const double particles = volume * s.pairs().fluidCount;
  const double radius = D == 2 ? std::sqrt(particles / pi) : std::cbrt(particles / (4 * pi / 3));
  EXPECT_LE(norm(total), operatorTolerance * size);
  EXPECT_LE(std::abs(torque), operatorTolerance * size * radius);
  return virial / (0.07 * delta * (D == 2 ? 2 * pi : 8 * pi * radius));
}

TEST(SurfaceTension, FallsWithTheCurvatureByItsDepth) {
  // Of rows along the surface, which drops get, it is 1 in 2D; that all directions of the lattice have more in the
  // mean does not depend on the size.
  EXPECT_NEAR(bending<2>(20), 1.17, 0.02);
  EXPECT_NEAR(bending<2>(40), 1.17, 0.02);
  // Each direction's curvature lessens the tension across it, too, by a third.
  EXPECT_NEAR(bending<3>(18), 1.17 * 4 / 3, 0.1);
}

/// What is shared of the forces on a drop is noise: what presses on it is not.
template <int D>
void checkSmooth() {
  const Drop<D> s(D == 2 ? 20 : 9);
  double pressing = 0, shared = 0;
  for (std::uint32_t i = 0; i < s.pairs().fluidCount; ++i) {
    pressing -= dot(s.stress[i], s.fromMiddle(i));
    shared -= dot(s.force[i] - s.bend(i), s.fromMiddle(i));
  }
  EXPECT_GT(pressing, 0);
  EXPECT_LE(std::abs(shared), 0.25 * pressing);  // 0.16: steps of the lattice
}

TEST(SurfaceTension, WhatPressesOnADropIsNotShared) {
  checkSmooth<2>();
  checkSmooth<3>();
}

TEST(SurfaceTension, WallsPullFluidsByTheAngleOfBoth) {
  Case c = slabCase<2>();
  c.materials.resize(3, c.materials[0]);
  c.materials[0].name = "honey", c.materials[1].name = "syrup", c.materials[2].name = "glass";
  c.materials[2].contactAngle = 120, c.materials[2].contactAngles = {{"syrup", 40}};
  const auto both = SurfaceTerms<2>::make(c);
  c.materials[2].contactAngles.clear();
  const auto honey = SurfaceTerms<2>::make(c);
  c.materials[2].contactAngle = 40;
  const auto syrup = SurfaceTerms<2>::make(c);
  EXPECT_LT(both.pull(0, 2), 0);
  EXPECT_EQ(both.pull(0, 2), honey.pull(0, 2));
  EXPECT_GT(both.pull(1, 2), 0);
  EXPECT_EQ(both.pull(1, 2), syrup.pull(1, 2));
  EXPECT_NEAR(both.pull(1, 0), 0, 1e-15);  // 90 degrees unless told
}

/// A particle on a plane surface is drawn to it, other than those of the surface.
template <int D>
void checkLone() {
  const Case c = slabCase<D>();
  const double l = c.spacing;
  const Surface<D> s(c, jitteredLattice<D>(
                            c, 0, 1,
                            [l](const Vec<D>& x) {
                              bool lone = x[D - 1] > 18 * l && x[D - 1] < 19 * l;
                              for (int k = 0; k < D - 1; ++k) lone = lone && x[k] > 10 * l && x[k] < 11 * l;
                              return lone || (x[D - 1] > 4 * l && x[D - 1] < 18 * l);
                            },
                            [](const Vec<D>&) { return false; }));
  std::uint32_t loose = 0;
  for (std::uint32_t i = 0; i < s.pairs().fluidCount; ++i) {
    if (s.slope[i].tie == 1) continue;
    ++loose;
    EXPECT_GT(s.pairs().position[i][D - 1], 18 * l);
    EXPECT_LT(s.stress[i][D - 1], -0.05 * 0.07 / (l * l));
  }
  EXPECT_EQ(loose, 1u);
}

TEST(SurfaceTension, DrawsBackWhatStandsOnTheSurfaceAlone) {
  checkLone<2>();
  checkLone<3>();
}

/// Half of a block with a vertical edge on a floor, right of the middle; the lower half of the domain is wall.
template <int D>
struct EdgeOnFloor : Surface<D> {
  Case c;
  std::vector<Vec<D>> reaction, load;

  EdgeOnFloor(double angle, double jitter)
      : Surface<D>(edgeCase(angle), edge(edgeCase(angle), jitter)), c(edgeCase(angle)) {
    const MphPairs<D>& pairs = this->pairs();
    const std::uint32_t n = pairs.fluidCount;
    reaction.resize(pairs.activeCount - n), load.assign(pairs.activeCount - n, Vec<D>::filled(2));
    surfaceOnWalls<D>(this->context, pairs, this->terms, this->walls.view(),
                      {this->ofWalls, this->adhesion, reaction, load});
  }
  static Case edgeCase(double angle) {
    Case c = slabCase<D>();
    c.materials[0].contactAngle = angle, c.domain.periodic[0] = false;
    return c;
  }
  static Particles<D> edge(const Case& c, double jitter) {
    const double l = c.spacing;
    return jitteredLattice<D>(
        c, jitter, 1, [&](const Vec<D>& x) { return x[D - 1] > 8 * l && x[D - 1] < 21 * l && x[0] < 11 * l; },
        [&](const Vec<D>& x) { return x[D - 1] < 8 * l; });
  }
  /// What the walls do to the fluid at the right edge, over gamma and the length of the line; on a lattice nothing
  /// has to be kept apart.
  Vec<D> atLine() const {
    Vec<D> sum{};
    const auto& position = this->pairs().position;
    for (std::uint32_t i = 0; i < this->sums.size(); ++i)
      if (position[i][0] > 5.5 * c.spacing && position[i][D - 1] < 14 * c.spacing)
        sum += this->ofWalls[i] * this->sums[i].walls + this->core[i];
    const double line = D == 3 ? c.domain.max[1] : 1;  // in 2D per metre of depth
    return sum * (std::pow(c.spacing, D) / (c.materials[0].surfaceTension * line));
  }
};

/// The vertical edge pulls at the wall, which holds it; along the wall it pulls as Young's equation says, by what
/// was found to give the angle (surface_terms.cpp).
template <int D>
void checkLine() {
  // K(45) = 1.04 cos 45 and, in 3D, cos 45, K(135) = (1.1 + 1.1 cos^6 135) cos 135
  for (const auto& [angle, along] :
       {std::pair(45.0, D == 2 ? 0.735 : 0.707), std::pair(90.0, 0.0), std::pair(135.0, -0.875)}) {
    SCOPED_TRACE(angle);
    const Vec<D> pull = EdgeOnFloor<D>(angle, 0).atLine();
    EXPECT_NEAR(pull[0], along, 0.15);
    EXPECT_NEAR(pull[D - 1], -1, 0.2);
  }
}

TEST(SurfaceTension, IsHeldByWallsAndPulledAlongThem) {
  checkLine<2>();
  checkLine<3>();
}

/// Next to a line the wall hides half of the stress along it, which l makes up for; far from it there is nothing.
TEST(SurfaceTension, IsMadeUpForAlongTheLineWhereWallsHideIt) {
  const EdgeOnFloor<3> s(90, 0);
  const double l = s.c.spacing;
  const auto& x = s.pairs().position;
  std::size_t atLine = 0;
  for (std::size_t i = 0; i < s.slope.size(); ++i) {
    const SurfaceSlope<3>& of = s.slope[i];
    const double m2 = norm2(of.m), line2 = norm2(of.line), walls = s.sums[i].walls;
    if (walls == 0) {
      EXPECT_EQ(line2, 0);
    }
    if (x[i][0] > 10 * l && x[i][2] < 9 * l) {
      ++atLine;
      EXPECT_NEAR(line2, of.line[1] * of.line[1], 1e-12 * m2);
      EXPECT_NEAR(line2, m2 * walls / (1 - walls), 0.05 * m2);
      EXPECT_GT(line2, 0.5 * m2);
    }
    if (x[i][0] > 4.6 * l && x[i][0] < 6.4 * l) {
      EXPECT_LE(line2, 1e-12 * s.terms.tension[0] / l);
    }
  }
  EXPECT_GT(atLine, 0u);
}

template <int D>
void checkReaction() {
  const EdgeOnFloor<D> s(60, 0.3);
  Vec<D> total{};
  double sum = 0;
  for (std::size_t i = 0; i < s.stress.size(); ++i) total += s.stress[i] + s.core[i], sum += norm(s.stress[i]);
  for (std::size_t j = 0; j < s.reaction.size(); ++j) {
    total += s.reaction[j];
    EXPECT_LE(norm(s.load[j] - s.reaction[j] - Vec<D>::filled(2)), 1e-12 * sum);
  }
  EXPECT_LE(norm(total), operatorTolerance * sum);
}

/// Lines pull at single particles, and the forces of those stay theirs. Of the others the torque stays, too.
template <int D>
void checkNearWalls() {
  const EdgeOnFloor<D> s(60, 0.3);
  const auto& x = s.pairs().position;
  std::size_t near = 0, changed = 0;
  double torque = 0, size = 0;
  for (std::size_t i = 0; i < s.force.size(); ++i) {
    const Vec<D> change = s.even[i] - s.force[i];
    torque += x[i][0] * change[D - 1] - x[i][D - 1] * change[0];
    size += norm(x[i]) * norm(change);
    const bool same = norm(change) == 0;
    if (s.sums[i].walls > 0) {
      ++near;
      EXPECT_TRUE(same);
    }
    if (!same) ++changed;
  }
  EXPECT_GT(near, 0u);
  EXPECT_GT(changed, 0u);
  EXPECT_LE(std::abs(torque), operatorTolerance * size);
}

TEST(SurfaceTension, SharedForcesKeepTheirTorqueAndThoseNearWallsTheirPlace) {
  checkNearWalls<2>();
  checkNearWalls<3>();
}

/// A particle between two of them may have all of its neighbourhood, and more, in the walls.
TEST(SurfaceTension, WallsThatCloseUpOnAParticleHoldItAsFirmlyAsBefore) {
  const SurfaceTerms<2> terms = SurfaceTerms<2>::make(slabCase<2>());
  const auto pullOf = [&](double walls) {
    const SurfaceSums<2> sums{{0, 10}, {300, 5}, 0.05, walls, 0.3, walls, 0.5 * walls};
    return terms.ofWalls(sums, terms.slope(0, sums).m, {-1e9, 0});
  };
  const Vec<2> before = pullOf(0.95);
  EXPECT_GT(before[0], 0);  // towards the walls
  for (const double walls : {1.0, 1.05}) EXPECT_LT(norm(pullOf(walls) - before), 0.2 * norm(before)) << walls;
}

TEST(SurfaceTension, OfWallsHasAReaction) {
  checkReaction<2>();
  checkReaction<3>();
}

/// Inside of a block on a floor that it wets, and at the floor below it, pressures below zero are borne, at its
/// surfaces not, and beside walls that it does not wet neither.
template <int D>
void checkAdhesion(double angle) {
  SCOPED_TRACE(angle);
  const EdgeOnFloor<D> s(angle, 0);
  const MphPairs<D>& pairs = s.pairs();
  const double l = s.c.spacing;
  std::size_t inside = 0, outermost = 0, covered = 0;
  for (std::uint32_t i = 0; i < pairs.activeCount; ++i) {
    const Vec<D>& x = pairs.position[i];
    const bool wall = i >= pairs.fluidCount, middle = x[0] > 4 * l && x[0] < 7 * l;
    const bool nearWall = x[D - 1] < 11.5 * l;
    const double bears = nearWall && angle > 90 ? 0 : 1;
    const double found = s.adhesion[i].bears;
    if (!wall && middle && x[D - 1] < 17 * l) {
      ++inside;
      EXPECT_EQ(found, bears);
      EXPECT_NEAR(s.adhesion[i].rest, 1, 1e-3);
    }
    if (!wall && x[D - 1] > 20 * l) {
      ++outermost;
      EXPECT_LT(found, 0.1);
    }
    if (wall && middle && x[D - 1] > 7 * l) {
      ++covered;
      EXPECT_EQ(found, bears);
    }
    if (wall && x[0] > 15 * l) {
      EXPECT_EQ(found, 0);
    }
  }
  EXPECT_GT(inside, 0u);
  EXPECT_GT(outermost, 0u);
  EXPECT_GT(covered, 0u);
}

TEST(SurfaceTension, PressuresBelowZeroAreBorneInsideAndWhereWallsAreWetted) {
  for (const double angle : {60.0, 120.0}) {
    checkAdhesion<2>(angle);
    checkAdhesion<3>(angle);
  }
}

/// A plane lattice is at rest by itself: where its outermost rows bear tension, too, they have none.
template <int D>
void checkRest() {
  const Slab<D> s(0);
  std::vector<double> n(s.pairs().activeCount), elastic(n.size());
  Context<Cpu> context;
  numberDensity<D>(context, s.pairs(), n);
  for (std::size_t i = 0; i < n.size(); ++i) EXPECT_NEAR(n[i] / s.pairs().restDensity, s.adhesion[i].rest, 1e-12);
  for (double& one : n) one *= 0.99;  // stretched
  elasticPressure<D>(context, s.pairs(), n, s.adhesion, elastic);
  const double kappa = s.c.materials[0].bulkModulus;
  for (std::size_t i = 0; i < n.size(); ++i)
    EXPECT_NEAR(elastic[i], -0.01 * kappa * s.adhesion[i].bears * s.adhesion[i].rest * s.pairs().restDensity,
                1e-9 * kappa);
}

TEST(SurfaceTension, PlaneLatticesHaveNoPressureAndResistStretching) {
  checkRest<2>();
  checkRest<3>();
}

}  // namespace
}  // namespace treacle::test
