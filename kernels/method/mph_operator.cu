#include "treacle/method/mph_operator.hpp"

#include "method/pair_terms.cuh"

namespace treacle {
namespace {

/// The self terms: those of the walls and the inertia, and the sums over the fluid.
template <int D>
struct SelfSums {
  static constexpr int values = D * D + D;
  static constexpr bool uses(ListSegment s) { return isFluid(s); }
  using Own = std::uint8_t;  // material
  using Other = std::uint8_t;

  PairConstants<D, double> constants;
  WallTerms<D> wall;
  Block<D>* block;
  Vec<D>* gradient;

  __device__ Own loadOwn(const MphPairs<D>& pairs, std::uint32_t i) const { return pairs.material[i]; }
  __device__ Other loadOther(const MphPairs<D>& pairs, std::uint32_t j) const { return pairs.material[j]; }

  __device__ void add(const MphPairs<D>& pairs, double* sum, const Vec<D>& d, double inverseR, Own own,
                      Other other, ListSegment) const {
    const double f = pairs.materials.pairViscosity[own][other] * constants.viscosityReach(inverseR);
    for (int r = 0; r < D; ++r) addScaled(sum + r * D, f * d[r], d);
    addScaled(sum + D * D, constants.pressureReach(inverseR), d);
  }
  __device__ void store(const MphPairs<D>&, std::uint32_t i, int n, double sum) const {
    if (n < D * D)
      block[i].a[n] = wall.block[i].a[n] + constants.viscosityFactor * sum;
    else
      gradient[i][n - D * D] = wall.gradient[i][n - D * D] + constants.pressureFactor * sum;
  }
};

template <int D, class T, class S, bool OneMaterial>
void firstPass(Context<Cuda>& context, const MphPairs<D>& pairs, const Places<D, T>& places,
               const SelfTerms<D>& self, const Vec<D, T>* u, Vec<D, T>* y, T* q) {
  const auto constants = PairConstants<D, T>::make(pairs, places.unit(pairs));
  const ListTask<ViscosityAndDivergence<D, T, OneMaterial>> onFluid{pairs.fluidList, {constants, self, u, y, q}};
  const ListTask<Divergence<D, T, true, true>> onWalls{pairs.wallList, {constants, u, q}};
  launchClusterSums<D, T, S>(context, pairs, onFluid, onWalls, places);
}

template <int D, class T, class S>
void firstPass(Context<Cuda>& context, const MphPairs<D>& pairs, const Places<D, T>& places,
               const SelfTerms<D>& self, const Vec<D, T>* u, Vec<D, T>* y, T* q) {
  if (pairs.materials.count == 1)
    firstPass<D, T, S, true>(context, pairs, places, self, u, y, q);
  else
    firstPass<D, T, S, false>(context, pairs, places, self, u, y, q);
}

}  // namespace

template <int D>
void MphOperator<D, Cuda>::prepare(Context<Cuda>& context, const MphPairs<D>& pairs, const WallTerms<D>& terms) {
  pairs_ = &pairs;
  q_.resize(context, pairs.activeCount);
  selfBlock_.resize(context, pairs.fluidCount);
  selfGradient_.resize(context, pairs.fluidCount);
  const ListTask<SelfSums<D>> sums{
      pairs.fluidList, {PairConstants<D, double>::make(pairs, 1), terms, selfBlock_.data(), selfGradient_.data()}};
  const auto places = Places<D, double>::make(pairs);
  if (pairs.fluidList.offset) {
    launchClusterSums<D, double, Sharing<2, 1>>(context, pairs, sums, places);
    near_.prepare(context, pairs);
  } else {
    launchClusterSums<D, double, Sharing<2, 1, true>>(context, pairs, sums, places);
  }
}

template <int D>
void MphOperator<D, Cuda>::multiply(Context<Cuda>& context, std::span<const Vec<D>> u, std::span<Vec<D>> y) {
  const SelfTerms<D> self{selfBlock_, selfGradient_};
  const auto places = Places<D, double>::make(*pairs_);
  withSharing(*pairs_, [&](auto sharing) {
    firstPass<D, double, decltype(sharing)>(context, *pairs_, places, self, u.data(), y.data(), q_.data());
  });
  if (pairs_->fluidList.offset)
    near_.addPressureGradient(context, q_, y);
  else
    addPressureGradient<D>(context, *pairs_, q_, 1.0, y);
}

template <int D>
void MphOperator<D, Cuda>::multiplySingle(Context<Cuda>& context, std::span<const Vec<D, float>> u,
                                          std::span<float> q, std::span<Vec<D, float>> y) {
  const SelfTerms<D> self{selfBlock_, selfGradient_};
  const auto places = Places<D, float>::make(*pairs_, near_.fixedPosition().data());
  withListSharing(*pairs_, [&](auto sharing) {
    firstPass<D, float, decltype(sharing)>(context, *pairs_, places, self, u.data(), y.data(), q.data());
  });
  near_.addPressureGradient(context, q, y);
}

template class MphOperator<2, Cuda>;
template class MphOperator<3, Cuda>;

}  // namespace treacle
