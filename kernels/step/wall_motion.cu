#include "treacle/step/walls/wall_motion.hpp"

#include "core/launch.hpp"

namespace treacle {

/// One thread per wall particle; reads its body, place and motion, writes its velocity. No atomics.
template <int D>
void setWallVelocities(Context<Cuda>& context, const MovingWalls<D>& walls, std::span<Vec<D>> velocity) {
  forEach(context, velocity.size(), [walls, velocity] __device__(std::size_t k) {
    velocity[k] = walls.motion[walls.body[k]].velocityAt(walls.position[k]);
  });
}

/// One thread per wall particle; reads its body, place and motion, writes its chord. No atomics.
template <int D>
void setWallChords(Context<Cuda>& context, const MovingWalls<D>& walls, std::span<Vec<D>> chord) {
  forEach(context, chord.size(), [walls, chord] __device__(std::size_t k) {
    chord[k] = walls.motion[walls.body[k]].chordAt(walls.position[k]);
  });
}

/// One thread per wall particle; reads its body, moves its place. No atomics.
template <int D>
void shiftBody(Context<Cuda>& context, const CellGrid<D>& grid, std::span<const std::uint8_t> body,
               std::uint8_t which, const Vec<D>& by, std::span<Vec<D>> position) {
  forEach(context, position.size(), [grid, body, which, by, position] __device__(std::size_t k) {
    if (body[k] != which) return;
    Vec<D> moved = position[k] + by;
    grid.wrap(moved);
    position[k] = moved;
  });
}

#define TREACLE_INSTANTIATE(D)                                                                                \
  template void setWallVelocities<D>(Context<Cuda>&, const MovingWalls<D>&, std::span<Vec<D>>);               \
  template void setWallChords<D>(Context<Cuda>&, const MovingWalls<D>&, std::span<Vec<D>>);                   \
  template void shiftBody<D>(Context<Cuda>&, const CellGrid<D>&, std::span<const std::uint8_t>, std::uint8_t, \
                             const Vec<D>&, std::span<Vec<D>>);
TREACLE_INSTANTIATE(2)
TREACLE_INSTANTIATE(3)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
