#include "treacle/mph/wall_surfaces.hpp"

#include "treacle/core/parallel.hpp"

namespace treacle {

template <int D>
void placeSurfaces(Context<Cpu>&, const KnownSurfaces<D>& known, std::span<const std::uint8_t> body,
                   std::span<WallSurface<D>> placed) {
  parallelFor(placed.size(), parallelGrain, [&](std::size_t k) { placed[k] = placedSurface(known, k, body[k]); });
}

#define TREACLE_INSTANTIATE(D)                                                                          \
  template void placeSurfaces<D>(Context<Cpu>&, const KnownSurfaces<D>&, std::span<const std::uint8_t>, \
                                 std::span<WallSurface<D>>);
TREACLE_INSTANTIATE(2)
TREACLE_INSTANTIATE(3)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
