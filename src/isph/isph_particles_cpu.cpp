#include "treacle/isph/isph_particles.hpp"

#include "treacle/core/parallel.hpp"

#include <algorithm>
#include <numeric>

namespace treacle {

void settlePressure(Context<Cpu>&, std::span<const std::uint8_t> surface, bool cut, std::span<double> p) {
  parallelFor(p.size(), parallelGrain, [&](std::size_t i) { p[i] = settledPressure(surface[i], cut, p[i]); });
}

bool isClosed(Context<Cpu>&, std::span<const std::uint8_t> surface) {
  return std::find(surface.begin(), surface.end(), 1) == surface.end();
}

void takeLevel(Context<Cpu>&, Level level, std::span<double> x) {
  if (x.empty()) return;
  const double zero = level == Level::Least
                          ? *std::min_element(x.begin(), x.end())
                          : std::accumulate(x.begin(), x.end(), 0.0) / static_cast<double>(x.size());
  parallelFor(x.size(), parallelGrain, [&](std::size_t i) { x[i] -= zero; });
}

template <int D>
void shiftedVelocity(Context<Cpu>&, const Shifting& shifting, std::span<const Vec<D>> deficit,
                     std::span<const std::uint8_t> surface, std::span<const Vec<D>> velocity,
                     std::span<Vec<D>> transport) {
  parallelFor(transport.size(), parallelGrain, [&](std::size_t i) {
    transport[i] = shiftedVelocity(shifting, deficit[i], surface[i] != 0, velocity[i]);
  });
}

template <int D>
void takeComponent(Context<Cpu>&, std::span<const Vec<D>> v, int k, std::span<double> x) {
  parallelFor(x.size(), parallelGrain, [&](std::size_t i) { x[i] = v[i][k]; });
}

template <int D>
void putComponent(Context<Cpu>&, std::span<const double> x, int k, std::span<Vec<D>> v) {
  parallelFor(x.size(), parallelGrain, [&](std::size_t i) { v[i][k] = x[i]; });
}

#define TREACLE_INSTANTIATE(D)                                                                                 \
  template void shiftedVelocity<D>(Context<Cpu>&, const Shifting&, std::span<const Vec<D>>,                    \
                                   std::span<const std::uint8_t>, std::span<const Vec<D>>, std::span<Vec<D>>); \
  template void takeComponent<D>(Context<Cpu>&, std::span<const Vec<D>>, int, std::span<double>);              \
  template void putComponent<D>(Context<Cpu>&, std::span<const double>, int, std::span<Vec<D>>);
TREACLE_INSTANTIATE(2)
TREACLE_INSTANTIATE(3)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
