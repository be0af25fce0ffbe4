#pragma once

#include "treacle/core/cuda.hpp"
#include "treacle/model/motion/nozzle_columns.hpp"
#include "treacle/model/motion/wall_motion.hpp"
#include "treacle/search/cell_grid.hpp"

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
template <int D, class Backend>
void setWallVelocities(Context<Backend>&, const MovingWalls<D>& walls, std::span<Vec<D>> velocity);

/// Their ways in the step over dt, likewise.
template <int D, class Backend>
void setWallChords(Context<Backend>&, const MovingWalls<D>& walls, std::span<Vec<D>> chord);

/// Adds to a vector of the wall particles of a nozzle what their columns have. All spans: per wall particle.
template <int D, class Backend>
void addToColumns(Context<Backend>&, const NozzleColumns<D>& columns, std::span<const std::uint8_t> body,
                  std::span<const Vec<D>> position, std::span<Vec<D>> vector);

/// Moves them by it [m].
template <int D, class Backend>
void shiftColumns(Context<Backend>&, const CellGrid<D>& grid, const NozzleColumns<D>& columns,
                  std::span<const std::uint8_t> body, std::span<Vec<D>> position);

}  // namespace treacle
