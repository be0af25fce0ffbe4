#include "treacle/core/parallel.hpp"
#include "treacle/step/walls/wall_motion.hpp"

namespace treacle {

template <int D>
void setWallVelocities(Context<Cpu>&, const MovingWalls<D>& walls, std::span<Vec<D>> velocity) {
  parallelFor(velocity.size(), parallelGrain,
              [&](std::size_t k) { velocity[k] = walls.motion[walls.body[k]].velocityAt(walls.position[k]); });
}

template <int D>
void setWallChords(Context<Cpu>&, const MovingWalls<D>& walls, std::span<Vec<D>> chord) {
  parallelFor(chord.size(), parallelGrain,
              [&](std::size_t k) { chord[k] = walls.motion[walls.body[k]].chordAt(walls.position[k]); });
}

template <int D>
void shiftBody(Context<Cpu>&, const CellGrid<D>& grid, std::span<const std::uint8_t> body, std::uint8_t which,
               const Vec<D>& by, std::span<Vec<D>> position) {
  parallelFor(position.size(), parallelGrain, [&](std::size_t k) {
    if (body[k] != which) return;
    position[k] = position[k] + by;
    grid.wrap(position[k]);
  });
}

#define TREACLE_INSTANTIATE(D)                                                                               \
  template void setWallVelocities<D>(Context<Cpu>&, const MovingWalls<D>&, std::span<Vec<D>>);               \
  template void setWallChords<D>(Context<Cpu>&, const MovingWalls<D>&, std::span<Vec<D>>);                   \
  template void shiftBody<D>(Context<Cpu>&, const CellGrid<D>&, std::span<const std::uint8_t>, std::uint8_t, \
                             const Vec<D>&, std::span<Vec<D>>);
TREACLE_INSTANTIATE(2)
TREACLE_INSTANTIATE(3)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
