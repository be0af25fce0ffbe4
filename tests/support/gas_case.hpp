#pragma once

#include "treacle/model/case/case.hpp"
#include "treacle/model/case/case_keys.hpp"

#include <string>

namespace treacle::test {

/// A plug of honey, 10 spacings wide and high, in a cup, 6 spacings above its floor; the air below it is trapped
/// and is under little pressure.
inline Case plugOnGas(int dimensions) {
  Case c;
  c.dimensions = dimensions;
  c.spacing = 2e-3;
  const int up = dimensions - 1;
  const double l = c.spacing, z = dimensions == 3 ? 1 : 0;
  c.method = defaultMethod(SchemeKind::Accurate);
  c.solver = defaultSolver(c.method.kind);
  c.domain = {{-5 * l, -5 * l, -5 * l * z}, {15 * l, 15 * l, 15 * l * z}, {}};
  c.domain.max[up] = 25 * l;
  c.gravity[up] = -9.81;
  c.gas.emplace().pressure = 3000;
  c.materials.resize(1);
  c.materials[0].name = "honey";
  c.materials[0].density = 1000;
  c.materials[0].dynamicViscosity = 10;
  c.materials[0].bulkViscosity = 1e4;
  c.materials[0].bulkModulus = 1e6;
  c.materials[0].slipLength = 1e3;
  Body plug;
  plug.name = "plug";
  plug.shape.max = {10 * l, 10 * l, 10 * l * z};
  plug.shape.min[up] = 6 * l, plug.shape.max[up] = 16 * l;
  Body cup;
  cup.name = "cup";
  cup.kind = BodyKind::Wall;
  cup.shape.min = {-4 * l, -4 * l, -4 * l * z};
  cup.shape.max = {14 * l, 14 * l, 14 * l * z};
  cup.shape.max[up] = 20 * l;
  cup.where = dimensions == 3 ? "x < 0 || x > 0.02 || y < 0 || y > 0.02 || z < 0" : "x < 0 || x > 0.02 || y < 0";
  c.bodies = {plug, cup};
  c.time.step = 1e-3;
  c.time.end = 0.2;
  return c;
}

/// A bell, open below and full of air, in a tank of honey: a rigid body that the air carries. Its walls are 4
/// spacings thick, inside it is 12 wide and 10 high.
inline Case bellInHoney(double mass) {
  Case c = plugOnGas(2);
  const double l = c.spacing;
  c.domain.max = {45 * l, 45 * l, 0};
  c.gas->pressure = 101325;
  c.materials[0].slipLength = 0, c.materials[0].dynamicViscosity = 3;
  Body &honey = c.bodies[0], &tank = c.bodies[1];
  honey.shape.min = {}, honey.shape.max = {40 * l, 24 * l, 0};
  honey.where = "x < 0.02 || x > 0.06 || y < 0.02";
  tank.shape.max = {44 * l, 40 * l, 0};
  tank.where = "x < 0 || x > 0.08 || y < 0";
  Body bell = tank;
  bell.name = "bell";
  bell.kind = BodyKind::Rigid;
  bell.shape.min = {10 * l, 10 * l, 0}, bell.shape.max = {30 * l, 24 * l, 0};
  bell.where = "x < 0.028 || x > 0.052 || y > 0.04";
  bell.rigid.mass = mass, bell.rigid.rotates = {false, false, false};
  c.bodies.push_back(bell);
  c.time.step = 2e-3;
  return c;
}

}  // namespace treacle::test
