#include "treacle/model/geometry/wall_surface.hpp"
#include "treacle/model/geometry/wall_sight.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "sample_case.hpp"
#include "treacle/model/particles/create.hpp"

namespace treacle::test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// Walls of the sample case: spacing 1 m, h_v = 3.5 m.
template <int D>
struct Walls {
  Case c = emptyCase(D);

  explicit Walls(std::vector<Shape> shapes) {
    for (const Shape& shape : shapes)
      c.bodies.push_back(makeBody("wall " + std::to_string(c.bodies.size()), BodyKind::Wall, shape));
  }

  WallSurface<D> at(const Vec<D>& x, std::uint8_t body = 0) const {
    std::vector<std::string> notes;
    return createWallSurfaces<D>(c, {&x, 1}, {&body, 1}, notes)[0];
  }
};

template <int D>
void expectFace(const Vec<D, float>& face, const Vec<D>& expected, double tolerance = 2e-6) {
  for (int k = 0; k < D; ++k)
    EXPECT_NEAR(face[k], expected[k], tolerance) << "along "
                                                 << "xyz"[k];
}

template <int D>
void expectFaces(const WallSurface<D>& s, const Vec<D>& first, const Vec<D>& second, double tolerance = 2e-6) {
  expectFace(s.face[0], first, tolerance);
  expectFace(s.face[1], second, tolerance);
}

const Vec<2> nothing{};
const Vec<3> nothing3{};

TEST(createWallSurfaces, floor) {
  const Walls<2> floor({box({-20, -4}, {20, 0})});
  expectFaces(floor.at({0.5, -0.4}), {0, 0.4}, nothing);
  expectFaces(floor.at({0.5, -0.5}), {0, 0.5}, {0, -3.5});  // as far as h_v
  expectFaces(floor.at({0.5, -1.5}), {0, 1.5}, {0, -2.5});
  Walls<2> deep({box({-20, -40}, {20, 0})});
  expectFaces(deep.at({0.5, -3.4}), {0, 3.4}, nothing);
  expectFaces(deep.at({0.5, -3.6}), nothing, nothing);
  deep.c.method.viscosityRadius = 4;
  expectFaces(deep.at({0.5, -3.6}), {0, 3.6}, nothing);
}

TEST(createWallSurfaces, convexEdgeHasBothFaces) {
  const Walls<2> block({box({-20, -20}, {0, 0})});
  expectFaces(block.at({-1.5, -0.5}), {0, 0.5}, {1.5, 0});
  const Walls<3> cube({box({-20, -20, -20}, {0, 0, 0})});
  expectFaces(cube.at({-1.5, -0.5, -2.5}), {0, 0.5, 0}, {1.5, 0, 0});
}

/// Whether one wall ends at the other or goes into it.
TEST(createWallSurfaces, concaveCornersOfTwoWalls) {
  for (const double depth : {0.0, 2.0, 4.0}) {
    const Walls<2> walls({box({-4, -4}, {20, 0}), box({-4, -depth}, {0, 20})});
    expectFaces(walls.at({2.5, -0.4}), {0, 0.4}, nothing);
    expectFaces(walls.at({-1.5, 5.5}, 1), {1.5, 0}, {-2.5, 0});
    expectFace(walls.at({-0.5, -0.5}).face[0], {0.5, 0.5});
    expectFace(walls.at({-0.5, -1.5}).face[0], {0.5, 1.5});
    expectFaces(walls.at({-2.5, -2.5}), {-1.5, 0}, {0, -1.5});
  }
}

TEST(createWallSurfaces, concaveCornerOfThreeWalls) {
  for (const double depth : {0.0, 1.0}) {
    const Walls<3> walls({box({-9, -9, -9}, {20, 20, 0}), box({-9, -9, -depth}, {0, 20, 20}),
                          box({-depth, -9, -depth}, {20, 0, 20})});
    expectFaces(walls.at({-1.5, -0.5, -2.5}), {1.5, 0.5, 2.5}, nothing3);
    expectFaces(walls.at({2.5, -0.5, -2.5}), {0, 0.5, 2.5}, nothing3);
    expectFaces(walls.at({2.5, 3.5, -2.5}), {0, 0, 2.5}, nothing3);
  }
}

/// A wedge of fluid narrower than a right angle: the nearest point is its tip even from where the wedge opens.
TEST(createWallSurfaces, acuteCorner) {
  const double slope = 0.25;
  const Vec<2> along = Vec<2>{1, slope} * (1 / std::hypot(1, slope)), normal{-along[1], along[0]};
  const Vec<2> start = Vec<2>{} + 2.0 * normal - 30.0 * along, end = start + 60.0 * along;
  const Walls<2> walls({box({-30, -9}, {30, 0}), cylinder(resized<3>(start), resized<3>(end), 2)});
  expectFace(walls.at({-1, -0.5}).face[0], {1, 0.5});
  expectFace(walls.at({-3, -1}).face[0], {3, 1});
}

TEST(createWallSurfaces, platesHaveTwoFaces) {
  const Walls<2> thin({box({-20, 0}, {20, 1})}), two({box({-20, 0}, {20, 2})});
  const WallSurface<2> s = thin.at({0.5, 0.5});
  EXPECT_EQ(std::abs(s.face[0][1]), 0.5f);
  EXPECT_EQ(s.face[1], -s.face[0]);
  expectFaces(two.at({0.5, 0.5}), {0, -0.5}, {0, 1.5});
  expectFaces(two.at({0.5, 1.5}), {0, 0.5}, {0, -1.5});
}

TEST(createWallSurfaces, boxesThinnerThanTheirLayerAreOneSpacingThick) {
  const Walls<2> film({box({-20, 0}, {20, 0.2})});
  const WallSurface<2> s = film.at({0.5, 0.5});
  EXPECT_EQ(std::abs(s.face[0][1]), 0.5f);
  EXPECT_EQ(s.face[1], -s.face[0]);
}

/// A plate that stands on a floor: fluid on both sides of its foot.
TEST(createWallSurfaces, footOfAPlate) {
  const Walls<2> walls({box({-20, -9}, {20, 0}), box({-1, 0}, {1, 20})});
  expectFaces(walls.at({-0.5, -0.5}), {-0.5, 0.5}, {1.5, 0.5});
  expectFaces(walls.at({-0.5, 0.5}, 1), {-0.5, 0}, {1.5, 0});
}

TEST(createWallSurfaces, discAndRing) {
  const Walls<2> disc({sphere({1, 2}, 5)});
  expectFaces(disc.at({4, 6}), {0.003 / 5, 0.004 / 5}, nothing);  // on the surface, see below
  expectFaces(disc.at({1 - 2.4, 2 + 3.2}), {-0.6, 0.8}, nothing);
  const Walls<2> ring({sphere({0, 0}, 7, 4)});
  expectFaces(ring.at({3.6, 4.8}), {0.6, 0.8}, {-1.2, -1.6});
  expectFaces(ring.at({0, -5}), {0, 1}, {0, -2});
}

TEST(createWallSurfaces, thinRodsHaveTheFaceBehindTheirAxis) {
  const Walls<2> rod({sphere({0, 0}, 1.5)});
  expectFaces(rod.at({0, 0}), {1.5, 0}, {-1.5, 0});
  expectFaces(rod.at({0, 1}), {0, 0.5}, {0, -2.5});
  const Walls<3> rod3({cylinder({0, 0, -20}, {0, 0, 20}, 1.5)});
  expectFaces(rod3.at({0.6, 0.8, 0.5}), {0.3, 0.4, 0}, {-1.5, -2, 0});
}

TEST(createWallSurfaces, hollowSphere) {
  const Walls<3> shell({sphere({1, 2, 3}, 9, 6)});
  const Vec<3> d = Vec<3>{2, -3, 6} * (1 / 7.0);
  expectFaces(shell.at(Vec<3>{1, 2, 3} + 7.0 * d), -1.0 * d, 2.0 * d);
  expectFaces(shell.at(Vec<3>{1, 2, 3} + 8.0 * d), 1.0 * d, -2.0 * d);
}

TEST(createWallSurfaces, cylindersHaveMantlesAndCaps) {
  const Walls<3> rod({cylinder({0, 0, 0}, {0, 0, 20}, 6)});
  expectFaces(rod.at({3, 4, 2}), {0.6, 0.8, 0}, {0, 0, -2});
  expectFaces(rod.at({0, 1, 17.5}), {0, 0, 2.5}, nothing3);
  const Walls<3> pipe({cylinder({0, 0, 0}, {0, 0, 20}, 6, 3)});
  expectFaces(pipe.at({3, 4, 10}), {0.6, 0.8, 0}, {-1.2, -1.6, 0});
  expectFaces(pipe.at({2.4, 3.2, 1.5}), {-0.6, -0.8, 0}, {0, 0, -1.5});
}

TEST(createWallSurfaces, stripsAreCylindersInThePlane) {
  const Walls<2> channel({cylinder({0, 0}, {20, 0}, 6, 2)});
  expectFaces(channel.at({10.5, 3}), {0, -1}, {0, 3});
  expectFaces(channel.at({1.5, -5}), {0, -1}, {-1.5, 0});
  const Walls<2> strip({cylinder({0, 0}, {30, 40}, 1)});
  expectFaces(strip.at({15 + 0.4, 20 - 0.3}), {0.4, -0.3}, {-1.2, 0.9});
}

TEST(createWallSurfaces, inclinedCylinder) {
  const Vec<3> axis = Vec<3>{1, 2, 2} * (1 / 3.0), across = Vec<3>{2, -2, 1} * (1 / 3.0), start{1, 1, 1};
  const Walls<3> rod({cylinder(start, start + 20.0 * axis, 6)});
  expectFaces(rod.at(start + 10.0 * axis + 4.5 * across), 1.5 * across, nothing3);
  expectFaces(rod.at(start + 19.5 * axis + 4.5 * across), 0.5 * axis, 1.5 * across);
}

TEST(createWallSurfaces, cylinderOnAFloor) {
  for (const double depth : {0.0, 1.5}) {
    const Walls<3> walls({box({-20, -20, -9}, {20, 20, 0}), cylinder({0, 0, -depth}, {0, 0, 20}, 6, 2)});
    expectFace(walls.at({0, 3, -1}).face[0], {0, -1, 1});     // into the pipe
    expectFace(walls.at({3, 4, -1}).face[0], {0.6, 0.8, 1});  // beside it
    expectFace(walls.at({3, 4, -1}).face[1], {-1.8, -2.4, 1});
  }
}

TEST(createWallSurfaces, cutByAPlaneAtAnAngle) {
  Walls<2> slope({box({-20, -20}, {20, 20})});
  slope.c.bodies[0].where = "3*x + 4*y < 5";
  for (const Vec<2>& x : {Vec<2>{0, 1}, {0, 0}, {-1.3, 0.4}, {2, -3.2}}) {
    const double depth = (5 - 3 * x[0] - 4 * x[1]) / 5;
    expectFaces(slope.at(x), {0.6 * depth, 0.8 * depth}, nothing, 1e-4);
  }
  Walls<3> slope3({box({-20, -20, -20}, {20, 20, 20})});
  slope3.c.bodies[0].where = "2*x - 3*y + 6*z <= 1";
  for (const Vec<3>& x : {Vec<3>{0, 0, 0}, {0.3, 1.1, -1.2}, {0.5, 0, 0}}) {
    const double depth = std::max(1e-3, (1 - 2 * x[0] + 3 * x[1] - 6 * x[2]) / 7);
    expectFaces(slope3.at(x), Vec<3>{2, -3, 6} * (depth / 7), nothing3, 1e-4);
  }
}

/// A cut meets a face of the box: a convex edge of 45 degrees.
TEST(createWallSurfaces, edgesOfCuts) {
  Walls<2> wedge({box({-20, -20}, {20, 0})});
  wedge.c.bodies[0].where = "y < -x";
  expectFace(wedge.at({-2.5, -0.5}).face[0], {0, 0.5});
  expectFace(wedge.at({2.5, -3.5}).face[0], {0.5, 0.5}, 1e-4);
  wedge.c.bodies[0].where = "y < 2*x";  // of 117 degrees
  expectFaces(wedge.at({1, -1}), {0, 1}, {-1.2, 0.6}, 1e-4);
}

/// A notch: its bottom corner is the nearest point.
TEST(createWallSurfaces, cornersOfCuts) {
  Walls<2> notch({box({-20, -20}, {20, 20})});
  notch.c.bodies[0].where = "y < abs(x)";
  expectFace(notch.at({0.5, -2}).face[0], {-0.5, 2}, 1e-2);
  Walls<3> notch3({box({-20, -20, -20}, {20, 20, 20})});
  notch3.c.bodies[0].where = "z < max(abs(x), abs(y))";
  expectFace(notch3.at({0.5, 0.2, -2}).face[0], {-0.5, -0.2, 2}, 1e-2);
}

TEST(createWallSurfaces, subtractedBodiesLeaveTheirSurface) {
  Walls<2> block({box({-20, -20}, {20, 20}), sphere({0, 0}, 8)});
  block.c.bodies[0].subtract = {"wall 1"};
  block.c.bodies[1].kind = BodyKind::Fluid;
  expectFaces(block.at({0, 9.5}), {0, -1.5}, nothing, 1e-4);
  expectFaces(block.at({6, 8}), Vec<2>{-0.6, -0.8} * 2, nothing, 1e-4);
  expectFaces(block.at({18.5, 0}), {1.5, 0}, nothing);
  // A wall in the hole that moves along fills it.
  block.c.bodies[1].kind = BodyKind::Wall;
  expectFaces(block.at({0, 9.5}), nothing, nothing);
}

TEST(createWallSurfaces, curvedCuts) {
  Walls<2> hole({box({-20, -20}, {20, 20})});
  hole.c.bodies[0].where = "x*x + y*y > 4";
  expectFaces(hole.at({3, 4}), {-1.8, -2.4}, nothing, 1e-3);
  hole.c.bodies[0].where = "x*x + y*y > 0.25";
  expectFaces(hole.at({1.8, -2.4}), {-1.5, 2}, nothing, 1e-3);
  Walls<3> ball({box({-20, -20, -20}, {20, 20, 20})});
  ball.c.bodies[0].where = "x*x + y*y + z*z < 25";
  expectFaces(ball.at({0.6, 2.4, 2.8}), Vec<3>{0.6, 2.4, 2.8} * (5 / std::sqrt(13.96) - 1), nothing3, 1e-3);
  ball.c.bodies[0].where = "x*x + y*y + z*z > 4";
  expectFaces(ball.at({2, 3, 2.5}), Vec<3>{2, 3, 2.5} * (2 / std::sqrt(19.25) - 1), nothing3, 1e-3);
}

/// From near and far, compared with their radius.
TEST(createWallSurfaces, roundHolesCutAtManyDistances) {
  Walls<3> hole({box({-20, -20, -20}, {20, 20, 20})});
  hole.c.bodies[0].where = "x*x + y*y + z*z > 2.25";
  const Vec<3> d = Vec<3>{-6, 3, 2} * (1 / 7.0);
  for (double depth = 0.01; depth < 3.5; depth += 0.07)
    expectFaces(hole.at(d * (1.5 + depth)), d * -depth, nothing3, 1e-3);
}

TEST(createWallSurfaces, wavyCut) {
  Walls<2> bed({box({-20, -20}, {20, 20})});
  bed.c.bodies[0].where = "y < 1.5*sin(0.8*x)";
  for (double x = -6; x < 6; x += 0.37)
    for (double y = -4; y < 1.5 * std::sin(0.8 * x); y += 0.41) {
      Vec<2> nearest{1e3, 0};
      for (double a = x - 5; a < x + 5; a += 1e-4) {
        const Vec<2> d = Vec<2>{a, 1.5 * std::sin(0.8 * a)} - Vec<2>{x, y};
        if (norm2(d) < norm2(nearest)) nearest = d;
      }
      const WallSurface<2> s = bed.at({x, y});
      const bool farther = norm(nearest) > bed.c.viscosityRadius();
      EXPECT_NEAR(norm(s.face[0]), farther ? 0 : norm(nearest), 1e-3) << x << ' ' << y;
    }
}

/// Whatever the way they are put together.
TEST(createWallSurfaces, seamsAreNoSurface) {
  for (const double end : {0.0, 3.0}) {
    const Walls<2> floor({box({-20, -9}, {0, 0}), box({-end, -9}, {20, 0})});
    expectFaces(floor.at({-0.5, -1.5}), {0, 1.5}, nothing);
    expectFaces(floor.at({0.5, -1.5}, 1), {0, 1.5}, nothing);
  }
  Walls<2> plugged({sphere({0, 0}, 9, 4), sphere({0, 0}, 4)});
  expectFaces(plugged.at({0, 5}), nothing, nothing);
  Walls<2> filled({box({-20, -20}, {20, 20}), box({-20, -20}, {20, 20})});
  filled.c.bodies[0].where = "y < 0";
  filled.c.bodies[1].where = "y > 0";
  expectFaces(filled.at({0.5, -0.5}), nothing, nothing);
  filled.c.bodies[1].where = "y > 1";
  expectFaces(filled.at({0.5, -0.5}), {0, 0.5}, nothing, 1e-4);
}

TEST(createWallSurfaces, gapsAreNotLookedAcross) {
  const Walls<2> walls({box({-20, -9}, {20, 0}), box({-2, 2}, {2, 3})});
  expectFaces(walls.at({-1.5, 2.5}, 1), {-0.5, 0}, {0, 0.5});
  expectFaces(walls.at({0.5, -0.5}), {0, 0.5}, nothing);
  // The gap between two plates: the far sides of the other one are no faces.
  const Walls<2> plates({box({-20, 0}, {20, 1}), box({-20, 2}, {20, 3})});
  const WallSurface<2> s = plates.at({0.5, 0.5});
  EXPECT_EQ(s.face[1], -s.face[0]);
}

TEST(createWallSurfaces, periodicFloorHasNoEnds) {
  Walls<2> floor({box({0, -9}, {20, 0})});
  floor.c.domain = {{0, -20}, {20, 20}, {false, false, false}};
  expectFaces(floor.at({0.5, -1.5}), {-0.5, 0}, {0, 1.5});
  floor.c.domain.periodic[0] = true;
  expectFaces(floor.at({0.5, -1.5}), {0, 1.5}, nothing);
  floor.c.bodies[0].shape = box({0, -9}, {18, 0});
  expectFaces(floor.at({17.5, -1.5}), {0.5, 0}, {0, 1.5});
  // Two walls that meet across the boundary make a corner.
  floor.c.bodies[0].shape = box({0, -9}, {20, 0});
  floor.c.bodies.push_back(makeBody("pillar", BodyKind::Wall, box({16, 0}, {20, 9})));
  expectFace(floor.at({17.5, -1.5}).face[0], {-1.5, 1.5});
  expectFaces(floor.at({0.5, -1.5}), {0, 1.5}, nothing);
  expectFaces(floor.at({19.5, 1.5}, 1), {0.5, 0}, {-3.5, 0});
}

TEST(createWallSurfaces, aRoomThatSticksOutOfAPeriodicDomainHasNoEnds) {
  Shape room;
  room.kind = ShapeKind::Polygon, room.fill = FillKind::Outside, room.thickness = 9;
  room.points = {{-5, 0}, {25, 0}, {25, 20}, {-5, 20}};
  Walls<2> pipe({room});
  pipe.c.domain = {{0, -20}, {20, 40}, {true, false, false}};
  pipe.c.bodies[0].where = "x > 0 && x < 20";
  for (const double x : {0.5, 2.5, 19.5}) expectFaces(pipe.at({x, -1.5}), {0, 1.5}, nothing);
  pipe.c.domain.periodic[0] = false;
  expectFaces(pipe.at({0.5, -1.5}), {-0.5, 0}, {0, 1.5}, 1e-4);
  // What a condition takes away of each image leaves a surface.
  pipe.c.domain.periodic[0] = true;
  pipe.c.bodies[0].where = "x > 0 && x < 18";
  expectFaces(pipe.at({17.5, -1.5}), {0.5, 0}, {0, 1.5}, 1e-4);
  expectFaces(pipe.at({0.5, -1.5}), {-0.5, 0}, {0, 1.5}, 1e-4);
}

TEST(createWallSurfaces, conditionsGoAlongWithImages) {
  Walls<2> bed({box({0, -9}, {20, 9})});
  bed.c.domain = {{0, -20}, {20, 20}, {true, false, false}};
  bed.c.bodies[0].where = "y < 0.2*x";
  expectFaces(bed.at({0.5, -0.5}), Vec<2>{-0.2, 1} * (0.6 / 1.04), nothing, 1e-4);
  expectFaces(bed.at({19.5, 2.5}), Vec<2>{0.5, 0}, Vec<2>{-0.2, 1} * (1.4 / 1.04), 1e-4);
  bed.c.domain.periodic[0] = false;
  expectFaces(bed.at({0.5, -0.5}), {-0.5, 0}, Vec<2>{-0.2, 1} * (0.6 / 1.04), 1e-4);
}

TEST(createWallSurfaces, wallsThatMoveDifferentlyHaveSurfacesOfTheirOwn) {
  Walls<2> lid({box({-20, -9}, {20, 0}), box({-20, 0}, {20, 9})});
  expectFaces(lid.at({0.5, -0.5}), nothing, nothing);
  const Body still = lid.c.bodies[1];
  lid.c.bodies[1].velocity = {1, 0};
  expectFaces(lid.at({0.5, -0.5}), {0, 0.5}, nothing);
  expectFaces(lid.at({0.5, 0.5}, 1), {0, -0.5}, nothing);
  lid.c.bodies[0].velocity = {1, 0};
  expectFaces(lid.at({0.5, -0.5}), nothing, nothing);
  lid.c.bodies[0].velocity = {}, lid.c.bodies[1] = still;
  lid.c.bodies[1].oscillation = {{1, 0}, 2, 0};
  expectFaces(lid.at({0.5, -0.5}), {0, 0.5}, nothing);
  lid.c.bodies[0].oscillation = lid.c.bodies[1].oscillation;
  expectFaces(lid.at({0.5, -0.5}), nothing, nothing);
  lid.c.bodies[0].oscillation = {}, lid.c.bodies[1] = still;
  lid.c.bodies[1].rotation = Rotation{{0, 5}, {0, 0, 1}, 2};
  expectFaces(lid.at({0.5, -0.5}), {0, 0.5}, nothing);
  lid.c.bodies[0].rotation = Rotation{{0, 5}, {0, 0, 2}, 2};  // the same one
  expectFaces(lid.at({0.5, -0.5}), nothing, nothing);
  lid.c.bodies[0].rotation->center = {0, 4};
  expectFaces(lid.at({0.5, -0.5}), {0, 0.5}, nothing);
  lid.c.bodies[0].rotation.reset(), lid.c.bodies[1].rotation->speed = 0;
  expectFaces(lid.at({0.5, -0.5}), nothing, nothing);
  lid.c.bodies[0].rotation = lid.c.bodies[1].rotation =
      Rotation{{0, 5}, {0, 0, 1}, 0, TimeFunction{0, {}, {0, 1}, {0, 1}}};
  expectFaces(lid.at({0.5, -0.5}), nothing, nothing);
  lid.c.bodies[1].velocity = {1, 0};
  expectFaces(lid.at({0.5, -0.5}), {0, 0.5}, nothing);
}

TEST(createWallSurfaces, fluidDoesNotCoverWalls) {
  Walls<2> pool({box({-20, -9}, {20, 0}), box({-20, 0}, {20, 9})});
  pool.c.bodies[1].kind = BodyKind::Fluid;
  expectFaces(pool.at({0.5, -0.5}), {0, 0.5}, nothing);
}

TEST(createWallSurfaces, particlesOfTheSurfaceKnowItsDirection) {
  const double out = 1e-7;  // rounding of a lattice
  const Walls<2> disc({sphere({0, 0}, 5)});
  for (const double r : {5 - out, 5.0, 5 + out})
    expectFaces(disc.at({0.6 * r, -0.8 * r}), {0.6e-3, -0.8e-3}, nothing, 1e-8);
  const Walls<3> pipe({cylinder({0, 0, -20}, {0, 0, 20}, 9, 4)});
  for (const double r : {4 - out, 4.0, 4 + out})
    expectFaces(pipe.at({0.6 * r, -0.8 * r, 0}), {-0.6e-3, 0.8e-3, 0}, nothing3, 1e-8);
  Walls<2> cut({box({-20, -20}, {20, 20})});
  cut.c.bodies[0].where = "3*x + 4*y <= 5";
  expectFaces(cut.at({1, 0.5}), {0.6e-3, 0.8e-3}, nothing, 1e-5);
}

/// Enough particles for several threads.
TEST(createWallSurfaces, particlesDoNotDependOnEachOther) {
  Walls<2> walls({box({-20, -20}, {20, 20}), sphere({0, 30}, 14, 4)});
  walls.c.bodies[0].where = "x*x + y*y > 40";
  std::vector<Vec<2>> position;
  std::vector<std::uint8_t> body;
  for (double x = -19.75; x < 20; x += 0.5)
    for (double y = -19.75; y < 20; y += 0.5)
      if (x * x + y * y > 40) position.push_back({x, y}), body.push_back(0);
  std::vector<std::string> notes;
  const auto surfaces = createWallSurfaces<2>(walls.c, position, body, notes);
  ASSERT_GT(surfaces.size(), 5000u);
  for (std::size_t k = 0; k < surfaces.size(); k += 23) EXPECT_EQ(surfaces[k], walls.at(position[k]));
}

TEST(createWallSurfaces, notesWallsWithoutASurface) {
  Case c = emptyCase(2);
  c.bodies = {makeBody("drop", BodyKind::Fluid, box({50, 50}, {52, 52})),
              makeBody("core", BodyKind::Wall, box({-2, -2}, {2, 2})),
              makeBody("hull", BodyKind::Wall, box({-8, -8}, {8, 8}))};
  std::vector<std::string> notes;
  const Particles<2> p = createParticles<2>(c, notes);
  const std::span<const Vec<2>> position = p.position;
  const std::span<const std::uint8_t> body = p.body;
  notes.clear();
  const auto surfaces = createWallSurfaces<2>(c, position.subspan(4), body.subspan(4), notes);
  EXPECT_EQ(surfaces.size(), 256u);
  EXPECT_THAT(notes,
              ElementsAre("wall 'core': none of its 16 particles has a surface of the walls within the viscosity "
                          "radius h_v = 3.5 m; no fluid can be next to it"));
  // Those who have a part each know it together.
  const WallSurface<2> none{};
  std::vector<WallSight> sum(c.bodies.size());
  for (const std::size_t begin : {std::size_t{0}, surfaces.size() / 2}) {
    const auto part = std::span(surfaces).subspan(begin, surfaces.size() / 2);
    const std::vector<WallSight> sight = wallSight<2>(c, body.subspan(4 + begin), part);
    EXPECT_EQ(sight[1].seeing, 0u);
    EXPECT_EQ(sight[2].seeing + static_cast<std::size_t>(std::ranges::count(part, none)), part.size());
    for (std::size_t b = 0; b < sum.size(); ++b)
      sum[b].particles += sight[b].particles, sum[b].seeing += sight[b].seeing;
  }
  std::vector<std::string> together;
  noteBlindWalls(c, sum, together);
  EXPECT_EQ(together, notes);

  c.bodies[1].velocity = {1, 0};
  notes.clear();
  createWallSurfaces<2>(c, position.subspan(4), body.subspan(4), notes);
  EXPECT_THAT(notes, IsEmpty());
}

/// Whether a point is in a shape that is grown by the slack: written anew, for comparison.
template <int D>
bool within(const Shape& s, const Vec<D>& x, double slack) {
  const Vec<3> p = resized<3>(x);
  const auto between = [&](double r) {
    return r <= s.radius + slack && (s.innerRadius == 0 || r >= s.innerRadius - slack);
  };
  if (s.kind == ShapeKind::Sphere) return between(norm(p - s.center));
  if (s.kind == ShapeKind::Cylinder) {
    const Vec<3> axis = s.end - s.start;
    const double along = dot(p - s.start, axis) / norm2(axis), excess = slack / norm(axis);
    return along >= -excess && along <= 1 + excess && between(norm(p - s.start - along * axis));
  }
  for (int k = 0; k < D; ++k)
    if (p[k] < s.min[k] - slack || p[k] > s.max[k] + slack) return false;
  return true;
}

/// Points spread over the surface of a shape, no farther than h from each other.
template <int D>
std::vector<Vec<D>> samples(const Shape& s, double h) {
  std::vector<Vec<D>> points;
  const auto upTo = [&](double length, auto&& f) {
    const int n = std::max(1, static_cast<int>(std::ceil(length / h)));
    for (int k = 0; k <= n; ++k) f(static_cast<double>(k) / n);
  };
  const auto rectangle = [&](Vec<3> o, Vec<3> a, Vec<3> b) {
    upTo(norm(a), [&](double u) {
      if (D == 2) return points.push_back(resized<D>(o + u * a));
      upTo(norm(b), [&](double v) { points.push_back(resized<D>(o + u * a + v * b)); });
    });
  };
  if (s.kind == ShapeKind::Box) {
    const Vec<3> e = s.max - s.min;
    for (int k = 0; k < D; ++k) {
      Vec<3> a{}, b{};
      const int i = (k + 1) % D, j = D == 3 ? (k + 2) % D : 2;
      a[i] = e[i];
      if (D == 3) b[j] = e[j];
      Vec<3> other = s.min;
      other[k] = s.max[k];
      rectangle(s.min, a, b), rectangle(other, a, b);
    }
    return points;
  }
  for (const double r : {s.radius, s.innerRadius}) {
    if (r == 0) continue;
    if (s.kind == ShapeKind::Sphere) {
      upTo(2 * M_PI * r, [&](double u) {
        const Vec<3> d{std::cos(2 * M_PI * u), std::sin(2 * M_PI * u)};
        if (D == 2) return points.push_back(resized<D>(s.center + r * d));
        upTo(M_PI * r, [&](double v) {
          points.push_back(resized<D>(s.center + r * (std::sin(M_PI * v) * d + Vec<3>{0, 0, std::cos(M_PI * v)})));
        });
      });
      continue;
    }
    const Vec<3> axis = s.end - s.start, n = axis * (1 / norm(axis));
    Vec<3> a = D == 2 ? Vec<3>{-n[1], n[0]} : cross(n, std::abs(n[0]) < 0.6 ? Vec<3>{1, 0, 0} : Vec<3>{0, 1, 0});
    a *= 1 / norm(a);
    const Vec<3> b = cross(n, a);
    const auto around = [&](double radius, auto&& f) {
      if (D == 2) return f(radius * a), f(-radius * a);
      upTo(2 * M_PI * radius,
           [&](double u) { f(radius * (std::cos(2 * M_PI * u) * a + std::sin(2 * M_PI * u) * b)); });
    };
    around(r, [&](const Vec<3>& d) {
      upTo(norm(axis), [&](double v) { points.push_back(resized<D>(s.start + d + v * axis)); });
    });
    if (r == s.radius)
      upTo(s.radius - s.innerRadius, [&](double v) {
        around(std::max(1e-9, s.innerRadius + v * (s.radius - s.innerRadius)), [&](const Vec<3>& d) {
          points.push_back(resized<D>(s.start + d)), points.push_back(resized<D>(s.end + d));
        });
      });
  }
  return points;
}

template <int D>
Shape randomShape(std::mt19937& random) {
  const auto number = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const auto place = [&](double extent) {
    Vec<3> x{};
    for (int k = 0; k < D; ++k) x[k] = number(-extent, extent);
    return x;
  };
  const double radius = number(2, 4), hollow = number(0, 1) < 0.5 ? 0 : number(0.2, 0.7) * radius;
  switch (random() % 3) {
    case 0: {
      const Vec<3> min = place(4);
      Vec<3> max = min;
      for (int k = 0; k < D; ++k) max[k] += number(1, 6);
      return box(min, max);
    }
    case 1:
      return sphere(place(3), radius, hollow);
    default: {
      const Vec<3> start = place(3);
      Vec<3> way = place(1);
      way *= number(3, 8) / norm(way);
      return cylinder(start, start + way, radius / 2, hollow / 2);
    }
  }
}

/// The nearest face of walls put together at random ends where no wall is, and nearer than any of a dense cloud of
/// points on their surfaces. Without those where a gap is so thin that it need not count.
template <int D>
void compareWithSamples(int cases, int particles, double h) {
  constexpr double gap = 5e-3;
  std::mt19937 random(D);
  int compared = 0;
  for (int k = 0; k < cases; ++k) {
    std::vector<Shape> shapes;
    const std::size_t count = 1 + random() % 4;
    for (std::size_t b = 0; b < count; ++b) shapes.push_back(randomShape<D>(random));
    const Walls<D> walls(shapes);
    const auto covers = [&](const Vec<D>& x, double slack) {
      return [&x, slack](const Shape& s) { return within<D>(s, x, slack); };
    };
    std::vector<Vec<D>> surface;
    for (const Shape& shape : shapes)
      for (const Vec<D>& x : samples<D>(shape, h))
        if (std::ranges::count_if(shapes, covers(x, gap)) == 1) surface.push_back(x);
    for (int i = 0; i < particles; ++i) {
      Vec<D> x{};
      for (int d = 0; d < D; ++d) x[d] = std::uniform_real_distribution<double>(-6, 6)(random);
      const auto body = std::ranges::find_if(shapes, covers(x, -0.01));
      if (body == shapes.end()) continue;
      double distance = 1e300;
      for (const Vec<D>& s : surface) distance = std::min(distance, norm(s - x));
      if (distance > walls.c.viscosityRadius()) continue;
      ++compared;
      const WallSurface<D> s = walls.at(x, static_cast<std::uint8_t>(body - shapes.begin()));
      Vec<D> point = x;
      for (int d = 0; d < D; ++d) point[d] += s.face[0][d];
      EXPECT_NE(norm(s.face[0]), 0) << "case " << k << ", particle " << i;
      EXPECT_LE(norm(s.face[0]), distance + 2e-3) << "case " << k << ", particle " << i;
      EXPECT_TRUE(std::ranges::none_of(shapes, covers(point, -2e-3))) << "case " << k << ", particle " << i;
    }
  }
  EXPECT_GE(compared, cases * particles / 20);
}

TEST(createWallSurfaces, agreesWithSamplesOfRandomWallsInThePlane) { compareWithSamples<2>(400, 60, 0.005); }

TEST(createWallSurfaces, agreesWithSamplesOfRandomWallsInSpace) { compareWithSamples<3>(80, 40, 0.07); }

}  // namespace
}  // namespace treacle::test
