#include "treacle/mph/mph_operator.hpp"

#include "mph/product_terms.cuh"

namespace treacle {
namespace {

/// The self terms: those of the walls and the inertia, and the sums over the fluid.
template <int D>
struct SelfSums {
  static constexpr int values = D * D + D;
  static constexpr bool uses(ListSegment s) { return isFluid(s); }
  using Own = Substance;
  using Other = Substance;

  MphTerms<D, double> mph;
  WallTerms<D> wall;
  Block<D>* block;
  Vec<D>* gradient;

  __device__ Own loadOwn(const MphPairs<D>& pairs, std::uint32_t i) const { return pairs.substance(i); }
  __device__ Other loadOther(const MphPairs<D>& pairs, std::uint32_t j) const { return pairs.substance(j); }

  __device__ void add(const MphPairs<D>& pairs, double* sum, const Vec<D>& d, const PairDistance<double>& r,
                      Own own, Other other, ListSegment) const {
    const double f = pairs.viscosity(own, other) * mph.viscousShape(r);
    for (int r = 0; r < D; ++r) addScaled(sum + r * D, f * d[r], d);
    addScaled(sum + D * D, mph.gradientShape(r), d);
  }
  __device__ void store(const MphPairs<D>&, std::uint32_t i, int n, double sum) const {
    if (n < D * D)
      block[i].a[n] = wall.block[i].a[n] + mph.viscousFactor * sum;
    else
      gradient[i][n - D * D] = wall.gradient[i][n - D * D] + mph.gradientFactor * sum;
  }
};

template <int D>
struct StoreProduct {
  Vec<D>* y;
  __device__ void operator()(std::uint32_t i, const Vec<D>& product) const { y[i] = product; }
};

}  // namespace

template <int D>
void MphOperator<D, Cuda>::prepare(Context<Cuda>& context, const MphPairs<D>& pairs, const WallTerms<D>& terms) {
  pairs_ = &pairs;
  q_.resize(context, pairs.activeCount);
  selfBlock_.resize(context, pairs.fluidCount);
  selfGradient_.resize(context, pairs.fluidCount);
  const ListTask<SelfSums<D>> sums{pairs.fluidList, {pairs.terms, terms, selfBlock_.data(), selfGradient_.data()}};
  const auto places = LocalPositions<D, double>::make(pairs);
  if (pairs.fluidList.offset) {
    launchClusterSums<D, double, Sharing<2, 1>>(context, pairs, sums, places);
    near_.prepare(context, pairs);
  } else {
    launchClusterSums<D, double, Sharing<2, 1, true>>(context, pairs, sums, places);
  }
}

template <int D>
void MphOperator<D, Cuda>::multiply(Context<Cuda>& context, std::span<const Vec<D>> u, std::span<Vec<D>> y) {
  if (pairs_->renormalisation) return multiplyRenormalised(context, u, y);
  const SelfTerms<D> self{selfBlock_, selfGradient_};
  const auto places = LocalPositions<D, double>::make(*pairs_);
  withSharing(*pairs_, [&](auto sharing) {
    const auto firstPass = [&](auto oneSubstance) {
      using OnFluid = ViscosityAndDivergence<D, double, decltype(oneSubstance)::value>;
      const MphTerms<D, double>& terms = pairs_->terms;
      launchClusterSums<D, double, decltype(sharing)>(
          context, *pairs_, ListTask<OnFluid>{pairs_->fluidList, {terms, self, u.data(), y.data(), q_.data()}},
          ListTask<Divergence<D, double, true, true>>{pairs_->wallList, {terms, u.data(), q_.data()}}, places);
    };
    if (pairs_->isOneSubstance())
      firstPass(std::true_type{});
    else
      firstPass(std::false_type{});
  });
  if (pairs_->fluidList.offset)
    near_.addPressureGradient(context, q_, y);
  else
    addPressureGradient<D>(context, *pairs_, q_, 1.0, y);
}

/// B_i would have to stay in the registers of the first pass for all particles of a cluster: the divergence has a
/// pass of its own, particle by particle.
template <int D>
void MphOperator<D, Cuda>::multiplyRenormalised(Context<Cuda>& context, std::span<const Vec<D>> u,
                                                std::span<Vec<D>> y) {
  const auto places = LocalPositions<D, double>::make(*pairs_);
  const MphTerms<D, double>& terms = pairs_->terms;
  withSharing(*pairs_, [&](auto sharing) {
    using OnFluid = Viscosity<D, double, false, Vec<D>, StoreProduct<D>>;
    launchClusterSums<D, double, decltype(sharing)>(
        context, *pairs_, ListTask<OnFluid>{pairs_->fluidList, {terms, selfBlock_.data(), u.data(), {y.data()}}},
        places);
  });
  if (pairs_->fluidList.offset) {
    near_.bulkStress(context, u, q_);
    near_.addPressureGradient(context, q_, y);
    return;
  }
  using OnAll = Divergence<D, double, true, true, true>;
  withSharing(*pairs_, [&](auto sharing) {
    const OnAll sums{terms, u.data(), q_.data()};
    launchClusterSums<D, double, decltype(sharing)>(context, *pairs_, ListTask<OnAll>{pairs_->fluidList, sums},
                                                    ListTask<OnAll>{pairs_->wallList, sums}, places);
  });
  addPressureGradient<D>(context, *pairs_, q_, 1.0, y);
}

template class MphOperator<2, Cuda>;
template class MphOperator<3, Cuda>;

}  // namespace treacle
