#include "treacle/mph/mph_operator.hpp"

#include "mph/step_sums.cuh"
#include "treacle/core/halo.hpp"
#include "treacle/mph/mph_sums.hpp"

namespace treacle {
namespace {

/// The self terms: those of the walls and the inertia, and the sums over the fluid.
template <int D, class Mph>
struct SelfSums {
  static constexpr int values = D * D + D;
  static constexpr bool uses(ListSegment s) { return isFluid(s); }
  using Own = ViscousSide;
  using Other = ViscousSide;

  Mph mph;
  WallTerms<D> wall;
  Block<D>* block;
  Vec<D>* gradient;  // null: not wanted

  __device__ Own loadOwn(const MphPairs<D>& pairs, std::uint32_t i) const { return pairs.viscousSide(i); }
  __device__ Other loadOther(const MphPairs<D>& pairs, std::uint32_t j) const { return pairs.viscousSide(j); }

  __device__ void add(const MphPairs<D>& pairs, double* sum, const Vec<D>& d, const PairDistance<double>& r,
                      Own own, Other other, ListSegment) const {
    const double f = pairs.viscosityOf(own, other) * mph.viscousShape(r);
    for (int r = 0; r < D; ++r) addScaled(sum + r * D, f * d[r], d);
    addScaled(sum + D * D, mph.gradientShape(r), d);
  }
  __device__ void store(const MphPairs<D>&, std::uint32_t i, int n, double sum) const {
    if (n < D * D)
      block[i].a[n] = wall.block[i].a[n] + mph.viscousFactor * sum;
    else if (gradient)
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
  if (!pairs.renormalisation) selfGradient_.resize(context, pairs.fluidCount);
  withScheme(pairs.terms, [&](const auto& mph) {
    sumOnFluid(context, pairs,
               SelfSums<D, std::decay_t<decltype(mph)>>{mph, terms, selfBlock_.data(), selfGradient_.data()});
  });
  if (pairs.fluidList.offset) near_.prepare(context, pairs);
}

template <int D>
void MphOperator<D, Cuda>::multiply(Context<Cuda>& context, std::span<const Vec<D>> own, std::span<Vec<D>> y) {
  const std::span<const Vec<D>> u = withGhosts(context, own, withGhosts_);
  if (pairs_->renormalisation) return multiplyRenormalised(context, u, y);
  const SelfTerms<D> self{selfBlock_, selfGradient_};
  const auto places = LocalPositions<D, double>::make(*pairs_);
  const auto firstPass = [&](const auto& mph, auto sharing, auto viscosity) {
    using Mph = std::decay_t<decltype(mph)>;
    using OnFluid = ViscosityAndDivergence<D, double, viscosity, Mph>;
    using OnWalls = Divergence<D, double, Mph, false, true, true>;
    launchClusterSums<D, double, decltype(sharing)>(
        context, *pairs_, ListTask<OnFluid>{pairs_->fluidList, {mph, self, u.data(), y.data(), q_.data()}},
        ListTask<OnWalls>{pairs_->wallList, {mph, u.data(), q_.data()}}, places);
  };
  const auto terms = pairs_->terms.with(PublishedScheme{});
  withSharing(*pairs_, [&](auto sharing) {
    withPairViscosity(*pairs_, [&](auto viscosity) { firstPass(terms, sharing, viscosity); });
  });
  fillGhosts(context, Held::Active, q_.data());
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
  const auto terms = pairs_->terms.with(AccurateScheme{});
  withSharing(*pairs_, [&](auto sharing) {
    withPairViscosity(*pairs_, [&](auto viscosity) {
      using OnFluid = Viscosity<D, double, viscosity, std::decay_t<decltype(terms)>, Vec<D>, StoreProduct<D>>;
      launchClusterSums<D, double, decltype(sharing)>(
          context, *pairs_, ListTask<OnFluid>{pairs_->fluidList, {terms, selfBlock_.data(), u.data(), {y.data()}}},
          places);
    });
  });
  if (pairs_->fluidList.offset) {
    near_.bulkStress(context, u, q_);
    fillGhosts(context, Held::Active, q_.data());
    near_.addPressureGradient(context, q_, y);
    return;
  }
  using OnAll = Divergence<D, double, std::decay_t<decltype(terms)>, true, true, true, true>;
  const OnAll sums{terms, u.data(), q_.data()};
  launchClusterSums<D, double, Sharing<4, 1, true>>(context, *pairs_, ListTask<OnAll>{pairs_->fluidList, sums},
                                                    ListTask<OnAll>{pairs_->wallList, sums}, places);
  subtractBulkStressAlongWalls<D>(context, *pairs_, u, q_);
  fillGhosts(context, Held::Active, q_.data());
  addPressureGradient<D>(context, *pairs_, q_, 1.0, y);
}

template class MphOperator<2, Cuda>;
template class MphOperator<3, Cuda>;

}  // namespace treacle
