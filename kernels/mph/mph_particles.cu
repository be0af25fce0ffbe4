#include "treacle/mph/mph_particles.hpp"

#include "core/launch.hpp"

namespace treacle {
namespace {

/// One thread per element: to[i] = formula(pairs, i). The pairs are too large for a copy in every thread. No
/// atomics.
template <int D, class T, class Formula>
__global__ void fillKernel(const __grid_constant__ MphPairs<D> pairs, std::span<T> to, const Formula formula) {
  const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
  if (i < to.size()) to[i] = formula(pairs, i);
}
template <int D, class T, class Formula>
void fill(const Context<Cuda>& context, const MphPairs<D>& pairs, std::span<T> to, const Formula& formula) {
  launch(context, blocksFor(to.size(), 256), 256, 0, fillKernel<D, T, Formula>, pairs, to, formula);
}

}  // namespace

template <int D>
void elasticPressure(Context<Cuda>& context, const MphPairs<D>& pairs, std::span<const double> n,
                     std::span<const Adhesion<D>> adhesion, std::span<double> elastic,
                     std::span<const double> held) {
  fill(context, pairs, elastic, [n, adhesion, held] __device__(const MphPairs<D>& pairs, std::uint32_t i) {
    return elasticPressureOf(pairs, i, n[i], adhesion, held);
  });
}

template <int D>
void holdPressures(Context<Cuda>& context, const MphPairs<D>& pairs, double dt, const Surroundings& around,
                   std::span<const double> divergence, std::span<double> held) {
  fill(context, pairs, held, [dt, around, divergence, held] __device__(const MphPairs<D>& pairs, std::uint32_t i) {
    return heldPressureOf(pairs, i, dt, around, divergence[i], held[i]);
  });
}

template <int D>
void spreadVelocities(Context<Cuda>& context, const MphPairs<D>& pairs, double dt, const Surroundings& around,
                      std::span<const Vec<D>> u, std::span<Vec<D>> crowding) {
  fill(context, pairs, crowding, [dt, around, u, crowding] __device__(const MphPairs<D>& pairs, std::uint32_t i) {
    return spreadVelocityOf(pairs, i, dt, around, u[i], crowding[i]);
  });
}

template <int D>
void inertiaAndGravity(Context<Cuda>& context, const MphPairs<D>& pairs, std::span<const Vec<D>> u,
                       const Vec<D>& gravity, std::span<Vec<D>> b) {
  fill(context, pairs, b, [u, gravity] __device__(const MphPairs<D>& pairs, std::uint32_t i) {
    return inertiaAndGravityOf(pairs, i, u[i], gravity);
  });
}

template <int D>
void bulkPressure(Context<Cuda>& context, const MphPairs<D>& pairs, std::span<const double> div,
                  std::span<const double> elastic, std::span<double> pressure) {
  fill(context, pairs, pressure, [div, elastic] __device__(const MphPairs<D>& pairs, std::uint32_t i) {
    return bulkPressureOf(pairs, i, div[i], elastic.empty() ? 0.0 : elastic[i]);
  });
}

#define TREACLE_INSTANTIATE(D)                                                                                   \
  template void elasticPressure<D>(Context<Cuda>&, const MphPairs<D>&, std::span<const double>,                  \
                                   std::span<const Adhesion<D>>, std::span<double>, std::span<const double>);    \
  template void holdPressures<D>(Context<Cuda>&, const MphPairs<D>&, double, const Surroundings&,                \
                                 std::span<const double>, std::span<double>);                                    \
  template void spreadVelocities<D>(Context<Cuda>&, const MphPairs<D>&, double, const Surroundings&,             \
                                    std::span<const Vec<D>>, std::span<Vec<D>>);                                 \
  template void inertiaAndGravity<D>(Context<Cuda>&, const MphPairs<D>&, std::span<const Vec<D>>, const Vec<D>&, \
                                     std::span<Vec<D>>);                                                         \
  template void bulkPressure<D>(Context<Cuda>&, const MphPairs<D>&, std::span<const double>,                     \
                                std::span<const double>, std::span<double>);
TREACLE_INSTANTIATE(2)
TREACLE_INSTANTIATE(3)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
