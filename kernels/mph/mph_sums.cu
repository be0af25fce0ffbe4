#include "mph/step_sums.cuh"
#include "treacle/mph/density_sums.hpp"
#include "treacle/mph/slip_sums.hpp"

namespace treacle {
template <int D, class Backend>
void addPressureGradient(Context<Backend>& context, const MphPairs<D>& pairs, std::span<const double> q,
                         double factor, std::span<Vec<D>> y) {
  withStepTerms(pairs, [&]<class Mph, class Corrected>(const Mph& mph, Corrected) {
    sumOnFluid(context, pairs,
               PressureForce<D, double, Mph, Corrected::value, true>{mph, q.data(), y.data(), factor});
  });
  subtractGradientAlongWalls(context, pairs, q, factor, y);
}

template <int D, class Backend>
void divergence(Context<Backend>& context, const MphPairs<D>& pairs, std::span<const Vec<D>> u,
                std::span<double> div) {
  withStepTerms(pairs, [&]<class Mph, class Corrected>(const Mph& mph, Corrected) {
    sumOnAll(context, pairs,
             Divergence<D, double, Mph, Corrected::value, false, false>{mph, u.data(), div.data()});
  });
  subtractDivergenceAlongWalls(context, pairs, u, div);
}

#define TREACLE_INSTANTIATE(D)                                                                           \
  TREACLE_DENSITY_SUMS(D, Cuda)                                                                          \
  TREACLE_SLIP_SUMS(D, Cuda)                                                                             \
  template void addPressureGradient(Context<Cuda>&, const MphPairs<D>&, std::span<const double>, double, \
                                    std::span<Vec<D>>);                                                  \
  template void divergence(Context<Cuda>&, const MphPairs<D>&, std::span<const Vec<D>>, std::span<double>);
TREACLE_INSTANTIATE(2)
TREACLE_INSTANTIATE(3)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
