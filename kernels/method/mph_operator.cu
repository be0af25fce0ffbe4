#include "treacle/method/mph_operator.hpp"

#include "method/pair_terms.cuh"

namespace treacle {
namespace {

/// Bytes that one product moves at least, per fluid particle in 3D: position 24, u 24 read and y 24 written, wall
/// terms 96, the list (about 40 entries per particle, 160), q 8 written; second pass: position 24, q 8, y 48, near list
/// 44. The arithmetic takes longer (docs/performance.md).
template <int D, class T, class S, bool OneMaterial>
void product(Context<Cuda>& context, const MphPairs<D>& pairs, const WallTerms<D>& wall, const Vec<D, T>* u,
             Vec<D, T>* y, T* q) {
  const double unit = frameUnit<T>(pairs.viscosityWeight.radius);
  const auto constants = PairConstants<D, T>::make(pairs, unit);
  const ListTask<ViscosityAndDivergence<D, T, OneMaterial>> onFluid{pairs.fluidList, {constants, wall, u, y, q}};
  const ListTask<Divergence<D, T, true, true>> onWalls{pairs.wallList, {constants, u, q}};
  launchClusterSums<D, T, S>(context, pairs, onFluid, onWalls, unit);

  const ListTask<PressureGradient<D, T, true>> gradient{pairs.fluidList, {constants, q, y}};
  launchClusterSums<D, T, S>(context, pairs, gradient, unit);
}

template <int D, class T, class S>
void productOf(Context<Cuda>& context, const MphPairs<D>& pairs, const WallTerms<D>& wall, const Vec<D, T>* u,
               Vec<D, T>* y, T* q) {
  if (pairs.materials.count == 1)
    product<D, T, S, true>(context, pairs, wall, u, y, q);
  else
    product<D, T, S, false>(context, pairs, wall, u, y, q);
}

}  // namespace

template <int D>
void MphOperator<D, Cuda>::prepare(Context<Cuda>& context, const MphPairs<D>& pairs, const WallTerms<D>& terms) {
  pairs_ = &pairs;
  terms_ = terms;
  q_.resize(context, pairs.activeCount);
}

template <int D>
void MphOperator<D, Cuda>::multiply(Context<Cuda>& context, std::span<const Vec<D>> u, std::span<Vec<D>> y) {
  withSharing(*pairs_, [&](auto sharing) {
    productOf<D, double, decltype(sharing)>(context, *pairs_, terms_, u.data(), y.data(), q_.data());
  });
}

template <int D>
void MphOperator<D, Cuda>::multiplySingle(Context<Cuda>& context, std::span<const Vec<D, float>> u,
                                          std::span<float> q, std::span<Vec<D, float>> y) {
  withListSharing(*pairs_, [&](auto sharing) {
    productOf<D, float, decltype(sharing)>(context, *pairs_, terms_, u.data(), y.data(), q.data());
  });
}

template class MphOperator<2, Cuda>;
template class MphOperator<3, Cuda>;

}  // namespace treacle
