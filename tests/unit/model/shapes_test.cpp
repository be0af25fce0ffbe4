#include "treacle/core/error.hpp"
#include "treacle/model/case/width.hpp"
#include "treacle/model/geometry/shape.hpp"
#include "treacle/model/geometry/wall_surface.hpp"
#include "treacle/model/particles/create.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "sample_case.hpp"
#include "support/sample_mesh.hpp"
#include "support/temporary_directory.hpp"

namespace treacle::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double pi = std::numbers::pi;

Shape cone(Vec<3> start, Vec<3> end, double startRadius, double endRadius) {
  Shape s;
  s.kind = ShapeKind::Cone;
  s.start = start, s.end = end, s.startRadius = startRadius, s.endRadius = endRadius;
  return s;
}

Shape torus(Vec<3> center, double radius, double tubeRadius) {
  Shape s;
  s.kind = ShapeKind::Torus;
  s.center = center, s.radius = radius, s.tubeRadius = tubeRadius;
  return s;
}

Shape polygon(std::vector<Vec<2>> points, double bottom = 0, double top = 0) {
  Shape s;
  s.kind = ShapeKind::Polygon;
  s.points = std::move(points), s.bottom = bottom, s.top = top;
  return s;
}

Shape transformed(Shape s, Transform t) {
  s.transform = t;
  return s;
}

template <int D>
std::vector<Vec<D>> placesOf(const Shape& shape) {
  Case c = emptyCase(D);
  c.bodies = {makeBody("fluid", BodyKind::Fluid, shape)};
  std::vector<std::string> notes;
  const Particles<D> p = createParticles<D>(c, notes);
  EXPECT_THAT(notes, IsEmpty());
  return {p.position.span().begin(), p.position.span().end()};
}

/// What particles of the first of these walls at the places see of all of them.
template <int D>
std::vector<WallSurface<D>> surfacesOf(const std::vector<Shape>& shapes, const std::vector<Vec<D>>& places) {
  Case c = emptyCase(D);
  for (const Shape& s : shapes) c.bodies.push_back(makeBody("wall", BodyKind::Wall, s));
  std::vector<std::string> notes;
  const std::vector<std::uint8_t> body(places.size());
  return createWallSurfaces<D>(c, places, body, notes);
}

template <int D>
void expectSame(const std::vector<WallSurface<D>>& a, const std::vector<WallSurface<D>>& b,
                const std::vector<Vec<D>>& places, double bound) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    const auto apart = [&](int i, int j) { return norm(a[k].face[i] - b[k].face[j]); };
    // Where two are as near, either is the first.
    const bool same = (apart(0, 0) < bound && apart(1, 1) < bound) || (apart(0, 1) < bound && apart(1, 0) < bound);
    EXPECT_TRUE(same) << "at " << positionText(resized<3>(places[k]), D) << ": "
                      << positionText(resized<3>(converted<double>(a[k].face[0])), D)
                      << positionText(resized<3>(converted<double>(a[k].face[1])), D) << " and "
                      << positionText(resized<3>(converted<double>(b[k].face[0])), D)
                      << positionText(resized<3>(converted<double>(b[k].face[1])), D);
  }
}

template <int D>
std::vector<Vec<D>> randomPlaces(Vec<D> min, Vec<D> max, int count,
                                 const std::function<bool(const Vec<D>&)>& within) {
  std::mt19937 random(7);
  std::vector<Vec<D>> places;
  while (static_cast<int>(places.size()) < count) {
    Vec<D> x{};
    for (int k = 0; k < D; ++k) x[k] = std::uniform_real_distribution<double>(min[k], max[k])(random);
    if (within(x)) places.push_back(x);
  }
  return places;
}

TEST(cone, isACylinderWhereItsRadiiAreTheSame) {
  const Vec<3> start{1, -2, 0}, end{5, 6, 3};
  EXPECT_EQ(placesOf<3>(cone(start, end, 4, 4)), placesOf<3>(cylinder(start, end, 4)));
  EXPECT_EQ(placesOf<2>(cone({1, -2}, {5, 6}, 4, 4)), placesOf<2>(cylinder({1, -2}, {5, 6}, 4)));
  Shape hollow = cone(start, end, 4, 4);
  hollow.innerStartRadius = hollow.innerEndRadius = 2;
  EXPECT_EQ(placesOf<3>(hollow), placesOf<3>(cylinder(start, end, 4, 2)));
  const auto inside = randomPlaces<3>({-3, -6, -4}, {9, 10, 7}, 300, [&](const Vec<3>& x) {
    return contains<3>(cylinder(start, end, 4, 2), x, 0);
  });
  expectSame<3>(surfacesOf<3>({hollow}, inside), surfacesOf<3>({cylinder(start, end, 4, 2)}, inside), inside,
                1e-5);
}

TEST(cone, hasTheVolumeAndSurfaceOfOne) {
  const double volume = pi / 3 * 30 * (15. * 15 + 15 * 5 + 5 * 5);
  EXPECT_NEAR(static_cast<double>(placesOf<3>(cone({0, 0, -10}, {0, 0, 20}, 15, 5)).size()), volume,
              0.01 * volume);
  EXPECT_NEAR(static_cast<double>(placesOf<2>(cone({0, -10}, {0, 20}, 15, 5)).size()), 600., 10.);
  // One of 45 degrees with its tip at the origin: the mantle is z/sqrt(2) from the axis, in the direction (1, -1).
  const Shape tip = cone({0, 0, 0}, {0, 0, 20}, 0, 20);
  const std::vector<Vec<3>> places{{0, 5, 8}, {0, 0, 1}};
  const auto seen = surfacesOf<3>({tip}, places);
  const double r = std::sqrt(0.5);
  EXPECT_LT(norm(converted<double>(seen[0].face[0]) - (3 * r) * Vec<3>{0, r, -r}), 1e-6);
  EXPECT_NEAR(norm(seen[1].face[0]), r, 1e-6);
  EXPECT_NEAR(norm(seen[1].face[1]), r, 1e-6);
  EXPECT_NEAR(dot(seen[1].face[0], seen[1].face[1]), 0, 1e-6);
}

TEST(torus, hasTheVolumeAndSurfaceOfOne) {
  const double volume = 2 * pi * pi * 20 * 25;
  Shape ring = torus({1, 2, 3}, 20, 5);
  EXPECT_NEAR(static_cast<double>(placesOf<3>(ring).size()), volume, 0.04 * volume);  // 3.2 % less, by the lattice
  ring.axis = {0, 3, 0};
  EXPECT_NEAR(static_cast<double>(placesOf<3>(ring).size()), volume, 0.04 * volume);
  const std::vector<Vec<3>> places{{1 + 23, 2, 3}, {1, 2 + 1, 3 + 18}};
  const auto seen = surfacesOf<3>({ring}, places);
  EXPECT_LT(norm(converted<double>(seen[0].face[0]) - Vec<3>{2, 0, 0}), 1e-6);
  // The second one is 2 m inwards of the tube's middle and 1 m along the axis.
  const Vec<3> out = Vec<3>{0, 1, -2} * (1 / std::sqrt(5.0));
  EXPECT_LT(norm(converted<double>(seen[1].face[0]) - out * (5 - std::sqrt(5.0))), 1e-6);
}

const std::vector<Vec<2>> angle = {{0, 0}, {20, 0}, {20, 6}, {7, 6}, {7, 15}, {0, 15}};

TEST(polygon, isFilledOnTheLatticeOfTheDomain) {
  EXPECT_EQ(placesOf<2>(polygon(angle)).size(), 20u * 6 + 7 * 9);
  EXPECT_EQ(placesOf<3>(polygon(angle, -2, 3)).size(), 5u * (20 * 6 + 7 * 9));
  std::vector<Vec<2>> other(angle.rbegin(), angle.rend());
  EXPECT_EQ(placesOf<2>(polygon(other)), placesOf<2>(polygon(angle)));
  EXPECT_EQ(placesOf<3>(polygon(other, -2, 3)), placesOf<3>(polygon(angle, -2, 3)));
}

/// Points of the lattice on a side belong to one of two polygons that share it.
TEST(polygon, hasPointsOnItsSidesOnOneSideOnly) {
  EXPECT_EQ(placesOf<2>(polygon({{10, 0}, {0, 10}, {-10, 0}, {0, -10}})).size(), 200u);
  EXPECT_EQ(placesOf<3>(polygon({{10, 0}, {0, 10}, {-10, 0}, {0, -10}}, -3, 4)).size(), 7u * 200);
  EXPECT_EQ(placesOf<2>(polygon({{0.5, 0.5}, {10.5, 0.5}, {10.5, 6.5}, {0.5, 6.5}})).size(), 60u);
  EXPECT_EQ(placesOf<3>(polygon({{0.5, 0.5}, {10.5, 0.5}, {10.5, 6.5}, {0.5, 6.5}}, 0.5, 3.5)).size(), 180u);
  Case c = emptyCase(2);
  c.bodies = {makeBody("fluid", BodyKind::Fluid, polygon({{0, 0}, {20, 20}, {-20, 20}})),
              makeBody("tank", BodyKind::Wall, polygon({{0, 0}, {30, 30}, {30, -6}, {-30, -6}, {-30, 30}}))};
  std::vector<std::string> notes;
  std::vector<BodyCount> counts;
  createParticles<2>(c, notes, &counts);
  EXPECT_THAT(notes, IsEmpty());
  EXPECT_THAT(counts, ElementsAre(BodyCount{400, 0}, BodyCount{0, 60 * 36 - 900}));
  c.bodies[1].shape = polygon({{-30, -6}, {30, -6}, {30, 30}, {-30, 30}});
  c.bodies[1].subtract = {"fluid"};
  createParticles<2>(c, notes, &counts);
  EXPECT_THAT(counts, ElementsAre(BodyCount{400, 0}, BodyCount{0, 60 * 36 - 400}));
}

/// Never too many, so that no case is refused that has room.
TEST(polygon, isCountedBeforeItIsFilled) {
  Case plane = emptyCase(2), space = emptyCase(3);
  plane.bodies = {makeBody("fluid", BodyKind::Fluid, polygon(angle))};
  space.bodies = {makeBody("fluid", BodyKind::Fluid, polygon(angle, -2, 3))};
  EXPECT_LE(leastPoints(plane), placesOf<2>(polygon(angle)).size());
  EXPECT_GT(leastPoints(plane), 130);
  EXPECT_LE(leastPoints(space), placesOf<3>(polygon(angle, -2, 3)).size());
  EXPECT_GT(leastPoints(space), 4 * 130);
}

/// Fluid inside and a wall outside of one outline: every place of the lattice belongs to one of them.
TEST(polygon, partsTheLatticeWithTheLayerOutside) {
  Case c = emptyCase(2);
  const Shape inside = polygon({{-20.3, -11}, {17, -4.2}, {12, 14}, {-3, 6.6}});
  Shape outside = inside;
  outside.fill = FillKind::Outside, outside.thickness = 4.2;
  c.bodies = {makeBody("fluid", BodyKind::Fluid, inside), makeBody("wall", BodyKind::Wall, outside)};
  std::vector<std::string> notes;
  const Particles<2> p = createParticles<2>(c, notes);
  EXPECT_THAT(notes, IsEmpty());
  const double area = 0.5 * (std::abs(37.3 * 25 - 32.3 * 6.8) + std::abs(32.3 * 17.6 - 17.3 * 25));
  EXPECT_NEAR(static_cast<double>(p.fluidCount), area, 0.02 * area);
  // A layer around a polygon: its length times the thickness, and a disc around its corners; less at the concave
  // one.
  double length = 0;
  for (std::size_t k = 0; k < 4; ++k) length += norm(inside.points[(k + 1) % 4] - inside.points[k]);
  const double layer = length * 4.2 + pi * 4.2 * 4.2;
  EXPECT_NEAR(static_cast<double>(p.count - p.fluidCount), layer, 0.05 * layer);
  for (std::size_t i = 0; i < p.count; ++i)
    for (int k = 0; k < 2; ++k) EXPECT_NEAR(p.position[i][k] - std::floor(p.position[i][k]), 0.5, 1e-9);
}

/// The points of the outline that are nearer to x than those around them, by their distances: of its sides those
/// at right angles, and the concave corner.
std::vector<Vec<2>> waysOut(const Vec<2>& x) {
  std::vector<Vec<2>> ways;
  for (std::size_t k = 0; k < angle.size(); ++k) {
    const Vec<2> a = angle[k], along = angle[(k + 1) % angle.size()] - a;
    const double share = dot(x - a, along) / norm2(along);
    const Vec<2> normal{along[1], -along[0]};
    if (share >= 0 && share <= 1 && dot(a - x, normal) > 0) ways.push_back(a + along * share - x);
  }
  if (x[0] < 7 && x[1] < 6) ways.push_back(Vec<2>{7, 6} - x);
  std::ranges::sort(ways, {}, [](const Vec<2>& way) { return norm(way); });
  return ways;
}

TEST(polygon, hasTheSurfaceOfItsOutline) {
  const auto places =
      randomPlaces<2>({0, 0}, {20, 15}, 1000, [](const Vec<2>& x) { return x[1] < 6 || x[0] < 7; });
  std::vector<WallSurface<2>> expected;
  std::vector<Vec<3>> places3;
  std::vector<WallSurface<3>> expected3;
  for (const Vec<2>& x : places) {
    std::vector<Vec<2>> chosen;
    for (const Vec<2>& way : waysOut(x)) {
      if (norm(way) > 3.5 || chosen.size() == 2) break;
      // In sight, and far enough from the direction of the first one.
      const Vec<2> end = x + way * 0.999;
      const bool inSight = end[1] < 6 || end[0] < 7;
      if (inSight && (chosen.empty() || dot(way, chosen[0]) <= 0.5 * norm(way) * norm(chosen[0])))
        chosen.push_back(way);
    }
    WallSurface<2> surface{};
    WallSurface<3> surface3{};
    for (std::size_t i = 0; i < chosen.size(); ++i)
      surface.face[i] = converted<float>(chosen[i]), surface3.face[i] = converted<float>(resized<3>(chosen[i]));
    expected.push_back(surface), expected3.push_back(surface3), places3.push_back(resized<3>(x));
  }
  expectSame<2>(surfacesOf<2>({polygon(angle)}, places), expected, places, 2e-3);
  expectSame<3>(surfacesOf<3>({polygon(angle, -5, 5)}, places3), expected3, places3, 2e-3);
}

TEST(meshWalls, haveTheSurfaceOfABox) {
  const Vec<3> min{-6, -8, -3}, max{5, 7, 9};
  const auto places = randomPlaces<3>(min, max, 500, [](const Vec<3>&) { return true; });
  const auto expected = surfacesOf<3>({box(min, max)}, places);
  expectSame<3>(surfacesOf<3>({meshShape(boxMesh(min, max))}, places), expected, places, 1e-5);
  expectSame<3>(surfacesOf<3>({meshShape(boxMesh(min, max), FillKind::Shell)}, places), expected, places, 1e-5);
}

/// Two walls that touch: one of them a mesh.
TEST(meshWalls, meetOtherWallsInCorners) {
  const Shape floor = box({-50, -50, -10}, {50, 50, 0});
  const Vec<3> min{-6, -8, -1}, max{5, 7, 9};
  const auto places = randomPlaces<3>({-12, -14, -4}, {11, 13, 0}, 300, [](const Vec<3>&) { return true; });
  expectSame<3>(surfacesOf<3>({floor, meshShape(boxMesh(min, max))}, places),
                surfacesOf<3>({floor, box(min, max)}, places), places, 1e-4);
}

TEST(meshWalls, haveDepthAndNormalOfABallInsideAndOutside) {
  const double r = 20, sagitta = 0.025;  // of 20,480 triangles: they are up to that far inside
  const Triangles ball = ballMesh(r, 5);
  const auto places = randomPlaces<3>(Vec<3>::filled(-24), Vec<3>::filled(24), 2000, [&](const Vec<3>& x) {
    return std::abs(norm(x) - r) < 3.3 && std::abs(norm(x) - r) > 2 * sagitta;
  });
  for (const FillKind fill : {FillKind::Inside, FillKind::Outside}) {
    std::vector<Vec<3>> own;
    for (const Vec<3>& x : places)
      if ((norm(x) < r) == (fill == FillKind::Inside)) own.push_back(x);
    const auto seen = surfacesOf<3>({meshShape(ball, fill, 10)}, own);
    for (std::size_t k = 0; k < own.size(); ++k) {
      const Vec<3> way = converted<double>(seen[k].face[0]);
      EXPECT_NEAR(norm(way), std::abs(norm(own[k]) - r), sagitta);
      const double outward = dot(way, own[k]) / norm(way) / norm(own[k]);
      EXPECT_GT(fill == FillKind::Inside ? outward : -outward, 0.998);
      EXPECT_EQ(norm(seen[k].face[1]), 0);
    }
  }
}

/// A square plate of one face on either side.
TEST(meshWalls, sheetsHaveAFaceOnEitherSide) {
  Triangles square;
  square.vertices = {{-20, -20, 0}, {20, -20, 0}, {20, 20, 0}, {-20, 20, 0}};
  square.corners = {{0, 1, 2}, {0, 2, 3}};
  const std::vector<Vec<3>> places{{3, 4, 0.5}, {1, 2, -0.75}, {0, 1, 0}};
  const auto seen = surfacesOf<3>({meshShape(square, FillKind::Sheet, 3)}, places);
  const auto expected = surfacesOf<3>({box({-20, -20, -1.5}, {20, 20, 1.5})}, places);
  expectSame<3>(seen, expected, places, 1e-6);
}

TEST(transforms, ofEachShapeAreThoseOfItsPoints) {
  Shape tube = torus({2, 1, 0}, 9, 3);
  tube.axis = {1, 2, 3};
  const std::vector<Shape> shapes{box({0, 0, 0}, {5.9, 4.3, 8.2}),  // no particle is as near to two faces
                                  sphere({1, 2, 3}, 5, 2), cylinder({0, 0, 0}, {3, 4, 5}, 4),
                                  cone({0, 0, 0}, {3, 4, 5}, 4, 2), tube};
  const Transform t{.scale = 2, .axis = {1, 1, 0}, .angle = 40, .center = {1, 0, 2}, .translate = {3, 4, -5}};
  const Similarity<3> map(t);
  for (const Shape& s : shapes) {
    // At twice the size the lattice has half the spacing of the shape.
    Case c = emptyCase(3);
    c.spacing = 0.5;
    c.bodies = {makeBody("fluid", BodyKind::Fluid, s)};
    std::vector<std::string> notes;
    const Particles<3> before = createParticles<3>(c, notes);
    c.spacing = 1;
    c.bodies[0].shape.transform = t;
    const Particles<3> after = createParticles<3>(c, notes);
    ASSERT_EQ(before.count, after.count);
    for (std::size_t k = 0; k < before.count; ++k)
      EXPECT_LT(norm(map.point(before.position[k]) - after.position[k]), 1e-12);

    std::vector<Vec<3>> places(before.position.span().begin(), before.position.span().end()), moved;
    std::erase_if(places, [n = 0](const Vec<3>&) mutable { return n++ % 37 != 0; });
    for (const Vec<3>& x : places) moved.push_back(map.point(x));
    const auto seenBy = [&](const Shape& shape, double spacing, const std::vector<Vec<3>>& from) {
      Case wall = emptyCase(3);
      wall.spacing = spacing;
      wall.method.viscosityRadius = 3.37;  // no face of the box is as far as that
      wall.bodies = {makeBody("wall", BodyKind::Wall, shape)};
      return createWallSurfaces<3>(wall, from, std::vector<std::uint8_t>(from.size()), notes);
    };
    const auto seen = seenBy(transformed(s, t), 1, moved);
    auto expected = seenBy(s, 0.5, places);
    for (auto& surface : expected)
      for (auto& face : surface.face) face = converted<float>(map.direction(converted<double>(face)) * 2.0);
    expectSame<3>(seen, expected, moved, 1e-4);
  }
}

TEST(transforms, turnInThePlaneAndAboutThreeAxes) {
  const auto turnedBox = placesOf<2>(transformed(box({0, 0}, {6, 4}), {.angle = 90, .center = {1, 1}}));
  const auto upright = placesOf<2>(box({-2, 0}, {2, 6}));
  ASSERT_EQ(turnedBox.size(), upright.size());
  for (const Vec<2>& x : turnedBox)
    EXPECT_TRUE(std::ranges::any_of(upright, [&](const Vec<2>& y) { return norm(x - y) < 1e-12; }));
  // About x first: y goes to z, and then about z: x goes to y.
  const Similarity<3> s(Transform{.angles = {90, 0, 90}});
  EXPECT_LT(norm(s.point({1, 0, 0}) - Vec<3>{0, 1, 0}), 1e-15);
  EXPECT_LT(norm(s.point({0, 1, 0}) - Vec<3>{0, 0, 1}), 1e-15);
  EXPECT_LT(norm(s.pointBefore({0, 0, 1}) - Vec<3>{0, 1, 0}), 1e-15);
}

TEST(particlesOfAFile, standWhereItSays) {
  Case c = emptyCase(2);
  Shape s;
  s.kind = ShapeKind::Particles;
  s.file.path = "/some.csv";
  s.file.particles.value = std::make_shared<const GivenParticles>(GivenParticles{
      {{0, 0, 0}, {1, 0, 0}, {1.2, 0.3, 0}, {0, 0.9, 0}}, {{1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 1, 0}}, {}});
  s.transform = Transform{.scale = 1, .angle = 90};
  c.bodies = {makeBody("given", BodyKind::Fluid, s)};
  std::vector<std::string> notes;
  const Particles<2> p = createParticles<2>(c, notes);
  ASSERT_EQ(p.count, 3u);
  EXPECT_LT(norm(p.position[2] - Vec<2>{-0.9, 0}), 1e-15);
  EXPECT_EQ(p.velocity[2], Vec<2>{});
  EXPECT_THAT(notes, ElementsAre("body 'given': 1 of the 4 particles of /some.csv left out, closer than half a "
                                 "spacing to an earlier one"));

  // Turned as the places are, on top of the velocity of the body.
  c.bodies[0].fileVelocities = true;
  c.bodies[0].velocity = {0, 10, 0};
  const Particles<2> moving = createParticles<2>(c, notes);
  EXPECT_LT(norm(moving.velocity[1] - Vec<2>{0, 12}), 1e-14);
  EXPECT_LT(norm(moving.velocity[2] - Vec<2>{-1, 14}), 1e-14);
  c.heat.emplace();
  c.bodies[0].fileTemperatures = true;
  EXPECT_EQ(messageOf<InputError>([&] { createParticles<2>(c, notes); }),
            "body 'given': file_temperatures = true: /some.csv holds no temperatures");
}

TEST(applyWidth, refusesWhatHasNoCoordinatesToChange) {
  Case c = emptyCase(2);
  c.bodies = {makeBody("turned", BodyKind::Fluid, transformed(box({0, 0}, {1, 1}), {.angle = 1})),
              makeBody("outline", BodyKind::Fluid, polygon(angle))};
  const Width width{Coordinate::X, 0, 10, 2};
  EXPECT_EQ(messageOf<InputError>([&] { applyWidth(c, width); }),
            "body.turned.transform: found a transform, which no width can change; expected a width.factor of 1");
  c.bodies[0].shape.transform.reset();
  applyWidth(c, width);
  EXPECT_EQ(c.bodies[1].shape.points[1], (Vec<2>{30, 0}));
}

}  // namespace
}  // namespace treacle::test
