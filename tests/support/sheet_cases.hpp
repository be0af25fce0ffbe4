#pragma once

#include "support/scene.hpp"

namespace treacle::test {

inline Body boxBody(const char* name, BodyKind kind, const Vec<3>& min, const Vec<3>& max) {
  Body body;
  body.name = name, body.kind = kind;
  body.shape.min = min, body.shape.max = max;
  return body;
}

/// A thin sheet along a line, in space from `bottom` to `top`.
inline Body sheetBody(const char* name, std::vector<Vec<2>> points, double bottom = 0, double top = 0) {
  Body body;
  body.name = name, body.kind = BodyKind::Wall;
  body.shape.kind = ShapeKind::Polyline;
  body.shape.points = std::move(points), body.shape.bottom = bottom, body.shape.top = top;
  return body;
}

/// Honey in an open tank of width (and depth) 1 with a spacing of 1/16 (in space 1/8), which a thin sheet in the
/// middle divides: `left` and `right` high.
inline Case dividedTank(int dimensions, double left, double right, MethodKind method = MethodKind::MphI) {
  const double l = dimensions == 2 ? 1.0 / 16 : 1.0 / 8, wall = 4 * l;
  Case c;
  c.dimensions = dimensions;
  c.spacing = l;
  c.method.kind = method;
  const int up = dimensions - 1;
  const bool space = dimensions == 3;
  c.gravity[up] = -10;
  Material honey{"honey", 1000, 100};
  if (method == MethodKind::MphI) honey.bulkViscosity = 1e5, honey.bulkModulus = 2e6;
  c.materials.push_back(honey);
  const Vec<3> corner{-wall, space ? -wall : 0, space ? -wall : 0};
  for (int k = 0; k < dimensions; ++k) c.domain.min[k] = -5 * l, c.domain.max[k] = 1 + 5 * l;
  const auto box = [&](double from, double to, double height) {
    Vec<3> min{from, 0, 0}, max{to, 1, 1};
    max[up] = height;
    return boxBody(from > 0 ? "right" : "left", BodyKind::Fluid, min, max);
  };
  c.bodies.push_back(box(0, 0.5, left));
  if (right > 0) c.bodies.push_back(box(0.5, 1, right));
  Vec<3> low = corner, high = Vec<3>::filled(1 + wall);
  low[up] = -wall, high[up] = 1;
  Body tank = boxBody("tank", BodyKind::Wall, low, high);
  tank.where = space ? "x < 0 || x > 1 || y < 0 || y > 1 || z < 0" : "x < 0 || x > 1 || y < 0";
  c.bodies.push_back(tank);
  // In space the line is a floor plan: the sheet goes through the walls at its ends, and through the floor.
  c.bodies.push_back(space ? sheetBody("sheet", {{0.5, -wall}, {0.5, 1 + wall}}, -wall, 1)
                           : sheetBody("sheet", {{0.5, -wall}, {0.5, 1}}));
  c.time.step = 2e-3;
  return c;
}

/// The same tank, full to 3/4, in which the sheet ends short of the walls, and turns.
inline Case paddleTank(int dimensions, MethodKind method = MethodKind::MphI) {
  Case c = dividedTank(dimensions, 0.75, 0.75, method);
  Body& sheet = c.bodies.back();
  sheet.shape.points = {{0.3, 0.375}, {0.7, 0.375}}, sheet.shape.bottom = 0.2, sheet.shape.top = 0.6;
  sheet.rotation = Rotation{{0.5, 0.375, 0}, {0, 0, 1}, 4};
  return c;
}

}  // namespace treacle::test
