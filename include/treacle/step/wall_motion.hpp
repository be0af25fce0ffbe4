#pragma once

#include "treacle/core/cuda.hpp"
#include "treacle/model/wall_motion.hpp"

#include <cstdint>
#include <span>

namespace treacle {

/// Wall particles and what moves them; spans in the backend's memory.
template <int D>
struct MovingWalls {
  std::span<const WallMotion<D>> motion;  // per body of the case
  std::span<const std::uint8_t> body;     // per wall particle, less than the number of bodies
  std::span<const Vec<D>> position;       // likewise [m]
};

/// The velocities of the rigid motions where the particles are, per wall particle [m/s].
template <int D>
void setWallVelocities(Context<Cpu>&, const MovingWalls<D>& walls, std::span<Vec<D>> velocity);
template <int D>
void setWallVelocities(Context<Cuda>&, const MovingWalls<D>& walls, std::span<Vec<D>> velocity);

/// Their ways in the step over dt, likewise.
template <int D>
void setWallChords(Context<Cpu>&, const MovingWalls<D>& walls, std::span<Vec<D>> chord);
template <int D>
void setWallChords(Context<Cuda>&, const MovingWalls<D>& walls, std::span<Vec<D>> chord);

}  // namespace treacle
