#pragma once

#include "treacle/core/vec.hpp"

namespace treacle {

/// Where a wall particle sees the surface of the walls that it belongs to: the vectors from it to the nearest
/// points of up to two faces [m], the nearest first, as the walls are at the start of a run. Zero: there is none
/// within reach. Their directions are the outward normals there; two faces have normals that differ by 60 degrees
/// or more: those of an edge that fluid can go round, or of a plate with fluid on both sides.
template <int D>
struct WallSurface {
  Vec<D, float> face[2];

  bool operator==(const WallSurface&) const = default;
};

}  // namespace treacle
