#pragma once

#include "support/isph_scene.hpp"
#include "treacle/model/motion/wall_motion.hpp"

#include <vector>

namespace treacle::test {

/// Motions of walls that accelerate, and rotate about points of the domain.
template <int D>
std::vector<WallMotion<D>> randomMotions(const Domain& domain, std::size_t count) {
  const std::vector<Vec<D>> u = randomVelocities<D>(count, 1), a = randomVelocities<D>(count, 5),
                            c = randomVelocities<D>(count, 6);
  const std::vector<Vec<3>> axis = randomVelocities<3>(count, 7);
  std::vector<WallMotion<D>> motions;
  for (std::size_t b = 0; b < count; ++b) {
    Body body;
    body.kind = BodyKind::Wall;
    body.velocity = resized<3>(u[b]);
    body.rotation = Rotation{0.5 * (domain.min + domain.max) + 0.1 * resized<3>(c[b]),
                             D == 2 ? Vec<3>{0, 0, 1} : axis[b], 3.0 * static_cast<double>(b) - 2};
    motions.push_back(wallMotion<D>(domain, body, 0, 0.05));
    motions.back().acceleration = a[b];
  }
  return motions;
}

}  // namespace treacle::test
