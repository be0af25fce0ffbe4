#pragma once

#include "treacle/model/case/case.hpp"
#include "treacle/model/geometry/wall_surface.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace treacle {

/// How many particles a wall has, and how many of these see a surface.
struct WallSight {
  std::uint64_t particles = 0, seeing = 0;
};

/// Per body of the case, of wall particles that belong to `body[k]`.
template <int D>
std::vector<WallSight> wallSight(const Case& c, std::span<const std::uint8_t> body,
                                 std::span<const WallSurface<D>> surfaces);

/// Appends which walls have particles, but none that sees a surface. `sight`: per body, of all particles.
void noteBlindWalls(const Case& c, std::span<const WallSight> sight, std::vector<std::string>& notes);

}  // namespace treacle
