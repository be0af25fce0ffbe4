#include "treacle/mph/mph_particles.hpp"

#include "mph/fill.cuh"

namespace treacle {

template <int D>
void elasticPressure(Context<Cuda>& context, const MphPairs<D>& pairs, std::span<const double> n,
                     std::span<const Adhesion<D>> adhesion, std::span<double> elastic) {
  fill(context, pairs, elastic, [n, adhesion] __device__(const MphPairs<D>& pairs, std::uint32_t i) {
    return elasticPressureOf(pairs, i, n[i], adhesion);
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
                                   std::span<const Adhesion<D>>, std::span<double>);                             \
  template void inertiaAndGravity<D>(Context<Cuda>&, const MphPairs<D>&, std::span<const Vec<D>>, const Vec<D>&, \
                                     std::span<Vec<D>>);                                                         \
  template void bulkPressure<D>(Context<Cuda>&, const MphPairs<D>&, std::span<const double>,                     \
                                std::span<const double>, std::span<double>);
TREACLE_INSTANTIATE(2)
TREACLE_INSTANTIATE(3)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
