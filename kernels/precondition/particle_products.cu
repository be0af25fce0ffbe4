#include "treacle/precondition/particle_products.hpp"

#include "precondition/coarse_positions.cuh"
#include "precondition/staged_sums.cuh"

namespace treacle {
namespace {

template <int D, class T>
LocalPositions<D, T> placesOf(const MphPairs<D>& pairs, const NearProducts<D>& near) {
  if constexpr (std::is_same_v<T, double>)
    return LocalPositions<D, T>::make(pairs);
  else
    return LocalPositions<D, T>::make(pairs, near.fixedPosition().data());
}

/// Where the particles stand, and B, beside what is gathered of them.
template <int D>
void placeParticles(const Context<Cuda>& context, const MphPairs<D>& pairs, const NearProducts<D>& near,
                    PlacedScalar* first, PlacedScalar* second, PlacedVector<D>* vectors) {
  const Renormalised<D> tensors{pairs.renormalisation, pairs.fluidCount};
  forEach(context, pairs.activeCount,
          [coarse = CoarsePositions<D>::make(pairs), position = near.fixedPosition().data(), tensors, first,
           second, vectors] __device__(std::size_t i) {
            std::uint32_t x[3] = {};
            for (int k = 0; k < D; ++k) x[k] = coarse.of(position[4 * i + k], k);
            const std::uint64_t b =
                tensors.b ? PackedTensor<D>::pack(tensors.of(static_cast<std::uint32_t>(i))) : 0;
            PlacedScalar scalar{{x[0], x[1], static_cast<std::uint32_t>(b)}, 0};
            if constexpr (D == 2) {
              for (int k = 0; k < D; ++k) vectors[i].position[k] = static_cast<std::int32_t>(x[k]);
            } else {
              scalar.word[0] = vectors[i].word[0] = x[0] >> 16 | x[1];
              scalar.word[1] = x[2] >> 16 | static_cast<std::uint32_t>(b) << 16;
              scalar.word[2] = static_cast<std::uint32_t>(b >> 16);
              for (int k = 0; k < 3; ++k) vectors[i].word[k + 1] = x[2] >> (16 + 6 * k) & PlacedVector<3>::low;
            }
            first[i] = second[i] = scalar;
          });
}

/// The lists with these positions.
template <int D, class T, class Weights>
NearView<D, T, Weights> viewOf(const MphPairs<D>& pairs, const NearProducts<D>& near,
                               const MphTerms<D, double, Weights>& terms) {
  auto view = NearView<D, T, Weights>::make(pairs, near, terms);
  if constexpr (std::is_same_v<T, float>)
    static_cast<NearLists<D, float>&>(view) = CoarsePositions<D>::listsOf(pairs, near);
  return view;
}

/// One thread per particle: the inverse diagonal of S', from the positions of the neighbours. No atomics.
template <int D, class T, class Weights, class Columns>
__global__ void __launch_bounds__(128)
    pressureDiagonalKernel(const __grid_constant__ NearView<D, T, Weights> view, const Columns columns,
                           const std::uint8_t* material, const __grid_constant__ ProjectionTable<T> table,
                           T reach2, T* inverseDiagonal) {
  const std::uint32_t k = blockIdx.x * blockDim.x + threadIdx.x;
  if (k >= view.activeCount) return;
  const auto xk = view.own(k);
  const auto b = columns.of(k);
  Vec<D, T> own{};
  T others = 0;
  struct Loaded {
    typename NearLists<D, T>::Stored x;
    T weight;
  };
  const auto load = [&](std::uint32_t j) {
    return Loaded{view.other(j), j < view.fluidCount ? table.weight[material[j]] : T(0)};
  };
  alongList(view.sliceStart, view.entry, k, load, [&](const Loaded& other) {
    const Vec<D, T> d = view.difference(other.x, xk);
    const Vec<D, T> g = norm2(d) < reach2 ? gradientShape(view, d) * (b * d) : Vec<D, T>{};
    own += g;
    others += other.weight * norm2(g);
  });
  if (k < view.fluidCount) others += table.weight[material[k]] * norm2(own);
  const T factor = view.mph.gradientFactor;
  inverseDiagonal[k] = 1 / (table.shift[material[k]] + factor * factor * others);
}

}  // namespace

template <int D, class T>
void ParticleProducts<D, T, Cuda>::prepare(Context<Cuda>& context, const MphPairs<D>& pairs, const WallTerms<D>&,
                                           const MphOperator<D, Cuda>& a) {
  pairs_ = &pairs;
  a_ = &a;
  for (auto& field : scalars_) field.resize(context, pairs.activeCount);
  vectors_.resize(context, pairs.activeCount);
  clearBytes(context, vectors_.data(), vectors_.size() * sizeof(vectors_.data()[0]));
  if constexpr (std::is_same_v<T, float>) {
    placeParticles(context, pairs, a.near(), scalars_[0].data(), scalars_[1].data(), vectors_.data());
    if (pairs.renormalisation)
      staged_.prepare(context, pairs, a.near(), scalars_[0].data(), productReach<T>(pairs));
  }
  selfBlock_.resize(context, pairs.fluidCount);
  const double* from = a.selfBlock()[0].a;
  T* to = selfBlock_.data()->a;
  forEach(context, std::size_t{D * D} * pairs.fluidCount,
          [=] __device__(std::size_t k) { to[k] = static_cast<T>(from[k]); });
}

template <int D, class T>
void ParticleProducts<D, T, Cuda>::gather(Context<Cuda>& context, std::span<const T> x) {
  forEach(context, x.size(), [from = x.data(), to = scalars(0)] __device__(std::size_t k) { to[k] = from[k]; });
}

template <int D, class T>
void ParticleProducts<D, T, Cuda>::gather(Context<Cuda>& context, std::span<const Gathered<D, T>> u) {
  forEach(context, u.size(),
          [from = u.data(), to = vectors()] __device__(std::size_t i) { to.set(i, fetch(&from[i])); });
}

template <int D, class T>
void ParticleProducts<D, T, Cuda>::gatherWeighted(Context<Cuda>& context, const ProjectionTable<T>& table,
                                                  std::span<const Vec<D>> u) {
  forEach(context, u.size(),
          [table, material = pairs_->material.data(), from = u.data(), to = vectors()] __device__(std::size_t i) {
            Vec<D, T> v;
            for (int k = 0; k < D; ++k) v[k] = table.weight[material[i]] * static_cast<T>(from[i][k]);
            to.set(i, v);
          });
}

template <int D, class T>
auto gathered(ScalarField<T, Cuda> q) {
  if constexpr (std::is_same_v<T, float>)
    return PlacedScalars<D>{q.at};
  else
    return PlainScalars<D, T>{q.at};
}
template <int D, class T>
auto gathered(VectorField<D, T, Cuda> u) {
  if constexpr (std::is_same_v<T, float>)
    return PlacedVectors<D>{u.at};
  else
    return PlainVectors<D, T, Gathered<D, T>>{u.at};
}

/// B as the products read it; `scalars`: either field has it.
template <int D, class T>
auto tensors(const MphPairs<D>& pairs, const typename ScalarField<T, Cuda>::Element* scalars) {
  if constexpr (std::is_same_v<T, float>)
    return PlacedTensors<D>{scalars};
  else
    return Renormalised<D>{pairs.renormalisation, pairs.fluidCount};
}

template <int D, class T>
template <class Store>
void ParticleProducts<D, T, Cuda>::gradient(Context<Cuda>& context, ScalarField<T, Cuda> q,
                                            const Store& store) const {
  withPressureTerms(*pairs_, [&]<class Weights>(const MphTerms<D, double, Weights>& terms, auto renormalised) {
    const auto view = viewOf<D, T>(*pairs_, a_->near(), terms);
    if constexpr (!renormalised)
      nearGradient(context, view, gathered<D>(q), store);
    else if constexpr (std::is_same_v<T, float>)
      stagedGradient(context, staged_, StagedSums<D, Weights>{view, staged_.view(a_->near()), q.at}, q.at, store);
    else
      nearGradient(context, view,
                   Stresses<D, T, PlainScalars<D, T>, Renormalised<D>>{{q.at}, tensors<D, T>(*pairs_, q.at)},
                   store);
  });
}

template <int D, class T>
template <class Store>
void ParticleProducts<D, T, Cuda>::divergence(Context<Cuda>& context, VectorField<D, T, Cuda> u,
                                              const Store& store) const {
  withPressureTerms(*pairs_, [&]<class Weights>(const MphTerms<D, double, Weights>& terms, auto renormalised) {
    const auto view = viewOf<D, T>(*pairs_, a_->near(), terms);
    const auto* places = scalars_[0].data();
    if constexpr (!renormalised)
      nearDivergence(context, view, gathered(u), Plain<D, T>{}, store);
    else if constexpr (std::is_same_v<T, float>)
      stagedDivergence(context, staged_, StagedSums<D, Weights>{view, staged_.view(a_->near()), places}, u.at,
                       tensors<D, T>(*pairs_, places), store);
    else
      nearDivergence(context, view, gathered(u), tensors<D, T>(*pairs_, places), store);
  });
}

template <int D, class T>
template <class Store>
void ParticleProducts<D, T, Cuda>::schur(Context<Cuda>& context, const ProjectionTable<T>& table,
                                         ScalarField<T, Cuda> q, const Store& store) {
  const std::uint8_t* material = pairs_->material.data();
  if constexpr (std::is_same_v<T, float>)
    if (pairs_->activeCount <= onePassParticles<D> && !pairs_->renormalisation)
      return withPressureTerms(*pairs_, [&](const auto& terms, auto renormalised) {
        if constexpr (!renormalised)
          nearSchur(context, viewOf<D, T>(*pairs_, a_->near(), terms), gathered<D>(q), table, material, store);
      });
  gradient(context, q, StoreWeighted<D, T, Cuda>{table, material, vectors()});
  divergence(context, vectors(), store);
}

template <int D, class T>
template <class Store>
void ParticleProducts<D, T, Cuda>::viscous(Context<Cuda>& context, const Gathered<D, T>* u,
                                           const Store& store) const {
  const auto places = placesOf<D, T>(*pairs_, a_->near());
  const auto start = [&]<class Mph>(const Mph& mph, auto sharing, auto oneViscosity) {
    using Terms = Viscosity<D, T, decltype(oneViscosity)::value, Mph, Gathered<D, T>, Store>;
    launchClusterSums<D, T, decltype(sharing)>(
        context, *pairs_, ListTask<Terms>{pairs_->fluidList, {mph, selfBlock_.data(), u, store}}, places);
  };
  withViscosityTerms(*pairs_, [&](const auto& terms) {
    const auto mph = terms.template inUnitsOf<T>(places.unit(*pairs_));
    withListSharing(*pairs_, [&](auto sharing) {
      // In double precision, which few preconditioners have, one kernel does for all.
      if constexpr (std::is_same_v<T, float>)
        if (pairs_->hasOneViscosity()) return start(mph, sharing, std::true_type{});
      start(mph, sharing, std::false_type{});
    });
  });
}

template <int D, class T>
void ParticleProducts<D, T, Cuda>::inverseDiagonals(Context<Cuda>& context, const ProjectionTable<T>& table,
                                                    std::span<T> pressure, std::span<Block<D, T>> velocity) const {
  const double reach =
      productReach<T>(*pairs_) * pairs_->terms.pressureRadius / LocalPositions<D, T>::unit(*pairs_);
  const auto start = [&]<class Weights, class Columns>(const MphTerms<D, double, Weights>& terms,
                                                       const Columns& columns) {
    launch(context, blocksFor(pairs_->activeCount, 128), 128, 0, pressureDiagonalKernel<D, T, Weights, Columns>,
           NearView<D, T, Weights>::make(*pairs_, a_->near(), terms), columns, pairs_->material.data(), table,
           static_cast<T>(reach * reach), pressure.data());
  };
  withPressureTerms(*pairs_, [&](const auto& terms, auto renormalised) {
    if constexpr (renormalised)
      start(terms, tensors<D, T>(*pairs_, scalars_[0].data()));
    else
      start(terms, Plain<D, T>{});
  });
  forEach(context, pairs_->fluidCount, [from = selfBlock_.data(), to = velocity.data()] __device__(std::size_t i) {
    to[i] = inverse(from[i]);
  });
}

#define TREACLE_GRADIENT(D, T, ...)                                                                              \
  template void ParticleProducts<D, T, Cuda>::gradient(Context<Cuda>&, ScalarField<T, Cuda>, const __VA_ARGS__&) \
      const;
#define TREACLE_DIVERGENCE(D, T, ...)                                                             \
  template void ParticleProducts<D, T, Cuda>::divergence(Context<Cuda>&, VectorField<D, T, Cuda>, \
                                                         const __VA_ARGS__&) const;
#define TREACLE_SCHUR(D, T, ...)                                                               \
  template void ParticleProducts<D, T, Cuda>::schur(Context<Cuda>&, const ProjectionTable<T>&, \
                                                    ScalarField<T, Cuda>, const __VA_ARGS__&);
#define TREACLE_VISCOUS(D, T, ...)                                                                               \
  template void ParticleProducts<D, T, Cuda>::viscous(Context<Cuda>&, const Gathered<D, T>*, const __VA_ARGS__&) \
      const;
#define TREACLE_INSTANTIATE(D, T)              \
  template class ParticleProducts<D, T, Cuda>; \
  TREACLE_FOR_EACH_STORE(D, T, Cuda)
TREACLE_INSTANTIATE(2, double)
TREACLE_INSTANTIATE(3, double)
TREACLE_INSTANTIATE(2, float)
TREACLE_INSTANTIATE(3, float)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
