#include "treacle/model/geometry/wall_sight.hpp"

#include "treacle/model/geometry/shape.hpp"

#include <fmt/format.h>

#include <cstddef>

namespace treacle {

template <int D>
std::vector<WallSight> wallSight(const Case& c, std::span<const std::uint8_t> body,
                                 std::span<const WallSurface<D>> surfaces) {
  std::vector<WallSight> sight(c.bodies.size());
  for (std::size_t k = 0; k < surfaces.size(); ++k) {
    ++sight[body[k]].particles;
    if (surfaces[k] != WallSurface<D>{}) ++sight[body[k]].seeing;
  }
  return sight;
}

void noteBlindWalls(const Case& c, std::span<const WallSight> sight, std::vector<std::string>& notes) {
  for (std::size_t b = 0; b < c.bodies.size(); ++b) {
    const Body& wall = c.bodies[b];
    if (!wall.isWall() || sight[b].particles == 0 || sight[b].seeing > 0) continue;
    notes.push_back(
        wall.shape.kind == ShapeKind::Particles
            ? fmt::format(
                  "wall '{}' is made of the particles of a file, whose surface is not known: fluid next to it "
                  "meets the velocity of each particle, and slips",
                  wall.name)
            : fmt::format(
                  "wall '{}': none of its {} particles has a surface of the walls within the viscosity radius "
                  "h_v = {}; no fluid can be next to it",
                  wall.name, sight[b].particles, lengthText(c.viscosityRadius())));
  }
}

template std::vector<WallSight> wallSight<2>(const Case&, std::span<const std::uint8_t>,
                                             std::span<const WallSurface<2>>);
template std::vector<WallSight> wallSight<3>(const Case&, std::span<const std::uint8_t>,
                                             std::span<const WallSurface<3>>);

}  // namespace treacle
