#include "treacle/model/motion/carried_probe.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace treacle {
namespace {

void expectNear(const Vec<3>& a, const Vec<3>& b) {
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(a[k], b[k], 1e-12);
}

TEST(CarriedProbe, GoesAndTurnsWithItsWall) {
  Case c;
  Body wall;
  wall.name = "door", wall.kind = BodyKind::Wall;
  wall.velocity = {0, 0, 3};
  wall.rotation = Rotation{.center = {1, 1, 0}, .speed = std::numbers::pi / 2};
  c.bodies = {wall};
  const Probe probe{.kind = ProbeKind::Flow, .point = {2, 1, 0}, .normal = {1, 0, 0}, .movesWith = "door"};
  const Probe now = carriedProbe(probe, c, {}, 1);
  expectNear(now.point, {1, 2, 3});
  expectNear(now.normal, {0, 1, 0});
  EXPECT_EQ(carriedProbe(probe, c, {}, 0), probe);
  Probe free = probe;
  free.movesWith.clear();
  EXPECT_EQ(carriedProbe(free, c, {}, 1), free);
}

TEST(CarriedProbe, OfARigidBodyIsAWayFromItsCentre) {
  Case c;
  Body block;
  block.name = "block", block.kind = BodyKind::Rigid;
  c.bodies = {Body{}, block};
  std::vector<RigidBody> rigid(2);
  rigid[1].center = {5, 5, 5};
  rigid[1].orientation = {std::sqrt(0.5), 0, 0, std::sqrt(0.5)};  // a quarter of a turn about z
  const Probe probe{
      .kind = ProbeKind::WallPressure, .corner = {1, 0, 0}, .along = {0, 2, 0}, .up = {0, 0, 3}, .body = "block"};
  const Probe now = carriedProbe(probe, c, rigid, 7);
  expectNear(now.corner, {5, 6, 5});
  expectNear(now.along, {-2, 0, 0});
  expectNear(now.up, {0, 0, 3});
}

}  // namespace
}  // namespace treacle
