#include "treacle/isph/isph_particles.hpp"

#include "core/launch.hpp"
#include "core/reduce.cuh"
#include "treacle/core/processes.hpp"

#include <cub/device/device_reduce.cuh>

#include <algorithm>
#include <functional>
#include <limits>

namespace treacle {
namespace {

/// Where a result of a reduction stands until the next one: behind the partial sums of blocks.
double* resultOf(Context<Cuda>& context) { return context.partialSums() + Context<Cuda>::maxPartialSums - 1; }

/// The sum over all processes, for which the host waits.
template <class Body>
double sumOf(Context<Cuda>& context, std::size_t count, Body body) {
  double* result = resultOf(context);
  reduce(context, count, body, [result] __device__(double sum) { *result = sum; });
  return valueOnHost(context, result);
}

double meanOf(Context<Cuda>& context, std::span<const double> x) {
  const double sum = sumOf(context, x.size(), [x] __device__(std::size_t i) { return x[i]; });
  return sum / static_cast<double>(joinedOverProcesses(context, x.size(), std::plus<>()));
}

double leastOf(Context<Cuda>& context, std::span<const double> x) {
  double least = std::numeric_limits<double>::infinity();
  if (!x.empty()) {
    double* result = resultOf(context);
    std::size_t bytes = 0;
    TREACLE_CUDA_CHECK(cub::DeviceReduce::Min(nullptr, bytes, x.data(), result, x.size(), context.stream()));
    TREACLE_CUDA_CHECK(
        cub::DeviceReduce::Min(context.scratch(bytes), bytes, x.data(), result, x.size(), context.stream()));
    least = valueOnHost(context, result);
  }
  return joinedOverProcesses(context, least, [](double a, double b) { return std::min(a, b); });
}

}  // namespace

/// In this file one thread per fluid particle; no atomics but those of sums (reduce.cuh).

void settlePressure(Context<Cuda>& context, std::span<const std::uint8_t> surface, bool cut, std::span<double> p) {
  forEach(context, p.size(),
          [surface, cut, p] __device__(std::size_t i) { p[i] = settledPressure(surface[i], cut, p[i]); });
}

bool isClosed(Context<Cuda>& context, std::span<const std::uint8_t> surface) {
  return sumOf(context, surface.size(), [surface] __device__(std::size_t i) { return double(surface[i]); }) == 0;
}

void takeLevel(Context<Cuda>& context, Level level, std::span<double> x) {
  const double zero = level == Level::Least ? leastOf(context, x) : meanOf(context, x);
  forEach(context, x.size(), [x, zero] __device__(std::size_t i) { x[i] -= zero; });
}

template <int D>
void shiftedVelocity(Context<Cuda>& context, const Shifting& shifting, std::span<const Vec<D>> deficit,
                     std::span<const std::uint8_t> surface, std::span<const Vec<D>> velocity,
                     std::span<Vec<D>> transport) {
  forEach(context, transport.size(), [shifting, deficit, surface, velocity, transport] __device__(std::size_t i) {
    transport[i] = surface[i] ? velocity[i] : shiftedVelocity(shifting, deficit[i], velocity[i]);
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
