#include "treacle/core/parallel.hpp"
#include "treacle/mph/mph_particles.hpp"

namespace treacle {
namespace {

/// to[i] = formula(i)
template <class T, class F>
void fill(std::span<T> to, F&& formula) {
  parallelFor(to.size(), parallelGrain, [&](std::size_t i) { to[i] = formula(static_cast<std::uint32_t>(i)); });
}

}  // namespace

template <int D>
void elasticPressure(Context<Cpu>&, const MphPairs<D>& pairs, std::span<const double> n,
                     std::span<const Adhesion<D>> adhesion, std::span<double> elastic) {
  fill(elastic, [&](std::uint32_t i) { return elasticPressureOf(pairs, i, n[i], adhesion); });
}

template <int D>
void inertiaAndGravity(Context<Cpu>&, const MphPairs<D>& pairs, std::span<const Vec<D>> u, const Vec<D>& gravity,
                       std::span<Vec<D>> b) {
  fill(b, [&](std::uint32_t i) { return inertiaAndGravityOf(pairs, i, u[i], gravity); });
}

template <int D>
void bulkPressure(Context<Cpu>&, const MphPairs<D>& pairs, std::span<const double> div,
                  std::span<const double> elastic, std::span<double> pressure) {
  fill(pressure,
       [&](std::uint32_t i) { return bulkPressureOf(pairs, i, div[i], elastic.empty() ? 0.0 : elastic[i]); });
}

#define TREACLE_INSTANTIATE(D)                                                                                  \
  template void elasticPressure<D>(Context<Cpu>&, const MphPairs<D>&, std::span<const double>,                  \
                                   std::span<const Adhesion<D>>, std::span<double>);                            \
  template void inertiaAndGravity<D>(Context<Cpu>&, const MphPairs<D>&, std::span<const Vec<D>>, const Vec<D>&, \
                                     std::span<Vec<D>>);                                                        \
  template void bulkPressure<D>(Context<Cpu>&, const MphPairs<D>&, std::span<const double>,                     \
                                std::span<const double>, std::span<double>);
TREACLE_INSTANTIATE(2)
TREACLE_INSTANTIATE(3)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
