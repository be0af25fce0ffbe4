#include "treacle/precondition/particle_products.hpp"

#include "precondition/acting.cuh"
#include "precondition/coarse_positions.cuh"
#include "precondition/placed_sums.cuh"
#include "precondition/staged_sums.cuh"
#include "treacle/core/copy_values.hpp"
#include "treacle/core/halo.hpp"
#include "treacle/precondition/projected_multigrid.hpp"

namespace treacle {
namespace {

template <int D, class T>
LocalPositions<D, T> placesOf(const MphPairs<D>& pairs, const NearProducts<D>& near) {
  if constexpr (std::is_same_v<T, double>)
    return LocalPositions<D, T>::make(pairs);
  else
    return LocalPositions<D, T>::make(pairs, near.fixedPosition().data());
}

/// Where the particles stand, beside what is gathered of them.
template <int D>
void placeParticles(const Context<Cuda>& context, const MphPairs<D>& pairs, const NearProducts<D>& near,
                    PlacedScalar* first, PlacedScalar* second, PlacedVector<D>* vectors) {
  forEach(context, pairs.activeCount,
          [coarse = CoarsePositions<D>::make(pairs), position = near.fixedPosition().data(), first, second,
           vectors] __device__(std::size_t i) {
            std::uint32_t x[3] = {};
            for (int k = 0; k < D; ++k) x[k] = coarse.of(position[4 * i + k], k);
            PlacedScalar scalar{{x[0], x[1], 0}, 0};
            if constexpr (D == 2) {
              for (int k = 0; k < D; ++k) vectors[i].position[k] = static_cast<std::int32_t>(x[k]);
            } else {
              scalar.word[0] = vectors[i].word[0] = x[0] >> 16 | x[1];
              scalar.word[1] = x[2] >> 16;
              for (int k = 0; k < 3; ++k) vectors[i].word[k + 1] = x[2] >> (16 + 6 * k) & PlacedVector<3>::low;
            }
            first[i] = second[i] = scalar;
          });
}

/// The lists with these positions.
template <int D, class T, class Scheme>
NearView<D, T, Scheme> viewOf(const MphPairs<D>& pairs, const NearProducts<D>& near,
                              const MphTerms<D, double, Scheme>& terms) {
  auto view = NearView<D, T, Scheme>::make(pairs, near, terms);
  if constexpr (std::is_same_v<T, float>)
    static_cast<NearLists<D, float>&>(view) = CoarsePositions<D>::listsOf(pairs, near);
  return view;
}

/// B of the pairs.
template <int D>
Renormalised<D> tensors(const MphPairs<D>& pairs) {
  return {pairs.renormalisation, pairs.fluidCount};
}

/// The same in the precision of the products.
template <int D, class T>
struct RoundedTensors {
  Renormalised<D> exact;
  __device__ SymmetricBlock<D, T> of(std::uint32_t k) const { return converted<T>(exact.of(k)); }
};

/// One thread per particle: the inverse diagonal of S', from the positions of the neighbours. No atomics.
template <int D, class T, class Scheme, class Columns>
__global__ void __launch_bounds__(128)
    pressureDiagonalKernel(const __grid_constant__ MphPairs<D> pairs,
                           const __grid_constant__ NearView<D, T, Scheme> view, const Columns columns,
                           const std::uint8_t* material, const __grid_constant__ ProjectionTable<T> table,
                           T reach2, T unit, T* inverseDiagonal) {
  const std::uint32_t k = blockIdx.x * blockDim.x + threadIdx.x;
  if (k >= view.activeCount) return;
  const auto xk = view.own(k);
  const auto b = columns.of(k);
  Vec<D, T> own{};
  T others = 0;
  struct Loaded {
    typename NearLists<D, T>::Stored x;
    T weight;
    std::uint32_t index;
  };
  const auto load = [&](std::uint32_t j) {
    return Loaded{view.other(j), j < view.fluidCount ? table.weight[material[j]] : T(0), j};
  };
  alongList(view.sliceStart, view.entry, k, load, [&](const Loaded& other) {
    const Vec<D, T> d = view.difference(other.x, xk);
    const Vec<D, T> g = norm2(d) < reach2 ? gradientShape(view, d) * (b * d) : Vec<D, T>{};
    if constexpr (std::is_same_v<T, float>)
      own += acting(pairs, k, other.index, converted<double>(unit * d), g);
    else
      own += g;
    others += other.weight * norm2(g);
  });
  if (k < view.fluidCount) others += table.weight[material[k]] * norm2(own);
  const T factor = view.mph.gradientFactor;
  inverseDiagonal[k] = 1 / (table.shiftOf(k, material[k]) + factor * factor * others);
}

}  // namespace

template <int D, class T>
void ParticleProducts<D, T, Cuda>::prepare(Context<Cuda>& context, const MphPairs<D>& pairs, const WallTerms<D>&,
                                           const MphOperator<D, Cuda>& a) {
  pairs_ = &pairs;
  a_ = &a;
  const auto resize = [&](auto& scalars, auto& vectors) {
    for (auto& field : scalars) field.resize(context, pairs.activeCount);
    vectors.resize(context, pairs.activeCount);
    clearBytes(context, vectors.data(), vectors.size() * sizeof(vectors.data()[0]));
  };
  if (isPlaced()) {
    resize(placedScalars_, placedVectors_);
    placeParticles(context, pairs, a.near(), placedScalars_[0].data(), placedScalars_[1].data(),
                   placedVectors_.data());
  } else {
    resize(scalars_, vectors_);
    if (std::is_same_v<T, float>)
      staged_.prepare(context, pairs, a.near(), productReach<T>(pairs), isTooStiffToPack(pairs));
  }
  selfBlock_.resize(context, pairs.fluidCount);
  const double* from = a.selfBlock()[0].a;
  T* to = selfBlock_.data()->a;
  forEach(context, std::size_t{D * D} * pairs.fluidCount,
          [=] __device__(std::size_t k) { to[k] = static_cast<T>(from[k]); });
}

/// One thread per own fluid particle; reads its diagonal block and material, writes its viscosity. No atomics.
template <int D, class T>
void ParticleProducts<D, T, Cuda>::resistingViscosity(Context<Cuda>& context, double resistance,
                                                      std::span<double> viscosity) const {
  forEach(context, pairs_->ownFluid(),
          [block = selfBlock_.data(), material = pairs_->material.data(), materials = pairs_->materials,
           resistance, to = viscosity.data()] __device__(std::size_t i) {
            to[i] = treacle::resistingViscosity(block[i], materials.inertia[material[i]], resistance);
          });
  fillGhosts(context, Held::Fluid, viscosity.data());
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
          [table, material = pairs_->classOf(), from = u.data(), to = vectors()] __device__(std::size_t i) {
            Vec<D, T> v;
            for (int k = 0; k < D; ++k) v[k] = table.weight[material[i]] * static_cast<T>(from[i][k]);
            to.set(i, v);
          });
}

template <int D, class T>
ScalarField<T, Cuda> ParticleProducts<D, T, Cuda>::scalars(int which) {
  if constexpr (std::is_same_v<T, float>)
    return isPlaced()
               ? ScalarField<T, Cuda>{&placedScalars_[which].data()->value, sizeof(PlacedScalar) / sizeof(T)}
               : ScalarField<T, Cuda>{scalars_[which].data(), 1};
  else
    return {scalars_[which].data()};
}
template <int D, class T>
VectorField<D, T, Cuda> ParticleProducts<D, T, Cuda>::vectors() {
  if constexpr (std::is_same_v<T, float>)
    return isPlaced() ? VectorField<D, T, Cuda>{nullptr, placedVectors_.data()}
                      : VectorField<D, T, Cuda>{vectors_.data(), nullptr};
  else
    return {vectors_.data()};
}

/// As products without staged neighbours gather them.
template <int D, class T>
auto gathered(ScalarField<T, Cuda> q) {
  if constexpr (std::is_same_v<T, float>)
    return PlacedScalars<D>{reinterpret_cast<const PlacedScalar*>(reinterpret_cast<const char*>(q.at) -
                                                                  offsetof(PlacedScalar, value))};
  else
    return PlainScalars<D, T>{q.at};
}
template <int D, class T>
auto gathered(VectorField<D, T, Cuda> u) {
  if constexpr (std::is_same_v<T, float>)
    return PlacedVectors<D>{u.placed};
  else
    return PlainVectors<D, T, Gathered<D, T>>{u.at};
}

/// Brings what is gathered of ghosts; a position beside it is the same everywhere.
template <class T>
void fillGhosts(const Context<Cuda>& context, ScalarField<T, Cuda> q) {
  if constexpr (std::is_same_v<T, float>)
    if (q.stride > 1)
      return fillGhosts(
          context, Held::Active,
          reinterpret_cast<PlacedScalar*>(reinterpret_cast<char*>(q.at) - offsetof(PlacedScalar, value)));
  fillGhosts(context, Held::Active, q.at);
}
template <int D, class T>
void fillGhosts(const Context<Cuda>& context, VectorField<D, T, Cuda> u) {
  if constexpr (std::is_same_v<T, float>)
    if (u.placed) return fillGhosts(context, Held::Fluid, u.placed);
  fillGhosts(context, Held::Fluid, u.at);
}

template <int D, class T>
template <class Store>
void ParticleProducts<D, T, Cuda>::gradient(Context<Cuda>& context, ScalarField<T, Cuda> q,
                                            const Store& store) const {
  fillGhosts(context, q);
  if constexpr (std::is_same_v<T, float>)
    if (pairs_->renormalisation) return stagedGradient(context, staged_, *pairs_, a_->near(), q, store);
  withSchemeTerms(*pairs_, [&](const auto& terms, auto renormalised) {
    const auto scalars = gathered<D>(q);
    if constexpr (!renormalised)
      nearGradient(context, viewOf<D, T>(*pairs_, a_->near(), terms), scalars, store);
    else if constexpr (std::is_same_v<T, double>)
      nearGradient(context, viewOf<D, T>(*pairs_, a_->near(), terms),
                   Stresses<D, T, PlainScalars<D, T>, Renormalised<D>>{scalars, tensors(*pairs_)}, store);
  });
}

template <int D, class T>
template <class Store>
void ParticleProducts<D, T, Cuda>::divergence(Context<Cuda>& context, VectorField<D, T, Cuda> u,
                                              const Store& store) const {
  fillGhosts(context, u);
  if constexpr (std::is_same_v<T, float>)
    if (pairs_->renormalisation) return stagedDivergence(context, staged_, *pairs_, a_->near(), u, store);
  withSchemeTerms(*pairs_, [&](const auto& terms, auto renormalised) {
    if constexpr (!renormalised)
      nearDivergence(context, viewOf<D, T>(*pairs_, a_->near(), terms), gathered(u), Plain<D, T>{}, store);
    else if constexpr (std::is_same_v<T, double>)
      nearDivergence(context, viewOf<D, T>(*pairs_, a_->near(), terms), gathered(u), tensors(*pairs_), store);
  });
}

template <int D, class T>
template <class Store>
void ParticleProducts<D, T, Cuda>::schur(Context<Cuda>& context, const ProjectionTable<T>& table,
                                         ScalarField<T, Cuda> q, const Store& store) {
  const std::uint8_t* material = pairs_->classOf();
  if constexpr (std::is_same_v<T, float>)
    if (pairs_->activeCount <= onePassParticles<D> && !pairs_->renormalisation && !context.halo)
      return withSchemeTerms(*pairs_, [&](const auto& terms, auto renormalised) {
        if constexpr (!renormalised)
          nearSchur(context, viewOf<D, T>(*pairs_, a_->near(), terms), gathered<D>(q), table, material, store);
      });
  gradient(context, q, StoreWeighted<D, T, Cuda>{table, material, vectors()});
  divergence(context, vectors(), store);
}

template <int D, class T>
std::size_t ParticleProducts<D, T, Cuda>::bytes() const {
  std::size_t sum = staged_.bytes() + vectors_.bytes() + placedVectors_.bytes() + selfBlock_.bytes();
  for (int k = 0; k < 2; ++k) sum += scalars_[k].bytes() + placedScalars_[k].bytes();
  return sum;
}

template <int D, class T>
template <class Store>
void ParticleProducts<D, T, Cuda>::viscous(Context<Cuda>& context, Gathered<D, T>* u, const Store& store) const {
  fillGhosts(context, Held::Fluid, u);
  const auto places = placesOf<D, T>(*pairs_, a_->near());
  const auto start = [&]<class Mph>(const Mph& mph, auto sharing, auto viscosity) {
    using Terms = Viscosity<D, T, viscosity, Mph, Gathered<D, T>, Store>;
    launchClusterSums<D, T, decltype(sharing)>(
        context, *pairs_, ListTask<Terms>{pairs_->fluidList, {mph, selfBlock_.data(), u, store}}, places);
  };
  withScheme(pairs_->terms, [&](const auto& terms) {
    const auto mph = terms.template inUnitsOf<T>(places.unit(*pairs_));
    withListSharing(*pairs_, [&](auto sharing) {
      if constexpr (std::is_same_v<T, float>)
        withPairViscosity(*pairs_, [&](auto viscosity) { start(mph, sharing, viscosity); });
      else  // few preconditioners have it: one kernel does for all
        start(mph, sharing, std::integral_constant<PairViscosity, PairViscosity::Any>{});
    });
  });
}

template <int D, class T>
void ParticleProducts<D, T, Cuda>::inverseDiagonals(Context<Cuda>& context, const ProjectionTable<T>& table,
                                                    std::span<T> pressure, std::span<Block<D, T>> velocity) const {
  const double unit = LocalPositions<D, T>::unit(*pairs_),
               reach = productReach<T>(*pairs_) * pairs_->terms.pressureRadius / unit;
  const auto start = [&]<class Scheme, class Columns>(const MphTerms<D, double, Scheme>& terms,
                                                      const Columns& columns) {
    launch(context, blocksFor(pairs_->activeCount, 128), 128, 0, pressureDiagonalKernel<D, T, Scheme, Columns>,
           *pairs_, NearView<D, T, Scheme>::make(*pairs_, a_->near(), terms), columns, pairs_->classOf(), table,
           static_cast<T>(reach * reach), static_cast<T>(unit), pressure.data());
  };
  withSchemeTerms(*pairs_, [&](const auto& terms, auto renormalised) {
    if constexpr (renormalised)
      start(terms, RoundedTensors<D, T>{tensors(*pairs_)});
    else
      start(terms, Plain<D, T>{});
  });
  clearValues(context, pressure.subspan(pairs_->ownFluid(), pairs_->ghostFluid));
  clearValues(context, pressure.subspan(pairs_->ownEnd(), pairs_->ghostWalls));
  forEach(context, pairs_->ownFluid(), [from = selfBlock_.data(), to = velocity.data()] __device__(std::size_t i) {
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
#define TREACLE_VISCOUS(D, T, ...) \
  template void ParticleProducts<D, T, Cuda>::viscous(Context<Cuda>&, Gathered<D, T>*, const __VA_ARGS__&) const;
#define TREACLE_INSTANTIATE(D, T)              \
  template class ParticleProducts<D, T, Cuda>; \
  TREACLE_FOR_EACH_STORE(D, T, Cuda)
TREACLE_INSTANTIATE(2, double)
TREACLE_INSTANTIATE(3, double)
TREACLE_INSTANTIATE(2, float)
TREACLE_INSTANTIATE(3, float)
#undef TREACLE_INSTANTIATE
#undef TREACLE_VISCOUS
#undef TREACLE_SCHUR
#undef TREACLE_DIVERGENCE
#undef TREACLE_GRADIENT

}  // namespace treacle
