#pragma once

#include "ring_in_drum.hpp"

namespace treacle::test {

/// A layer of honey on a floor, periodic to the sides, with a gap of half a spacing in its middle, or under it.
inline Case layerWithGap(bool onTheFloor = false) {
  Case c = ringInDrum();
  c.domain.min = {0, -0.004, 0}, c.domain.max = {0.02, 0.03, 0};
  c.domain.periodic = {true, false, false};
  c.gravity = {0, -9.81, 0};
  c.bodies.resize(1);
  Body& lower = c.bodies[0];
  lower.shape = {};
  lower.shape.min = {0, 0, 0}, lower.shape.max = {0.02, 0.008, 0};
  Body upper = lower, floor = lower;
  if (onTheFloor) lower.shape.min[1] += 0.0005, lower.shape.max[1] += 0.0005;
  upper.name = "upper";
  upper.shape.min[1] = 0.0085, upper.shape.max[1] = 0.0165;
  floor.name = "floor", floor.kind = BodyKind::Wall;
  floor.shape.min[1] = -0.004, floor.shape.max[1] = 0;
  c.bodies.push_back(upper);
  c.bodies.push_back(floor);
  return c;
}

}  // namespace treacle::test
