#include "treacle/isph/isph_particles.hpp"

#include "core/launch.hpp"

namespace treacle {

/// In this file one thread per fluid particle; no atomics.

void settlePressure(Context<Cuda>& context, std::span<const std::uint8_t> surface, bool cut, std::span<double> p) {
  forEach(context, p.size(),
          [surface, cut, p] __device__(std::size_t i) { p[i] = settledPressure(surface[i], cut, p[i]); });
}

template <int D>
void shiftedVelocity(Context<Cuda>& context, const Shifting& shifting, std::span<const Vec<D>> deficit,
                     std::span<const std::uint8_t> surface, std::span<const Vec<D>> velocity,
                     std::span<Vec<D>> transport) {
  forEach(context, transport.size(), [shifting, deficit, surface, velocity, transport] __device__(std::size_t i) {
    transport[i] = shiftedVelocity(shifting, deficit[i], surface[i] != 0, velocity[i]);
  });
}

template <int D>
void takeComponent(Context<Cuda>& context, std::span<const Vec<D>> v, int k, std::span<double> x) {
  forEach(context, x.size(), [v, k, x] __device__(std::size_t i) { x[i] = v[i][k]; });
}

template <int D>
void putComponent(Context<Cuda>& context, std::span<const double> x, int k, std::span<Vec<D>> v) {
  forEach(context, x.size(), [v, k, x] __device__(std::size_t i) { v[i][k] = x[i]; });
}

#define TREACLE_INSTANTIATE(D)                                                                                 \
  template void shiftedVelocity<D>(Context<Cuda>&, const Shifting&, std::span<const Vec<D>>,                   \
                                   std::span<const std::uint8_t>, std::span<const Vec<D>>, std::span<Vec<D>>); \
  template void takeComponent<D>(Context<Cuda>&, std::span<const Vec<D>>, int, std::span<double>);             \
  template void putComponent<D>(Context<Cuda>&, std::span<const double>, int, std::span<Vec<D>>);
TREACLE_INSTANTIATE(2)
TREACLE_INSTANTIATE(3)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
