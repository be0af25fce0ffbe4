#pragma once

#include "treacle/model/case/case.hpp"

namespace treacle::test {

/// A layer of fluid on a floor, periodic to the sides, 12 spacings high, whose weight pushes a particle at its
/// foot by 1.7 spacings in a step of 20 ms (StiffnessTerms).
inline Case deepLayer(int dimensions) {
  constexpr double l = 2e-3;
  const bool is3D = dimensions == 3;
  const auto box = [&](double from, double to) {
    Shape s;
    s.min[dimensions - 1] = from, s.max[dimensions - 1] = to;
    s.max[0] = 10 * l;
    if (is3D) s.max[1] = 10 * l;
    return s;
  };
  Case c;
  c.dimensions = dimensions;
  c.spacing = l;
  c.domain.max = {10 * l, is3D ? 10 * l : 20 * l, is3D ? 20 * l : 0};
  c.domain.min[dimensions - 1] = -4 * l;
  c.domain.periodic = {true, is3D, false};
  c.gravity[dimensions - 1] = -9.81;
  c.materials = {
      {.name = "syrup", .density = 1000, .dynamicViscosity = 1, .bulkViscosity = 4e3, .bulkModulus = 2e4}};
  c.time = {0.02, 2};
  c.bodies.resize(2);
  c.bodies[0].name = "layer";
  c.bodies[0].shape = box(0, 12 * l);
  c.bodies[1].name = "floor", c.bodies[1].kind = BodyKind::Wall;
  c.bodies[1].shape = box(-4 * l, 0);
  return c;
}

/// The same with a lid on it.
inline Case fullVessel(int dimensions) {
  Case c = deepLayer(dimensions);
  Body lid = c.bodies[1];
  lid.name = "lid";
  lid.shape.min[dimensions - 1] = 12 * c.spacing, lid.shape.max[dimensions - 1] = 16 * c.spacing;
  c.bodies.push_back(lid);
  return c;
}

/// The same whose lower third is a fluid of the weight and viscosity of air.
inline Case layerOnAir(int dimensions) {
  Case c = deepLayer(dimensions);
  c.time.step = 2e-3;
  c.materials.push_back(
      {.name = "air", .density = 1, .dynamicViscosity = 1e-3, .bulkViscosity = 4e3, .bulkModulus = 2e4});
  Body air = c.bodies[0];
  air.name = "air", air.material = 1;
  c.bodies[0].shape.min[dimensions - 1] = air.shape.max[dimensions - 1] = 4 * c.spacing;
  c.bodies.push_back(air);
  return c;
}

}  // namespace treacle::test
