#include "treacle/isph/isph_particles.hpp"

#include "treacle/core/parallel.hpp"
#include "treacle/core/processes.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <numeric>

namespace treacle {

void settlePressure(Context<Cpu>&, std::span<const std::uint8_t> surface, bool cut, std::span<double> p) {
  parallelFor(p.size(), parallelGrain, [&](std::size_t i) { p[i] = settledPressure(surface[i], cut, p[i]); });
}

bool isClosed(Context<Cpu>& context, std::span<const std::uint8_t> surface) {
  return joinedOverProcesses(context, std::count(surface.begin(), surface.end(), 1), std::plus<>()) == 0;
}

void takeLevel(Context<Cpu>& context, Level level, std::span<double> x) {
  double zero;
  if (level == Level::Least) {
    double least = std::numeric_limits<double>::infinity();
    for (const double value : x) least = std::min(least, value);
    zero = joinedOverProcesses(context, least, [](double a, double b) { return std::min(a, b); });
  } else {
    const double sum = sumOverProcesses(context, std::accumulate(x.begin(), x.end(), 0.0));
    zero = sum / static_cast<double>(joinedOverProcesses(context, x.size(), std::plus<>()));
  }
  parallelFor(x.size(), parallelGrain, [&](std::size_t i) { x[i] -= zero; });
}

template <int D>
void shiftedVelocity(Context<Cpu>&, const Shifting& shifting, std::span<const Vec<D>> deficit,
                     std::span<const std::uint8_t> surface, std::span<const Vec<D>> velocity,
                     std::span<Vec<D>> transport) {
  parallelFor(transport.size(), parallelGrain, [&](std::size_t i) {
    transport[i] = surface[i] ? velocity[i] : shiftedVelocity(shifting, deficit[i], velocity[i]);
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
