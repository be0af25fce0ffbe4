#pragma once

#include "mph/product_terms.cuh"

namespace treacle {

/// For sums once per step: one form for all sizes.
template <class F, int D>
void withStepSharing(const MphPairs<D>& pairs, F&& f) {
  if (pairs.fluidList.offset)
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
