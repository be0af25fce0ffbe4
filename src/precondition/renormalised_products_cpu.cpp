#include "product_lanes.hpp"
#include "treacle/precondition/particle_products.hpp"

// The products with C and C^T where the pairs have B, in a source of their own: the roundings of those without
// depend on what else a compiler finds in theirs.

namespace treacle {
namespace {

/// Sum of g B d.(u_j - u_i) over near fluid.
template <int D, class T>
VectorSums<1, T> sumAlong(const ClusterWalk<D, T>& walk, const T* coefficient, const Gathered<D, T>* u,
                          const LanesOf<T>* own, const SymmetricBlock<D, LanesOf<T>>& b) {
  LanesOf<T> sum[2][1] = {};
  walk.forEach(ListSegment::NearFluid, coefficient,
               [&](int half, std::uint32_t j, const LanesOf<T>& g, const LanesOf<T>* d) {
                 LanesOf<T> along = (u[j][0] - own[0]) * b.row(0, d);
                 for (int k = 1; k < D; ++k) along += (u[j][k] - own[k]) * b.row(k, d);
                 sum[half][0] += g * along;
               });
  return VectorSums<1, T>(sum);
}

}  // namespace

/// B in the precision of the products, and the sums of g d multiplied by it.
template <int D, class T>
void ParticleProducts<D, T, Cpu>::renormalise() {
  renormalisation_.resize(pairs_->fluidCount);
  for (std::uint32_t i = 0; i < pairs_->fluidCount; ++i)
    for (int at = 0; at < SymmetricBlock<D>::size; ++at)
      renormalisation_[i].a[at] = static_cast<T>(pairs_->renormalisation[i].a[at]);
  const ClusterListView& list = pairs_->fluidList;
  forEachClusterOf(list, [&](std::uint32_t c) {
    const SymmetricBlock<D, LanesOf<T>> b = loadBlocks<LanesOf<T>>(ClusterRange(list, c), renormalisation_.data());
    for (Buffer<T>* gradient : {&gradient_, &wallGradient_}) {
      T* at = &(*gradient)[std::size_t{D} * clusterSize * c];
      LanesOf<T> v[D];
      for (int k = 0; k < D; ++k) v[k] = load<LanesOf<T>>(at + k * clusterSize);
      for (int k = 0; k < D; ++k) store<T>(b.row(k, v), at + k * clusterSize);
    }
  });
}

template <int D, class T>
template <class Store>
void ParticleProducts<D, T, Cpu>::renormalisedGradient(ScalarField<T, Cpu> q, const Store& store) const {
  const ClusterListView& list = pairs_->fluidList;
  forEachClusterOf(list, [&](std::uint32_t c) {
    const ClusterWalk<D, T> walk(*pairs_, list, c, position_.data(), fluidLanes_.data());
    LanesOf<T> sum[2][D] = {};
    const T* coefficient = pressure_.data() + pressureStart_[c] * clusterSize;
    walk.forEach(ListSegment::NearFluid, coefficient,
                 [&](int half, std::uint32_t j, const LanesOf<T>& g, const LanesOf<T>* d) {
                   const LanesOf<T> f = g * q[j];
                   LanesOf<T> fd[D];
                   for (int k = 0; k < D; ++k) fd[k] = f * d[k];
                   for (int k = 0; k < D; ++k) sum[half][k] += renormalisation_[j].row(k, fd);
                 });
    walk.forEach(ListSegment::NearWall, coefficient,
                 [&](int half, std::uint32_t j, const LanesOf<T>& g, const LanesOf<T>* d) {
                   const LanesOf<T> f = g * q[j];
                   for (int k = 0; k < D; ++k) sum[half][k] += f * d[k];
                 });
    const VectorSums<D, T> sums(sum);
    const T* own = &gradient_[std::size_t{D} * clusterSize * c];
    storeSums(*pairs_, walk.range, store, [&](std::size_t i, std::size_t lane) {
      Vec<D, T> total;
      for (int k = 0; k < D; ++k) total[k] = sums.at[k][lane] + own[k * clusterSize + lane] * q[i];
      return total;
    });
  });
}

template <int D, class T>
template <class Store>
void ParticleProducts<D, T, Cpu>::renormalisedDivergence(VectorField<D, T, Cpu> field, const Store& store) const {
  const Gathered<D, T>* u = field.at;
  forEachClusterOf(pairs_->fluidList, [&](std::uint32_t c) {
    const ClusterWalk<D, T> walk(*pairs_, pairs_->fluidList, c, position_.data(), fluidLanes_.data());
    LanesOf<T> ui[D];
    loadVectors(walk.range, u, ui);
    const T* coefficient = pressure_.data() + pressureStart_[c] * clusterSize;
    const auto b = loadBlocks<LanesOf<T>>(walk.range, renormalisation_.data());
    const VectorSums<1, T> sums = sumAlong<D, T>(walk, coefficient, u, ui, b);
    const T* walls = &wallGradient_[std::size_t{D} * clusterSize * c];
    storeSums(*pairs_, walk.range, store, [&](std::size_t i, std::size_t lane) {
      T total = -sums.at[0][lane];
      for (int k = 0; k < D; ++k) total += walls[k * clusterSize + lane] * u[i][k];
      return total;
    });
  });
  storeAtWalls<D, T>(*pairs_, position_.data(), wallLanes_.data(), wall_.data(), wallStart_.data(), u, store);
}

// With the stores of gradient(), divergence() and schur().
#define TREACLE_GRADIENT(D, T, ...) \
  template void ParticleProducts<D, T, Cpu>::renormalisedGradient(ScalarField<T, Cpu>, const __VA_ARGS__&) const;
#define TREACLE_DIVERGENCE(D, T, ...)                                                                           \
  template void ParticleProducts<D, T, Cpu>::renormalisedDivergence(VectorField<D, T, Cpu>, const __VA_ARGS__&) \
      const;
#define TREACLE_INSTANTIATE(D, T)                                    \
  template void ParticleProducts<D, T, Cpu>::renormalise();          \
  TREACLE_GRADIENT(D, T, StoreWeighted<D, T, Cpu>)                   \
  TREACLE_GRADIENT(D, T, StartVelocity<D, T>)                        \
  TREACLE_GRADIENT(D, T, FinishVelocity<D, T>)                       \
  TREACLE_DIVERGENCE(D, T, StartPressure<T, Cpu>)                    \
  TREACLE_DIVERGENCE(D, T, StorePressure<T, Cpu>)                    \
  TREACLE_DIVERGENCE(D, T, PressureStep<T, Cpu, StepKind::Residual>) \
  TREACLE_DIVERGENCE(D, T, PressureStep<T, Cpu, StepKind::Next>)     \
  TREACLE_DIVERGENCE(D, T, PressureStep<T, Cpu, StepKind::Last>)
TREACLE_INSTANTIATE(2, double)
TREACLE_INSTANTIATE(3, double)
TREACLE_INSTANTIATE(2, float)
TREACLE_INSTANTIATE(3, float)
#undef TREACLE_INSTANTIATE
#undef TREACLE_DIVERGENCE
#undef TREACLE_GRADIENT

}  // namespace treacle
