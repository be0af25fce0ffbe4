#include "treacle/step/wall_motion.hpp"

#include "core/launch.hpp"

namespace treacle {

/// One thread per wall particle; reads its body, writes its velocity. No atomics.
template <int D>
void setWallVelocities(Context<Cuda>& context, std::span<const std::uint8_t> body,
                       std::span<const Vec<D>> bodyVelocity, std::span<Vec<D>> velocity) {
  forEach(context, velocity.size(),
          [body, bodyVelocity, velocity] __device__(std::size_t k) { velocity[k] = bodyVelocity[body[k]]; });
}

template void setWallVelocities<2>(Context<Cuda>&, std::span<const std::uint8_t>, std::span<const Vec<2>>,
                                   std::span<Vec<2>>);
template void setWallVelocities<3>(Context<Cuda>&, std::span<const std::uint8_t>, std::span<const Vec<3>>,
                                   std::span<Vec<3>>);

}  // namespace treacle
