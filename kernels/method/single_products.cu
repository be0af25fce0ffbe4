#include "method/pair_terms.cuh"
#include "treacle/method/single_products.hpp"

namespace treacle {

template <int D>
void pressureGradient(Context<Cuda>& context, const MphPairs<D>& pairs, std::span<const float> q,
                      std::span<Vec<D, float>> y) {
  const double unit = frameUnit<float>(pairs.viscosityWeight.radius);
  const auto constants = PairConstants<D, float>::make(pairs, unit);
  using Terms = PressureGradient<D, float, false>;
  withListSharing(pairs, [&](auto sharing) {
    launchClusterSums<D, float, decltype(sharing)>(
        context, pairs, ListTask<Terms>{pairs.fluidList, {constants, q.data(), y.data()}}, unit);
  });
}

template <int D>
void divergence(Context<Cuda>& context, const MphPairs<D>& pairs, std::span<const Vec<D, float>> u,
                std::span<float> div) {
  const double unit = frameUnit<float>(pairs.viscosityWeight.radius);
  const auto constants = PairConstants<D, float>::make(pairs, unit);
  using Terms = Divergence<D, float, true, false>;
  withListSharing(pairs, [&](auto sharing) {
    const Terms terms{constants, u.data(), div.data()};
    launchClusterSums<D, float, decltype(sharing)>(context, pairs, ListTask<Terms>{pairs.fluidList, terms},
                                                   ListTask<Terms>{pairs.wallList, terms}, unit);
  });
}

template void pressureGradient<2>(Context<Cuda>&, const MphPairs<2>&, std::span<const float>,
                                  std::span<Vec<2, float>>);
template void pressureGradient<3>(Context<Cuda>&, const MphPairs<3>&, std::span<const float>,
                                  std::span<Vec<3, float>>);
template void divergence<2>(Context<Cuda>&, const MphPairs<2>&, std::span<const Vec<2, float>>, std::span<float>);
template void divergence<3>(Context<Cuda>&, const MphPairs<3>&, std::span<const Vec<3, float>>, std::span<float>);

}  // namespace treacle
