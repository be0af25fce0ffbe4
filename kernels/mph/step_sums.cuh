#pragma once

#include "mph/product_terms.cuh"

namespace treacle {

/// f(terms, whether the pairs may have surfaces of walls or B): the published scheme has neither.
template <int D, class F>
void withStepTerms(const MphPairs<D>& pairs, F&& f) {
  if (pairs.terms.scheme.kind == SchemeKind::Published)
    f(pairs.terms.with(PublishedScheme{}), std::false_type{});
  else
    f(pairs.terms.with(AccurateScheme{}), std::true_type{});
}

/// The factor of a pair's viscosity, 1 where it is not Corrected.
template <bool Corrected, int D>
__device__ double viscosityFactor(const MphPairs<D>& pairs, std::uint32_t i, std::uint32_t j, const Vec<D>& d) {
  if constexpr (Corrected) return pairs.wallFactor(i, j, d);
  return 1;
}

/// For sums once per step.
template <class F, int D>
void withStepSharing(const MphPairs<D>& pairs, F&& f) {
  if (pairs.fluidList.offset && pairs.fluidList.clusterCount() < fewClusters)
    f(Sharing<2, 4>{});
  else if (pairs.fluidList.offset)
    f(Sharing<2, 1>{});
  else
    f(Sharing<2, 1, true>{});
}

template <int D, class Terms>
void sumOnList(Context<Cuda>& context, const MphPairs<D>& pairs, const ClusterListView& list, const Terms& terms) {
  withStepSharing(pairs, [&](auto sharing) {
    launchClusterSums<D, double, decltype(sharing)>(context, pairs, ListTask<Terms>{list, terms},
                                                    LocalPositions<D, double>::make(pairs));
  });
}
template <int D, class Terms>
void sumOnFluid(Context<Cuda>& context, const MphPairs<D>& pairs, const Terms& terms) {
  sumOnList(context, pairs, pairs.fluidList, terms);
}
template <int D, class Terms>
void sumOnAll(Context<Cuda>& context, const MphPairs<D>& pairs, const Terms& terms) {
  withStepSharing(pairs, [&](auto sharing) {
    const ListTask<Terms> fluid{pairs.fluidList, terms}, walls{pairs.wallList, terms};
    launchClusterSums<D, double, decltype(sharing)>(context, pairs, fluid, walls,
                                                    LocalPositions<D, double>::make(pairs));
  });
}

}  // namespace treacle
