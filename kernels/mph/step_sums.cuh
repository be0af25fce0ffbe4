#pragma once

#include "core/each.cuh"
#include "mph/product_terms.cuh"

namespace treacle {

/// body(pairs, i) for particles i < count, one thread each. The pairs are too large for a copy in every thread. No
/// atomics but the body's.
template <int D, class Body>
__global__ void forEachParticleKernel(const __grid_constant__ MphPairs<D> pairs, std::size_t count,
                                      const Body body) {
  const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
  if (i < count) body(pairs, i);
}
template <int D, class Body>
void forEachParticle(const Context<Cuda>& context, const MphPairs<D>& pairs, std::size_t count, const Body& body) {
  launch(context, blocksFor(count, 256), 256, 0, forEachParticleKernel<D, Body>, pairs, count, body);
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

/// Terms of both backends (pair_sums.hpp) as ClusterSum reads them.
template <int D, class Terms>
struct DeviceTerms : Terms {
  using Own = decltype(std::declval<const Terms&>().own(std::declval<const MphPairs<D>&>(), OneParticle{}));
  using Other = decltype(otherOf(std::declval<const MphPairs<D>&>(), std::declval<const Terms&>(), 0u));

  __device__ Own loadOwn(const MphPairs<D>& pairs, std::uint32_t i) const {
    return Terms::own(pairs, OneParticle{i});
  }
  __device__ Other loadOther(const MphPairs<D>& pairs, std::uint32_t j) const {
    return otherOf(pairs, static_cast<const Terms&>(*this), j);
  }
};

template <int D, class Terms>
auto deviceTerms(const Terms& terms) {
  if constexpr (requires { typename Terms::Other; })
    return terms;
  else
    return DeviceTerms<D, Terms>{terms};
}

template <int D, class Terms>
void sumOnList(Context<Cuda>& context, const MphPairs<D>& pairs, const ClusterListView& list, const Terms& terms) {
  withStepSharing(pairs, [&](auto sharing) {
    launchClusterSums<D, double, decltype(sharing)>(context, pairs, ListTask{list, deviceTerms<D>(terms)},
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
    const ListTask fluid{pairs.fluidList, deviceTerms<D>(terms)}, walls{pairs.wallList, fluid.terms};
    launchClusterSums<D, double, decltype(sharing)>(context, pairs, fluid, walls,
                                                    LocalPositions<D, double>::make(pairs));
  });
}

}  // namespace treacle
