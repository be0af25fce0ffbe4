#include "treacle/step/wall_motion.hpp"

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

#define TREACLE_INSTANTIATE(D)                                                                  \
  template void setWallVelocities<D>(Context<Cuda>&, const MovingWalls<D>&, std::span<Vec<D>>); \
  template void setWallChords<D>(Context<Cuda>&, const MovingWalls<D>&, std::span<Vec<D>>);
TREACLE_INSTANTIATE(2)
TREACLE_INSTANTIATE(3)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
