#pragma once

#include "support/scene.hpp"
#include "treacle/model/particles/create.hpp"

#include <cmath>
#include <string>
#include <vector>

namespace treacle::test {

/// A layer of fluid with a wavy surface, one period long, where the order of the cells jumps within a cluster:
/// some of its particles are exactly half a period from its first one, and its box is as long as the period, so
/// that particles are in its list at two images.
inline Case tornClusterCase() {
  Case c = sceneCase(2, false);
  c.domain = {{0, -0.005, 0}, {0.064, 0.024, 0}, {true, false, false}};
  c.gravity[1] = -10;
  c.materials.resize(1);
  c.bodies.resize(2);
  c.bodies[0].name = "layer";
  c.bodies[0].shape.max = {0.064, 0.018, 0};
  c.bodies[0].where = "y < 0.016 + 0.001*cos(2*pi*x/0.064)";
  c.bodies[1].name = "floor";
  c.bodies[1].kind = BodyKind::Wall;
  c.bodies[1].shape.min = {0, -0.004, 0};
  c.bodies[1].shape.max = {0.064, 0, 0};
  return c;
}

inline Particles<2> tornClusterParticles(const Case& c) {
  std::vector<std::string> notes;
  return createParticles<2>(c, notes);
}

/// Fluid particles that are half a period from their cluster's first one.
inline int countTorn(const MphPairs<2>& pairs) {
  int torn = 0;
  for (std::uint32_t i = 0; i < pairs.fluidCount; ++i) {
    const double away = pairs.position[i][0] - pairs.position[i - i % clusterSize][0];
    torn += std::abs(std::abs(away) / pairs.grid.length[0] - 0.5) < 1e-12;
  }
  return torn;
}

}  // namespace treacle::test
