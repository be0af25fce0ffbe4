#include "treacle/model/materials/pressed_particle.hpp"

#include <algorithm>

namespace treacle {

StiffnessLimits StiffnessLimits::of(double pressureRadius) {
  constexpr double radii[] = {2.5, 3, 3.5}, ways[] = {0.4, 1.2, 4};
  const double radius = std::clamp(pressureRadius, radii[0], radii[2]);
  const int k = radius < radii[1] ? 0 : 1;
  const double most = ways[k] + (ways[k + 1] - ways[k]) * (radius - radii[k]) / (radii[k + 1] - radii[k]);
  return {most, 0.375 * most};
}

}  // namespace treacle
