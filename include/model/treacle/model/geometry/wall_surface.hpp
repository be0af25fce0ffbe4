#pragma once

#include "treacle/core/vec.hpp"
#include "treacle/model/case/case.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace treacle {

/// Where a wall particle sees the surface of the walls that it belongs to: the vectors from it to the nearest
/// points of up to two faces [m], the nearest first, as the walls are at the start of a run. Zero: there is none
/// within reach. Their directions are the outward normals there, in a concave corner one between those of its
/// sides; those of two faces differ by 60 degrees or more: they are the faces of an edge that fluid can go round,
/// or of a plate with fluid on both sides.
template <int D>
struct WallSurface {
  Vec<D, float> face[2];

  bool operator==(const WallSurface&) const = default;
};

/// The surfaces next to wall particles, within the viscosity radius: particle k is at `position[k]` [m], where
/// createParticles put it, and belongs to the wall `body[k]` of the case. Walls that move in the same way are one
/// solid: where they touch or overlap, there is no surface. Appends to `notes` which walls have particles, but
/// none that sees a surface.
template <int D>
std::vector<WallSurface<D>> createWallSurfaces(const Case& c, std::span<const Vec<D>> position,
                                               std::span<const std::uint8_t> body,
                                               std::vector<std::string>& notes);

extern template std::vector<WallSurface<2>> createWallSurfaces<2>(const Case&, std::span<const Vec<2>>,
                                                                  std::span<const std::uint8_t>,
                                                                  std::vector<std::string>&);
extern template std::vector<WallSurface<3>> createWallSurfaces<3>(const Case&, std::span<const Vec<3>>,
                                                                  std::span<const std::uint8_t>,
                                                                  std::vector<std::string>&);

}  // namespace treacle
