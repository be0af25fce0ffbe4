#include "treacle/mph/wall_surfaces.hpp"

#include "core/launch.hpp"

namespace treacle {

/// One thread per wall particle; reads its body and that one's motion, and its surface; writes that. No atomics.
template <int D>
void placeSurfaces(Context<Cuda>& context, const KnownSurfaces<D>& known, std::span<const std::uint8_t> body,
                   std::span<WallSurface<D>> placed) {
  forEach(context, placed.size(),
          [known, body, placed] __device__(std::size_t k) { placed[k] = placedSurface(known, k, body[k]); });
}

#define TREACLE_INSTANTIATE(D)                                                                           \
  template void placeSurfaces<D>(Context<Cuda>&, const KnownSurfaces<D>&, std::span<const std::uint8_t>, \
                                 std::span<WallSurface<D>>);
TREACLE_INSTANTIATE(2)
TREACLE_INSTANTIATE(3)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
