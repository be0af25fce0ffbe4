#include "treacle/model/particles/create.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "sample_case.hpp"
#include "treacle/core/error.hpp"

namespace treacle::test {
namespace {

using testing::ElementsAre;
using testing::ElementsAreArray;
using testing::HasSubstr;
using testing::IsEmpty;

template <int D>
std::string messageOfCreation(const Case& c) {
  std::vector<std::string> notes;
  try {
    createParticles<D>(c, notes);
  } catch (const InputError& e) {
    return e.what();
  }
  return "no error";
}

template <int D>
double leastDistance(const Particles<D>& p) {
  double least = 1e300;
  for (std::uint32_t i = 0; i < p.count; ++i)
    for (std::uint32_t j = 0; j < i; ++j) least = std::min(least, norm(p.position[i] - p.position[j]));
  return least;
}

TEST(createParticles, takesFluidOffItsLatticeAtRandom) {
  Case c = emptyCase(2);
  c.bodies = {makeBody("wall", BodyKind::Wall, box({-40, -2}, {0, 3})),
              makeBody("drop", BodyKind::Fluid, box({0, 0}, {40, 40}))};
  std::vector<std::string> notes;
  const Particles<2> even = createParticles<2>(c, notes);
  c.bodies[1].disorder = 0.3;
  const Particles<2> p = createParticles<2>(c, notes);
  Vec<2> mean{}, square{};
  for (std::uint32_t i = 0; i < p.count; ++i) {
    const Vec<2> way = p.position[i] - even.position[i];
    if (i >= p.fluidCount) {
      EXPECT_EQ(way, Vec<2>{}) << "walls stay";
    }
    for (int k = 0; k < 2; ++k) {
      EXPECT_LT(std::abs(way[k]), 0.3 * c.spacing);
      mean[k] += way[k] / p.fluidCount, square[k] += way[k] * way[k] / p.fluidCount;
    }
  }
  for (int k = 0; k < 2; ++k) {
    EXPECT_NEAR(mean[k], 0, 0.02 * c.spacing);
    EXPECT_NEAR(std::sqrt(3 * square[k]), 0.3 * c.spacing, 0.02 * c.spacing);
  }
  // Whoever makes them, of however many processes.
  const Particles<2> part = createParticles<2>(c, notes, nullptr, {1, 3});
  ASSERT_GT(part.fluidCount, 0u);
  for (std::uint32_t i = 0; i < part.fluidCount; ++i) EXPECT_EQ(part.position[i], p.position[part.id[i]]);
}

TEST(createParticles, fillsBoxesWithCellCentredLattices) {
  Case c = emptyCase(2);
  c.materials.push_back(c.materials[0]);
  c.bodies = {makeBody("wall", BodyKind::Wall, box({-4, -2}, {0, 3})),
              makeBody("drop", BodyKind::Fluid, box({0, 0}, {3, 2}))};
  c.bodies[0].velocity = {0, 7};
  c.bodies[1].velocity = {5, 0};
  c.bodies[1].material = 1;
  std::vector<std::string> notes;
  std::vector<BodyCount> counts;
  const Particles<2> p = createParticles<2>(c, notes, &counts);
  EXPECT_THAT(notes, IsEmpty());
  EXPECT_THAT(counts, ElementsAre(BodyCount{0, 20}, BodyCount{6, 0}));
  ASSERT_EQ(p.fluidCount, 6u);
  ASSERT_EQ(p.wallCount(), 20u);
  // Fluid first although its body comes second in the file, x fastest.
  EXPECT_EQ(p.position[0], (Vec<2>{0.5, 0.5}));
  EXPECT_EQ(p.position[1], (Vec<2>{1.5, 0.5}));
  EXPECT_EQ(p.position[3], (Vec<2>{0.5, 1.5}));
  EXPECT_EQ(p.position[6], (Vec<2>{-3.5, -1.5}));
  for (std::uint32_t i = 0; i < p.count; ++i) {
    const bool fluid = i < 6;
    EXPECT_EQ(p.velocity[i], fluid ? (Vec<2>{5, 0}) : (Vec<2>{0, 7}));
    EXPECT_EQ(p.material[i], fluid ? 1 : 0);
    EXPECT_EQ(p.body[i], fluid ? 1 : 0);
    EXPECT_EQ(p.id[i], i);
    EXPECT_EQ(p.pressure[i], 0);
    EXPECT_EQ(p.numberDensity[i], 0);
  }
}

TEST(createParticles, roundsBoxesToWholeNumbersAndSaysSo) {
  Case c = emptyCase(3);
  c.spacing = 1e-3;
  c.bodies = {makeBody("column", BodyKind::Fluid, box({0, 0, 0}, {20.4e-3, 0.2e-3, 2e-3}))};
  std::vector<std::string> notes;
  EXPECT_EQ(createParticles<3>(c, notes).count, 20u * 1 * 2);
  EXPECT_THAT(notes,
              ElementsAre("body 'column': 20.4 mm along x is 20.4 spacings; filled with 20 particles from its "
                          "min corner (20 mm)",
                          "body 'column': 0.2 mm along y is 0.2 spacings; filled with 1 particle from its "
                          "min corner (1 mm)"));
}

/// How far the first wall particle of a body stands behind the face of the fluid that it faces, in two dimensions.
double depthBehindFluid(const Case& c, int body, int axis, double face) {
  std::vector<std::string> notes;
  const Particles<2> p = createParticles<2>(c, notes);
  double depth = 1e300;
  for (std::uint32_t i = p.fluidCount; i < p.count; ++i)
    if (p.body[i] == body) depth = std::min(depth, std::abs(p.position[i][axis] - face));
  return depth;
}

TEST(createParticles, wallsOfBrokenThicknessBeginAtTheFluid) {
  Case c = emptyCase(2);
  c.bodies = {makeBody("fluid", BodyKind::Fluid, box({0, 0}, {10, 10})),
              makeBody("left", BodyKind::Wall, box({-3.4, -3.4}, {0, 10})),
              makeBody("right", BodyKind::Wall, box({12, 0}, {15.6, 10})),
              makeBody("floor", BodyKind::Wall, box({0, -3.6}, {15.6, 0})),
              makeBody("lid", BodyKind::Wall, box({0, 13}, {15.6, 16.6}))};
  EXPECT_NEAR(depthBehindFluid(c, 1, 0, 0), 0.5, 1e-9);
  EXPECT_NEAR(depthBehindFluid(c, 2, 0, 12), 0.5, 1e-9);
  EXPECT_NEAR(depthBehindFluid(c, 3, 1, 0), 0.5, 1e-9);
  EXPECT_NEAR(depthBehindFluid(c, 4, 1, 13), 0.5, 1e-9);

  // The same plate stood upside down: its corner `min` faces the fluid then.
  c.bodies[3].shape = box({0, 0}, {15.6, 3.6});
  c.bodies[3].shape.transform = Transform{.angles = {0, 0, 180}};
  c.bodies[3].shape.transform->translate = {15.6, 0, 0};
  EXPECT_NEAR(depthBehindFluid(c, 3, 1, 0), 0.5, 1e-9);
}

TEST(createParticles, extentsThatMissWholeNumbersByRoundingAreWhole) {
  Case c = emptyCase(2);
  c.spacing = 1e-3 / 64;
  c.bodies = {makeBody("column", BodyKind::Fluid, box({0.1, 0.3}, {0.12, 0.302}))};
  std::vector<std::string> notes;
  EXPECT_EQ(createParticles<2>(c, notes).count, 1280u * 128);
  EXPECT_THAT(notes, IsEmpty());
}

TEST(createParticles, discHasPointAtCentre) {
  Case c = emptyCase(2);
  c.bodies = {makeBody("disc", BodyKind::Fluid, sphere({0.25, -3.5}, 2))};
  std::vector<std::string> notes;
  const Particles<2> p = createParticles<2>(c, notes);
  EXPECT_EQ(p.count, 13u);  // lattice points within distance 2 of the origin
  EXPECT_EQ(std::count(p.position.begin(), p.position.end(), (Vec<2>{0.25, -3.5})), 1);
}

TEST(createParticles, ballAndItsShellPartTheLattice) {
  Case c = emptyCase(3);
  c.bodies = {makeBody("all", BodyKind::Fluid, sphere({0, 0, 0}, 5))};
  std::vector<std::string> notes;
  const std::uint32_t whole = createParticles<3>(c, notes).count;
  EXPECT_EQ(whole, 515u);  // points of the cubic lattice within distance 5: OEIS A000605
  c.bodies = {makeBody("ball", BodyKind::Fluid, sphere({0, 0, 0}, 3)),
              makeBody("shell", BodyKind::Wall, sphere({0, 0, 0}, 5, 3))};
  const Particles<3> p = createParticles<3>(c, notes);
  EXPECT_EQ(p.fluidCount, 123u);
  EXPECT_EQ(p.count, whole);
}

TEST(createParticles, cylinderHasLayersInTheMiddleOfSlices) {
  Case c = emptyCase(3);
  c.bodies = {makeBody("rod", BodyKind::Fluid, cylinder({1, 2, 3}, {1, 2, 7}, 1))};
  std::vector<std::string> notes;
  const Particles<3> p = createParticles<3>(c, notes);
  EXPECT_EQ(p.count, 4u * 5);
  const auto [low, high] =
      std::minmax_element(p.position.begin(), p.position.end(), [](auto& a, auto& b) { return a[2] < b[2]; });
  EXPECT_DOUBLE_EQ((*low)[2], 3.5);
  EXPECT_DOUBLE_EQ((*high)[2], 6.5);
}

TEST(createParticles, cylinderInTwoDimensionsIsStrip) {
  Case c = emptyCase(2);
  c.bodies = {makeBody("channel", BodyKind::Wall, cylinder({0, 0}, {10, 0}, 4, 2)),
              makeBody("stream", BodyKind::Fluid, cylinder({0, 0}, {10, 0}, 2))};
  std::vector<std::string> notes;
  const Particles<2> p = createParticles<2>(c, notes);
  EXPECT_EQ(p.fluidCount, 10u * 5);
  EXPECT_EQ(p.wallCount(), 10u * 4);
}

TEST(createParticles, earlierBodyKeepsThePlace) {
  Case c = emptyCase(2);
  c.bodies = {makeBody("first", BodyKind::Fluid, box({0, 0}, {4, 4})),
              makeBody("second", BodyKind::Fluid, box({2.2, 0}, {6.2, 4}))};
  std::vector<std::string> notes;
  std::vector<BodyCount> counts;
  const Particles<2> p = createParticles<2>(c, notes, &counts);
  EXPECT_THAT(counts, ElementsAre(BodyCount{16, 0}, BodyCount{8, 0}));
  EXPECT_THAT(notes,
              ElementsAre("body 'second': 8 of 16 particles left out, their place is taken by body 'first'"));
  EXPECT_GE(leastDistance(p), 0.5);
  EXPECT_EQ(p.position[16], (Vec<2>{4.7, 0.5}));
  for (std::uint32_t i = 0; i < p.count; ++i) EXPECT_EQ(p.body[i], i < 16 ? 0 : 1);
}

/// Of several processes each makes a part; together they have what one makes, with notes and numbers of the whole.
TEST(createParticles, partsMakeTheWhole) {
  Case c = emptyCase(2);
  c.bodies = {makeBody("floor", BodyKind::Wall, box({0, -3}, {7, 0})),
              makeBody("first", BodyKind::Fluid, box({0, 0}, {4, 4})),
              makeBody("second", BodyKind::Fluid, box({2.2, 0}, {6.2, 4})),
              makeBody("third", BodyKind::Fluid, box({0, 5}, {1, 6}))};
  c.bodies[1].velocityExpression[0] = "x + 3*y";
  c.bodies[2].velocity = {0, -1};
  c.method = defaultMethod(SchemeKind::Accurate);
  std::vector<std::string> notes;
  std::vector<BodyCount> counts;
  const Particles<2> whole = createParticles<2>(c, notes, &counts);
  ASSERT_EQ(whole.fluidCount, 25u);
  ASSERT_EQ(whole.wallSurface.size(), 21u);
  for (const std::uint32_t parts : {1u, 2u, 3u, 7u, 25u, 40u}) {
    std::uint32_t fluid = 0, walls = whole.fluidCount;
    for (std::uint32_t k = 0; k < parts; ++k) {
      std::vector<std::string> ownNotes;
      std::vector<BodyCount> ownCounts;
      const Particles<2> p = createParticles<2>(c, ownNotes, &ownCounts, {k, parts});
      EXPECT_EQ(ownNotes, notes);
      EXPECT_EQ(ownCounts, counts);
      EXPECT_EQ(p.wallSurface.size(), p.wallCount());
      EXPECT_NEAR(p.fluidCount, 25.0 / parts, 1);
      EXPECT_NEAR(p.wallCount(), 21.0 / parts, 1);
      for (std::uint32_t i = 0; i < p.count; ++i) {
        const bool isFluid = i < p.fluidCount;
        const std::uint32_t j = isFluid ? fluid++ : walls++;
        EXPECT_EQ(p.id[i], whole.id[j]);
        EXPECT_EQ(p.position[i], whole.position[j]);
        EXPECT_EQ(p.velocity[i], whole.velocity[j]);
        EXPECT_EQ(p.body[i], whole.body[j]);
        EXPECT_EQ(p.material[i], whole.material[j]);
        if (!isFluid) {
          EXPECT_EQ(p.wallSurface[i - p.fluidCount], whole.wallSurface[j - whole.fluidCount]);
        }
      }
    }
    EXPECT_EQ(fluid, whole.fluidCount);
    EXPECT_EQ(walls, whole.count);
  }
}

TEST(createParticles, conditionsCutBodies) {
  Case c = emptyCase(2);
  c.bodies = {makeBody("sea", BodyKind::Fluid, box({0, 0}, {20, 10})),
              makeBody("bed", BodyKind::Wall, box({0, 0}, {20, 10}))};
  // A wavy surface between lattice points: fluid above, wall below.
  c.bodies[0].where = "y > 4.2 + 2*sin(2*pi*x/20)";
  c.bodies[1].where = "y <= 4.2 + 2*sin(2*pi*x/20)";
  std::vector<std::string> notes;
  std::vector<BodyCount> counts;
  const Particles<2> p = createParticles<2>(c, notes, &counts);
  EXPECT_THAT(notes, IsEmpty());
  EXPECT_EQ(p.count, 200u);
  EXPECT_EQ(counts[0].all() + counts[1].all(), 200u);
  for (std::uint32_t i = 0; i < p.count; ++i)
    EXPECT_EQ(p.position[i][1] > 4.2 + 2 * std::sin(M_PI * p.position[i][0] / 10), i < p.fluidCount);
}

/// The ball's lattice does not meet that of the box: what is too near its particles goes as well as what is inside
/// it.
TEST(createParticles, bodiesAreSubtracted) {
  Case c = emptyCase(2);
  c.bodies = {makeBody("sea", BodyKind::Fluid, box({0, 0}, {20, 20})),
              makeBody("ball", BodyKind::Wall, sphere({10.2, 9.7}, 4)),
              makeBody("core", BodyKind::Fluid, sphere({10.2, 9.7}, 2))};
  EXPECT_THAT(messageOfCreation<2>(c), HasSubstr("subtract = [\"ball\"] of 'sea' leaves it the room"));
  c.bodies[0].subtract = {"ball", "core"};
  c.bodies[1].subtract = {"core"};
  std::vector<std::string> notes;
  std::vector<BodyCount> counts;
  const Particles<2> p = createParticles<2>(c, notes, &counts);
  EXPECT_EQ(counts[2].fluid, 13u);
  EXPECT_NEAR(counts[1].wall, M_PI * (16 - 4), 4);
  for (std::uint32_t i = 0; i < p.count; ++i) {
    const double r = norm(p.position[i] - Vec<2>{10.2, 9.7});
    if (p.body[i] == 0) {
      EXPECT_GT(r, 4);
    } else {
      EXPECT_TRUE(p.body[i] == 1 ? r > 2 && r < 4 + 1e-9 : r < 2 + 1e-9) << r;
    }
    for (std::uint32_t j = 0; j < i; ++j) EXPECT_GE(norm(p.position[i] - p.position[j]), 0.5 * (1 - 1e-6));
  }
}

/// A box that is turned, in place and by its corners.
TEST(createParticles, turnedBoxesAreSubtracted) {
  for (const double angle : {3.0, 20.0, 45.0}) {
    Case c = emptyCase(2);
    c.bodies = {makeBody("sea", BodyKind::Fluid, box({0, 0}, {20, 20})),
                makeBody("beam", BodyKind::Wall, box({5, 6}, {15, 14}))};
    c.bodies[0].subtract = {"beam"};
    Transform& turned = c.bodies[1].shape.transform.emplace();
    turned.center = {10, 10, 0}, turned.angle = angle;
    std::vector<std::string> notes;
    const Particles<2> p = createParticles<2>(c, notes);
    EXPECT_NEAR(p.fluidCount, 400 - 80, 8);
    const double cosine = std::cos(angle * M_PI / 180), sine = std::sin(angle * M_PI / 180);
    for (std::uint32_t i = 0; i < p.fluidCount; ++i) {
      const Vec<2> d = p.position[i] - Vec<2>{10, 10};
      EXPECT_FALSE(std::abs(cosine * d[0] + sine * d[1]) < 5 && std::abs(cosine * d[1] - sine * d[0]) < 4);
    }
  }
}

TEST(createParticles, conditionsThatNeverHoldAreNoted) {
  Case c = emptyCase(2);
  c.bodies = {makeBody("sea", BodyKind::Fluid, box({0, 0}, {4, 2})),
              makeBody("mist", BodyKind::Fluid, box({0, 2}, {4, 4}))};
  c.bodies[1].where = "y < 2";
  std::vector<std::string> notes;
  EXPECT_EQ(createParticles<2>(c, notes).count, 8u);
  EXPECT_THAT(notes, ElementsAre("body 'mist': where = \"y < 2\" holds at none of its 8 particles"));
  c.bodies[0].where = "0";
  EXPECT_THAT(messageOfCreation<2>(c), HasSubstr("no fluid"));
}

TEST(createParticles, velocitiesCanBeExpressions) {
  Case c = emptyCase(3);
  c.bodies = {makeBody("vortex", BodyKind::Fluid, box({0, 0, 0}, {3, 4, 2})),
              makeBody("calm", BodyKind::Fluid, box({5, 0, 0}, {7, 1, 1}))};
  c.bodies[0].velocity = {0, 7, 0};
  c.bodies[0].velocityExpression = {"x*y - z", "", "sqrt(x)"};
  std::vector<std::string> notes;
  const Particles<3> p = createParticles<3>(c, notes);
  ASSERT_EQ(p.fluidCount, 26u);
  for (std::uint32_t i = 0; i < 24; ++i) {
    const Vec<3>& x = p.position[i];
    EXPECT_EQ(p.velocity[i], (Vec<3>{x[0] * x[1] - x[2], 7, std::sqrt(x[0])}));
  }
  EXPECT_EQ(p.velocity[24], (Vec<3>{}));
}

TEST(createParticles, wallsStartWithTheVelocityOfTheirMotion) {
  Case c = emptyCase(2);
  c.bodies = {makeBody("drop", BodyKind::Fluid, box({0, 0}, {1, 1})),
              makeBody("blade", BodyKind::Wall, box({5, 0}, {8, 1}))};
  c.bodies[1].velocity = {0.25, 0};
  c.bodies[1].oscillation = {{0, 3}, 2 * M_PI, 0};  // at t = 0 by 3 m/s
  c.bodies[1].rotation = Rotation{{4, 0.5}, {0, 0, 1}, 2};
  std::vector<std::string> notes;
  const Particles<2> p = createParticles<2>(c, notes);
  for (int k = 0; k < 3; ++k) EXPECT_LE(norm(p.velocity[1 + k] - Vec<2>{0.25, 3 + 2 * (1.5 + k)}), 1e-14);
}

TEST(createParticles, rejectsRotationsAcrossHalfAPeriod) {
  Case c = emptyCase(3);
  c.domain = {{-10, -10, -10}, {10, 10, 10}, {false, false, true}};
  c.bodies = {makeBody("drop", BodyKind::Fluid, box({0, 0, 0}, {1, 1, 1})),
              makeBody("shaft", BodyKind::Wall, box({2, 2, -10}, {3, 3, 10}))};
  c.bodies[1].rotation = Rotation{{2.5, 2.5, 5}, {0, 0, 3}, 1};
  EXPECT_EQ(messageOfCreation<3>(c), "no error") << "about the periodic axis";
  c.bodies[1].rotation->axis = {0, 1, 3};
  EXPECT_THAT(messageOfCreation<3>(c), HasSubstr("rotating wall 'shaft' reaches"));
  c.domain.periodic[2] = false;
  EXPECT_EQ(messageOfCreation<3>(c), "no error");
}

/// Their first layer goes on by a spacing before it leaves.
TEST(createParticles, rejectsNozzlesThatTurnAcrossAPeriod) {
  Case c = emptyCase(3);
  c.domain = {{-10, -10, -10}, {10, 10, 10}, {true, false, false}};
  c.bodies = {makeBody("jet", BodyKind::Inflow, {})};
  c.bodies[0].inflow.nozzle.center = {0, 5.2, 0};
  c.bodies[0].inflow.nozzle.direction = {0, 1, 0};
  c.bodies[0].inflow.nozzle.radius = 0.5;
  c.bodies[0].inflow.speed = TimeFunction{1};
  c.bodies[0].rotation = Rotation{.center = {0, -5, 0}, .speed = 1};
  EXPECT_THAT(messageOfCreation<3>(c), HasSubstr("rotating inflow 'jet' reaches"));
  c.bodies[0].rotation->center[1] = -2;
  EXPECT_EQ(messageOfCreation<3>(c), "no error");
}

TEST(createParticles, rejectsExpressionsThatAreNotFiniteAtAParticle) {
  Case c = emptyCase(2);
  c.bodies = {makeBody("drop", BodyKind::Fluid, box({0, 0}, {2, 1}))};
  c.bodies[0].velocityExpression = {"", "1/(x - 1.5)", ""};
  EXPECT_EQ(messageOfCreation<2>(c),
            "body.drop.velocity: \"1/(x - 1.5)\" is infinite for the particle at (1.5, 0.5) m; expected a finite "
            "number");
  c.bodies[0].where = "x < 1";  // no particle stands there
  EXPECT_EQ(messageOfCreation<2>(c), "no error");
  c.bodies[0].where = "sqrt(x - 1)";
  EXPECT_THAT(messageOfCreation<2>(c),
              HasSubstr("body.drop.where: \"sqrt(x - 1)\" is not a number for the particle"));
}

TEST(createParticles, overlapCountsAcrossPeriodicBoundaries) {
  Case c = emptyCase(2);
  c.domain = {{0, 0}, {20, 20}, {true, false, false}};
  // Both lattices stand 0.2 from the boundary in x: 0.4 apart across it.
  c.bodies = {makeBody("left", BodyKind::Fluid, box({-0.3, 0}, {1.7, 4})),
              makeBody("right", BodyKind::Fluid, box({18.3, 0}, {20.3, 4}))};
  std::vector<std::string> notes;
  EXPECT_EQ(createParticles<2>(c, notes).count, 8u + 4);
  c.domain.periodic[0] = false;
  EXPECT_EQ(createParticles<2>(c, notes).count, 8u + 8);
}

/// Boxes and balls at random places of a periodic domain, of which many overlap.
template <int D>
void checkUnion(unsigned seed) {
  constexpr double size = 14;
  std::mt19937 random(seed);
  Case c = emptyCase(D);
  c.domain = {};
  for (int k = 0; k < D; ++k) c.domain.max[k] = size, c.domain.periodic[static_cast<std::size_t>(k)] = k != 1;
  for (int b = 0; b < 9; ++b) {
    std::uniform_real_distribution<double> place(3, size - 3), extent(0.6, 2.9);
    Vec<3> center{}, half{};
    for (int k = 0; k < D; ++k) center[k] = place(random), half[k] = extent(random);
    // Two meet across a periodic end.
    if (b == 0) center[0] = half[0] - 0.3;
    if (b == 6) center[0] = size - half[0];
    c.bodies.push_back(makeBody("body", BodyKind::Fluid,
                                b % 4 == 3 ? sphere(center, half[1]) : box(center - half, center + half)));
  }
  const auto way = [&](const Vec<D>& a, const Vec<D>& b) {
    Vec<D> d = b - a;
    for (int k = 0; k < D; ++k)
      if (k != 1) d[k] -= size * std::round(d[k] / size);
    return d;
  };
  const auto isWithin = [&](const Shape& s, const Vec<D>& x) {
    if (s.kind == ShapeKind::Sphere) return norm(x - resized<D>(s.center)) <= s.radius + 1e-6;
    for (int k = 0; k < D; ++k)
      if (x[k] < s.min[k] - 1e-6 || x[k] > s.max[k] + 1e-6) return false;
    return true;
  };
  const auto isDeep = [&](const Shape& s, const Vec<D>& x) {
    bool deep = true;
    for (int k = 0; k < D; ++k)
      for (const double off : {-0.25, 0.25}) {
        Vec<D> beside = x;
        beside[k] += off;
        deep = deep && isWithin(s, beside);
      }
    return deep;
  };
  std::vector<std::string> notes;
  std::vector<Vec<D>> expected;
  std::vector<std::size_t> owner;
  std::size_t all = 0;
  for (std::size_t b = 0; b < c.bodies.size(); ++b) {
    Case single = c;
    single.bodies = {c.bodies[b]};
    const Particles<D> own = createParticles<D>(single, notes);
    all += own.count;
    for (const Vec<D>& x : own.position) {
      bool taken = false;
      for (std::size_t i = 0; i < expected.size() && !taken; ++i) {
        const Vec<D> d = way(expected[i], x);
        taken = norm(d) < 0.5 * (1 - 1e-6) || (owner[i] != b && norm(d) < 0.5 * std::sqrt(D) * (1 + 1e-6) &&
                                               isDeep(c.bodies[owner[i]].shape, expected[i] + d));
      }
      if (!taken) expected.push_back(x), owner.push_back(b);
    }
  }
  const Particles<D> p = createParticles<D>(c, notes);
  EXPECT_LT(p.count, all);
  EXPECT_THAT(p.position.span(), ElementsAreArray(expected));
}

TEST(createParticles, leavesOutWhatAComparisonOfAllPointsLeavesOut) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    checkUnion<2>(seed);
    checkUnion<3>(seed);
  }
}

TEST(createParticles, rejectsFluidInsideWall) {
  Case c = emptyCase(2);
  c.bodies = {makeBody("column", BodyKind::Fluid, box({0, 0}, {4, 4})),
              makeBody("floor", BodyKind::Wall, box({0, -4}, {10, 1}))};
  EXPECT_EQ(
      messageOfCreation<2>(c),
      "fluid body 'column' and wall body 'floor' overlap: 4 wall particles closer than half a spacing to the "
      "fluid, the first at (500, 500) mm; subtract = [\"floor\"] of 'column' leaves it the room");
  c.bodies[1].shape = box({0, -4.4}, {10, 0.6});  // lattices 0.4 apart: still too near
  EXPECT_THAT(messageOfCreation<2>(c), HasSubstr("4 wall particles"));
  c.bodies[1].shape = box({0, -4.5}, {10, 0.5});  // half a spacing exactly is allowed
  EXPECT_EQ(messageOfCreation<2>(c), "no error");
}

/// No particle of one lattice is closer than half a spacing to one of the other.
TEST(createParticles, rejectsFluidInsideWallOnAShiftedLattice) {
  Case c = emptyCase(2);
  c.bodies = {makeBody("column", BodyKind::Fluid, box({0, 0}, {10, 10})),
              makeBody("disc", BodyKind::Wall, sphere({5, 5}, 1.2))};
  EXPECT_EQ(
      messageOfCreation<2>(c),
      "fluid body 'column' and wall body 'disc' overlap: 5 wall particles in the place of the fluid, the first "
      "at (5, 4) m; subtract = [\"disc\"] of 'column' leaves it the room");
  c.bodies[0].subtract = {"disc"};
  EXPECT_EQ(messageOfCreation<2>(c), "no error");
  c.bodies[0].subtract = {};
  c.bodies[0].where = "(x-5)^2 + (y-5)^2 > 1.3^2";
  EXPECT_EQ(messageOfCreation<2>(c), "no error");
  c.bodies[0].where = {};
  c.bodies[1].shape = sphere({5, -1}, 1.2);  // a fifth of a spacing deep, as by rounding
  EXPECT_EQ(messageOfCreation<2>(c), "no error");
  c.bodies[1].shape = box({-3.5, -3.5}, {13.5, 13.5});
  EXPECT_THAT(messageOfCreation<2>(c), HasSubstr("overlap: 121 wall particles in the place of the fluid"));

  Case space = emptyCase(3);
  space.bodies = {makeBody("column", BodyKind::Fluid, box({0, 0, 0}, {10, 10, 10})),
                  makeBody("ball", BodyKind::Rigid, sphere({5, 5, 6}, 2.4))};
  EXPECT_THAT(messageOfCreation<3>(space),
              HasSubstr("'ball' overlap: 57 wall particles in the place of the fluid"));
}

/// The earlier body keeps the place, whatever the lattice of the later one.
TEST(createParticles, laterFluidLeavesTheShapeOfEarlierFluid) {
  Case c = emptyCase(2);
  c.bodies = {makeBody("drop", BodyKind::Fluid, sphere({5, 5}, 2.2)),
              makeBody("pool", BodyKind::Fluid, box({0, 0}, {10, 10}))};
  std::vector<std::string> notes;
  std::vector<BodyCount> counts;
  createParticles<2>(c, notes, &counts);
  EXPECT_THAT(counts, ElementsAre(BodyCount{13, 0}, BodyCount{100 - 12, 0}));
  EXPECT_THAT(notes,
              ElementsAre("body 'pool': 12 of 100 particles left out, their place is taken by body 'drop'"));
}

TEST(createParticles, tellsOfFluidBehindReserves) {
  Case c = emptyCase(2);
  c.bodies = {makeBody("pool", BodyKind::Fluid, box({0, 0}, {20, 10}))};
  Opening& o = c.openings.emplace_back();
  o.name = "end", o.face.kind = NozzleKind::Rectangle, o.face.width = 10;
  o.face.center = {13, 5}, o.face.direction = {1, 0};  // the other way would be that into the pool
  std::vector<std::string> notes;
  EXPECT_EQ(createParticles<2>(c, notes).fluidCount, 200u - 60);
  EXPECT_THAT(notes,
              ElementsAre("opening 'end': 60 of 200 fluid particles left out, which are behind its reserve of "
                          "7 m; its direction is to lead into the fluid"));
  o.face.center = {7, 5}, notes.clear();
  createParticles<2>(c, notes);
  EXPECT_THAT(notes, IsEmpty());
}

/// Wherever the lattice is, rounding leaves no gap.
TEST(createParticles, leavesOutAllFluidBehindReserves) {
  Case c = emptyCase(2);
  c.spacing = 1e-3;
  c.bodies = {makeBody("channel", BodyKind::Fluid, box({-0.04, 0}, {0.02, 0.01}))};
  Opening& o = c.openings.emplace_back();
  o.name = "in", o.face.kind = NozzleKind::Rectangle, o.face.width = 0.01, o.face.direction = {1, 0};
  for (const double shift : {0.0, 0.1, 0.3, 0.5, 0.7}) {
    o.face.center = {shift * 1e-3, 0.005};
    std::vector<std::string> notes;
    for (const Vec<2>& x : createParticles<2>(c, notes).position) EXPECT_GT(x[0], -8.5e-3) << shift;
    EXPECT_EQ(notes.size(), 1u);
  }
  c.bodies.push_back(makeBody("tank", BodyKind::Fluid, box({-0.08, 0}, {-0.06, 0.01})));  // another one
  std::vector<std::string> notes;
  EXPECT_GT(createParticles<2>(c, notes).fluidCount, 400u);
}

TEST(createParticles, tellsOfWallsInReserves) {
  Case c = emptyCase(2);
  c.bodies = {makeBody("channel", BodyKind::Fluid, box({-7, 0}, {20, 10})),
              makeBody("low", BodyKind::Wall, box({-9, -4}, {20, 0})),
              makeBody("high", BodyKind::Wall, box({-9, 10}, {20, 14}))};
  Opening& o = c.openings.emplace_back();
  o.name = "in", o.face.kind = NozzleKind::Rectangle, o.face.width = 10;
  o.face.center = {0, 5}, o.face.direction = {1, 0};
  std::vector<std::string> notes;
  createParticles<2>(c, notes);
  EXPECT_THAT(notes, IsEmpty());
  c.bodies.push_back(makeBody("end", BodyKind::Wall, box({-11, 0}, {-7, 10})));
  createParticles<2>(c, notes);
  EXPECT_THAT(notes,
              ElementsAre("opening 'in': 10 of the 80 places of its reserve are inside wall 'end'; expected "
                          "a channel as wide as the face that goes on behind it for 8 spacings, 8 m"));
  c.bodies.back().shape = box({-14, 0}, {0, 10});
  c.bodies.front().shape = box({0, 0}, {20, 10});
  EXPECT_THAT(messageOfCreation<2>(c),
              HasSubstr("opening 'in': 80 of the 80 places of its reserve are inside wall"));
}

/// Lattices that are half a spacing apart: no particle is closer than that to one of the other.
TEST(createParticles, rigidBodiesStandInNoOtherSolid) {
  Case c = emptyCase(3);
  c.bodies = {makeBody("pool", BodyKind::Fluid, box({-20, -20, 0}, {-10, -10, 4})),
              makeBody("floor", BodyKind::Wall, box({-10, -10, -4}, {10, 10, 0})),
              makeBody("ball", BodyKind::Rigid, sphere({0, 0, 3}, 3))};
  std::vector<std::string> notes;
  createParticles<3>(c, notes);
  EXPECT_THAT(notes, IsEmpty());
  c.bodies[2].shape = sphere({0, 0, 1}, 3);
  createParticles<3>(c, notes);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_THAT(notes[0],
              HasSubstr("body 'ball': 22 of 123 particles left out, their place is taken by body 'floor'"));
  c.bodies[2].shape = sphere({0, 0, 3}, 3);
  c.bodies.push_back(makeBody("other", BodyKind::Rigid, box({-2, -2, 4}, {3, 3, 9})));
  notes.clear();
  createParticles<3>(c, notes);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_THAT(notes[0], HasSubstr("taken by body 'ball'"));
  c.bodies[3].shape = c.bodies[2].shape;
  EXPECT_THAT(messageOfCreation<3>(c),
              HasSubstr("rigid body 'other' has no particles: the place of all 123 is taken by rigid 'ball'"));
  c.bodies[3].shape = box({-2, -2, 4}, {3, 3, 9});
  c.bodies[3].kind = c.bodies[2].kind = BodyKind::Wall;  // these may
  notes.clear();
  createParticles<3>(c, notes);
  EXPECT_THAT(notes, IsEmpty());
}

/// As they stand in the case.
TEST(createParticles, lengthsInNotesAreScaled) {
  Case c = emptyCase(2);
  c.bodies = {makeBody("pool", BodyKind::Fluid, box({0, 0}, {10, 15}))};
  c.bodies[0].shape.transform.emplace().scale = 1.5;
  std::vector<std::string> notes;
  createParticles<2>(c, notes);
  EXPECT_THAT(notes,
              ElementsAre("body 'pool': 22.5 m along y is 22.5 spacings; filled with 23 particles from its min "
                          "corner (23 m)"));
}

Body nozzle(std::string name, Vec<3> center) {
  Body body = makeBody(std::move(name), BodyKind::Inflow, {});
  body.inflow.speed = TimeFunction{.value = 1};
  body.inflow.nozzle.center = center, body.inflow.nozzle.direction = {0, 0, -1};
  body.inflow.nozzle.radius = 3;
  return body;
}

TEST(createParticles, nozzlesNeedTheirRoomOnShiftedLattices) {
  Case c = emptyCase(3);
  c.bodies = {nozzle("n", {0, 0, 15}), makeBody("lid", BodyKind::Wall, box({-10.5, -10.5, 15}, {9.5, 9.5, 22}))};
  EXPECT_THAT(messageOfCreation<3>(c), HasSubstr("inflow 'n' and wall 'lid' overlap"));
  c.bodies[1].shape = box({-10.5, -10.5, 11}, {9.5, 9.5, 15});  // in its way
  EXPECT_THAT(messageOfCreation<3>(c), HasSubstr("inflow 'n' and wall body 'lid' overlap: "));
  EXPECT_THAT(messageOfCreation<3>(c), HasSubstr("the nozzle needs a spacing of room in front of it: move it, or "
                                                 "shape 'lid' so that it leaves the room, such as by its where"));
  c.bodies[1].shape = cylinder({0, 0, 15}, {0, 0, 22}, 6, 3);  // a pipe
  EXPECT_EQ(messageOfCreation<3>(c), "no error");
  c.bodies[1] = nozzle("m", {0.5, 0.5, 15.5});
  EXPECT_THAT(messageOfCreation<3>(c), HasSubstr("inflow 'm' and inflow 'n' overlap"));
  c.bodies[1] = nozzle("m", {6, 0, 15.5});
  EXPECT_EQ(messageOfCreation<3>(c), "no error");
  c.bodies[1] = makeBody("pool", BodyKind::Fluid, box({-4.5, -4.5, 16.5}, {5.5, 5.5, 22.5}));
  EXPECT_THAT(messageOfCreation<3>(c), HasSubstr("fluid body 'pool' and inflow 'n' overlap"));
}

TEST(createParticles, rejectsCaseWithoutFluid) {
  Case c = emptyCase(2);
  c.bodies = {makeBody("floor", BodyKind::Wall, box({0, -4}, {10, 0}))};
  EXPECT_THAT(messageOfCreation<2>(c), HasSubstr("no fluid"));
  c.bodies = {makeBody("mist", BodyKind::Fluid, sphere({0, 0}, 0.4, 0.3))};
  EXPECT_THAT(messageOfCreation<2>(c), HasSubstr("no fluid"));
}

TEST(createParticles, rejectsBodyOutsideDomain) {
  Case c = emptyCase(2);
  c.bodies = {makeBody("drop", BodyKind::Fluid, box({98, 0}, {102, 2}))};
  EXPECT_EQ(messageOfCreation<2>(c),
            "body 'drop' reaches out of the domain: a particle at (100.5, 0.5) m, the domain is (-100, -100) m to "
            "(100, 100) m");
}

TEST(createParticles, rejectsMoreParticlesThanTheLimitBeforeFillingThem) {
  Case c = emptyCase(3);
  for (const Shape& shape : {box({0, 0, 0}, {1e6, 1e6, 1e6}), sphere({0, 0, 0}, 1e6)}) {
    c.bodies = {makeBody("ocean", BodyKind::Fluid, shape)};
    EXPECT_THAT(messageOfCreation<3>(c), HasSubstr("body 'ocean' would have more than 4294966272 particles"));
  }
}

}  // namespace
}  // namespace treacle::test
