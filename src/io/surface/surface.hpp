#pragma once

#include "treacle/core/vec.hpp"

#include <vector>

namespace treacle {

/// How a particle lies in the body that all particles form.
struct SurfacePoint {
  Vec<3> normal{};         // where the body ends: unit vector near a surface, zero inside
  bool outermost = false;  // in the first layer of particles
};

/// For shading. `spacing` [m]; positions finite.
std::vector<SurfacePoint> surfacePoints(const std::vector<Vec<3>>& position, double spacing);

}  // namespace treacle
