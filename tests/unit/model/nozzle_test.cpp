#include "treacle/model/motion/nozzle.hpp"

#include "treacle/core/error.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace treacle::test {
namespace {

Case caseOf(int dimensions) {
  Case c;
  c.dimensions = dimensions;
  c.spacing = 0.1;
  return c;
}

Body inflow(NozzleKind kind) {
  Body b;
  b.name = "jet";
  b.kind = BodyKind::Inflow;
  b.inflow.nozzle.kind = kind;
  b.inflow.nozzle.center = {1, 2, 3};
  b.inflow.nozzle.direction = {1, 2, -2};
  b.inflow.speed = TimeFunction{0.5};
  return b;
}

/// Places across the direction, a spacing from the next ones, within the opening; layers a way apart.
TEST(NozzleLayers, AreALatticeAcrossTheDirection) {
  const Case c = caseOf(3);
  Body b = inflow(NozzleKind::Disc);
  b.inflow.nozzle.radius = 1.23;
  b.inflow.nozzle.innerRadius = 0.4;
  const NozzleLayers<3> layers(c, b);
  const Vec<3> n{1.0 / 3, 2.0 / 3, -2.0 / 3};
  EXPECT_LE(norm(layers.direction(7) - n), 1e-15);
  EXPECT_NEAR(layers.area(), std::numbers::pi * (1.23 * 1.23 - 0.4 * 0.4), 0.02 * layers.openingArea());
  EXPECT_NEAR(layers.openingArea(), std::numbers::pi * (1.23 * 1.23 - 0.4 * 0.4), 1e-12);
  const std::vector<Vec<3>> places = layers.layer(0.25, 7), next = layers.layer(0.35, 7);
  ASSERT_EQ(places.size(), layers.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Vec<3> d = places[i] - Vec<3>{1, 2, 3};
    EXPECT_NEAR(dot(d, n), 0.25, 1e-12);
    const double r = norm(d - dot(d, n) * n);
    EXPECT_LE(r, 1.23 + 1e-9);
    EXPECT_GE(r, 0.4 - 1e-9);
    EXPECT_LE(norm(next[i] - places[i] - 0.1 * n), 1e-12);
    double nearest = 1;
    for (std::size_t j = 0; j < places.size(); ++j)
      if (j != i) nearest = std::min(nearest, norm(places[j] - places[i]));
    EXPECT_NEAR(nearest, 0.1, 1e-12);
  }
  EXPECT_EQ(layers.depth(), 4);
}

TEST(NozzleLayers, ARectangleStandsAlongItsUp) {
  const Case c = caseOf(3);
  Body b = inflow(NozzleKind::Rectangle);
  b.inflow.nozzle.direction = {0, 0, -2};
  b.inflow.nozzle.width = 0.51;
  b.inflow.nozzle.height = 0.2;
  b.inflow.nozzle.up = {3, 0, 1};
  const NozzleLayers<3> layers(c, b);
  EXPECT_EQ(layers.size(), 10u);
  double alongX = 0, alongY = 0;
  for (const Vec<3>& x : layers.layer(0, 0)) {
    alongX = std::max(alongX, std::abs(x[0] - 1)), alongY = std::max(alongY, std::abs(x[1] - 2));
    EXPECT_NEAR(x[2], 3, 1e-12);
  }
  EXPECT_NEAR(alongX, 0.05, 1e-12);
  EXPECT_NEAR(alongY, 0.2, 1e-12);
  std::vector<std::string> notes;
  describeNozzle(b, layers, notes);
  EXPECT_THAT(notes, testing::ElementsAre(testing::HasSubstr("2 % less than the 0.102 m2 of its nozzle")));
}

/// An L, which is not convex, upright: along the width goes direction x up.
TEST(NozzleLayers, APolygonHasItsOutline) {
  const Case c = caseOf(3);
  Body b = inflow(NozzleKind::Polygon);
  b.inflow.nozzle.direction = {0, 0, -1};
  b.inflow.nozzle.up = {0, 1, 0};
  b.inflow.nozzle.points = {{-0.2, -0.3}, {0.4, -0.3}, {0.4, -0.1}, {0, -0.1}, {0, 0.3}, {-0.2, 0.3}};
  const NozzleLayers<3> layers(c, b);
  EXPECT_NEAR(layers.openingArea(), 0.2, 1e-15);
  EXPECT_EQ(layers.size(), 20u);
  for (const Vec<3>& x : layers.layer(0, 0)) {
    const double u = x[0] - 1, v = x[1] - 2;  // (0, 0, -1) x (0, 1, 0) = (1, 0, 0)
    EXPECT_TRUE((u > -0.2 && u < 0 && v > -0.3 && v < 0.3) || (u > 0 && u < 0.4 && v > -0.3 && v < -0.1));
  }
  b.inflow.nozzle.points = {{-1.04, -0.9}, {1.03, -0.95}, {0.02, 0.97}};
  const NozzleLayers<3> triangle(c, b);
  EXPECT_NEAR(triangle.area(), triangle.openingArea(), 0.02 * triangle.openingArea());
}

TEST(NozzleLayers, InAPlaneAreASegment) {
  const Case c = caseOf(2);
  Body b = inflow(NozzleKind::Disc);
  b.inflow.nozzle.center = {}, b.inflow.nozzle.direction = {0, -1, 0};
  b.inflow.nozzle.radius = 0.2;
  const NozzleLayers<2> disc(c, b);
  EXPECT_EQ(disc.size(), 4u);
  EXPECT_NEAR(disc.openingArea(), 0.4, 1e-15);
  b.inflow.nozzle.kind = NozzleKind::Rectangle;
  b.inflow.nozzle.width = 0.3;
  EXPECT_EQ((NozzleLayers<2>(c, b).size()), 3u);
}

TEST(NozzleLayers, SpeedIsTheMeanOfAStep) {
  const Case c = caseOf(2);
  Body b = inflow(NozzleKind::Rectangle);
  b.inflow.nozzle.direction = {1, 0, 0};
  b.inflow.nozzle.width = 0.5;
  b.inflow.start = 1, b.inflow.end = 3;
  const NozzleLayers<2> layers(c, b);
  EXPECT_EQ(layers.speed(1.5, 0.5), 0.5);
  EXPECT_EQ(layers.speed(1.5, 0), 0.5);
  EXPECT_EQ(layers.speed(0.5, 0), 0);
  EXPECT_EQ(layers.speed(3, 0), 0);
  EXPECT_NEAR(layers.speed(0.75, 1), 0.375, 1e-15);
  EXPECT_NEAR(layers.speed(2.9, 1), 0.05, 1e-14);
  EXPECT_EQ(layers.speed(4, 1), 0);
  Body rate = b;
  rate.inflow.speed.reset();
  rate.inflow.flowRate = TimeFunction{0, "t"};
  EXPECT_NEAR((NozzleLayers<2>(c, rate).speed(1, 2)), 2 / 0.5, 1e-12);
}

/// The motion of a step leads each place of a layer to where that layer is at its end, whatever it turns and moves
/// by; fluid that leaves has the velocities, and what drives it the accelerations, of these places.
TEST(NozzleLayers, TurnWithTheirNozzle) {
  const Case c = caseOf(3);
  Body b = inflow(NozzleKind::Disc);
  b.inflow.nozzle.radius = 0.2;
  b.velocity = {0.1, -0.2, 0.3};
  b.rotation = Rotation{.center = {0.5, 1, 4}, .axis = {1, -2, 0.5}, .angle = TimeFunction{0, "2*t+0.1"}};
  const NozzleLayers<3> layers(c, b);
  const double t = 0.3, dt = 0.2, way = -0.15;
  const WallMotion<3> motion = layers.motion(c.domain, t, dt);
  const auto from = layers.layer(way, t), to = layers.layer(way + 0.5 * dt, t + dt);
  ASSERT_GT(from.size(), 5u);
  const Vec<3> axis = b.rotation->direction(), arm = from[0] - (Vec<3>{0.5, 1, 4} + t * b.velocity);
  EXPECT_NEAR(norm(arm), norm(NozzleLayers<3>(c, b).layer(way, 0)[0] - b.rotation->center), 1e-12);
  EXPECT_NEAR(dot(layers.direction(t), axis), dot(layers.direction(0), axis), 1e-14);
  EXPECT_NEAR(dot(layers.direction(t), layers.direction(0)),
              std::cos(2 * t) + (1 - std::cos(2 * t)) * std::pow(dot(layers.direction(0), axis), 2), 1e-14);
  for (std::size_t i = 0; i < from.size(); ++i)
    EXPECT_LE(norm(from[i] + dt * motion.chordAt(from[i]) - to[i]), 1e-12);

  const double e = 1e-4;
  const auto before = layers.layer(way - 0.5 * e, t - e), after = layers.layer(way + 0.5 * e, t + e);
  const WallMotion<3> leaving = layers.motionAtEnd(c.domain, t - 1e-9, 1e-9);
  for (std::size_t i = 0; i < from.size(); ++i) {
    const Vec<3> u = (1 / (2 * e)) * (after[i] - before[i]);
    const Vec<3> a = (1 / (e * e)) * (after[i] - 2.0 * from[i] + before[i]);
    EXPECT_LE(norm(leaving.velocityAt(from[i]) - u), 1e-6);
    EXPECT_LE(norm(leaving.accelerationAt(from[i]) - a), 1e-4);
  }
}

/// By how much the fastest column is faster than the mean.
template <int D>
double peakOf(const Body& b) {
  const NozzleLayers<D> layers(caseOf(D), b);
  EXPECT_EQ(layers.profile().size(), layers.size());
  const double count = static_cast<double>(layers.size());
  EXPECT_NEAR(std::accumulate(layers.profile().begin(), layers.profile().end(), 0.0), count, 1e-12 * count);
  EXPECT_GE(std::ranges::min(layers.profile()), 0);
  return std::ranges::max(layers.profile());
}

/// What tables of flow in ducts have for the largest speed over the mean.
TEST(NozzleProfiles, ArePoiseuilles) {
  Body slit = inflow(NozzleKind::Rectangle);
  slit.inflow.profile = "parabolic";
  slit.inflow.nozzle.width = 4.1, slit.inflow.nozzle.height = 4.1;
  Body disc = slit;
  disc.inflow.nozzle.kind = NozzleKind::Disc;
  disc.inflow.nozzle.radius = 2.05;
  EXPECT_NEAR(peakOf<3>(slit), 2.0962, 0.01);
  EXPECT_NEAR(peakOf<3>(disc), 2, 0.02);
  for (Body* b : {&slit, &disc}) b->inflow.nozzle.direction = {1, 2, 0};
  EXPECT_NEAR(peakOf<2>(slit), 1.5, 0.002);
  EXPECT_NEAR(peakOf<2>(disc), 1.5, 0.002);
  slit.inflow.nozzle.height = 2.1;
  EXPECT_NEAR(peakOf<3>(slit), 1.992, 0.01);
  slit.inflow.nozzle.width = 2.1, slit.inflow.nozzle.height = 40.1;
  EXPECT_NEAR(peakOf<3>(slit), 1.5 / (1 - 0.63 * 2.1 / 40.1), 0.01);
  disc.inflow.nozzle.innerRadius = 1.025;  // a ring of half the radius
  EXPECT_NEAR(peakOf<3>(disc), 1.5078, 0.03);
  EXPECT_NEAR(peakOf<2>(disc), 1.5, 0.06);  // 10 particles on each side
}

/// Of the place in the case, in proportion; equal on both sides of the middle of its own.
TEST(NozzleProfiles, AreExpressionsOfThePlace) {
  Case c = caseOf(3);
  Body b = inflow(NozzleKind::Rectangle);
  b.inflow.nozzle.direction = {0, 0, 2};
  b.inflow.nozzle.width = 0.8, b.inflow.nozzle.height = 0.4;
  b.inflow.profile = "7*(1 - ((x-1)/0.5)^2)*(y-1.5)*z";
  b.rotation = Rotation{.speed = 2};  // about the origin
  const NozzleLayers<3> layers(c, b);
  const std::vector<Vec<3>> places = layers.layer(0, 0);
  const auto at = [](const Vec<3>& x) { return (1 - 4 * (x[0] - 1) * (x[0] - 1)) * (x[1] - 1.5); };
  for (std::size_t k = 1; k < places.size(); ++k)
    EXPECT_NEAR(layers.profile()[k] / layers.profile()[0], at(places[k]) / at(places[0]), 1e-9);
  // Each column is found wherever the nozzle has turned to, and how far it has gone.
  std::vector<double> numbers(layers.size());
  std::iota(numbers.begin(), numbers.end(), 0.0);
  c.domain = {{-3, -3, 0}, {3, 3, 6}, {true, true, true}};
  for (const double t : {0.0, 0.4, 1.3}) {
    NozzleColumns<3> columns = layers.columns(c.domain, t);
    const std::vector<Vec<3>> each = layers.eachOf(numbers, {1, 0, 0}), now = layers.layer(-0.23, t);
    for (std::size_t k = 0; k < now.size(); ++k) {
      Vec<3> x = now[k];
      for (int axis = 0; axis < 3; ++axis)
        x[axis] -= 6 * std::floor((x[axis] - c.domain.min[axis]) / 6);  // where the domain has it
      EXPECT_EQ(each[columns.placeOf(x)][0], numbers[k]) << t;
    }
  }
}

TEST(NozzleLayers, NeedRoomForAParticle) {
  const Case c = caseOf(3);
  Body b = inflow(NozzleKind::Disc);
  b.inflow.nozzle.radius = 0.06, b.inflow.nozzle.innerRadius = 0.055;
  EXPECT_THROW((NozzleLayers<3>(c, b)), InputError);
  b.inflow.nozzle.radius = 1e9;
  EXPECT_THROW((NozzleLayers<3>(c, b)), InputError);
}

TEST(TimeFunction, IntegratesExactly) {
  const TimeFunction table{0, "", {1, 2, 4}, {3, 5, -1}};
  EXPECT_EQ(table.at(0), 3);
  EXPECT_EQ(table.at(1.5), 4);
  EXPECT_EQ(table.at(3), 2);
  EXPECT_EQ(table.at(9), -1);
  EXPECT_NEAR(table.integral(0, 1), 3, 1e-15);
  EXPECT_NEAR(table.integral(0, 5), 3 + 4 + 4 - 1, 1e-14);
  EXPECT_NEAR(table.integral(1.5, 3), 2.25 + 3.5, 1e-14);
  const TimeFunction formula{0, "6*t^5"};
  EXPECT_NEAR(formula.integral(1, 2), 63, 1e-12);
  EXPECT_EQ((TimeFunction{2}.integral(1, 4)), 6);
  EXPECT_THROW((TimeFunction{0, "1/t"}.at(0)), InputError);
}

}  // namespace
}  // namespace treacle::test
