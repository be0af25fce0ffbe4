#include "packed_lanes.hpp"
#include "product_lanes.hpp"
#include "treacle/core/halo.hpp"
#include "treacle/precondition/projected_multigrid.hpp"

// The products with S' in single precision: C and C^T with their elements, B included, in few bits.

namespace treacle {
namespace {

template <int D>
using FloatPair = typename PackedElement<D>::FloatPair;

/// One number for the rows of each of two columns.
template <int D>
[[gnu::always_inline]] inline FloatPair<D> spread(float one, float other) {
  return generate<FloatPair<D>>([&](auto k) { return k < laneCount ? one : other; });
}

/// Sum of both halves, times a factor, lane by lane.
template <int D>
void storeHalves(const FloatPair<D>& sum, float factor, float* at) {
  float both[2 * laneCount];
  store(sum, both);
  for (int lane = 0; lane < laneCount; ++lane) at[lane] = factor * (both[lane] + both[laneCount + lane]);
}

/// d of the pairs of a cluster and a particle, one of them walls, across these.
template <int D>
VecLanes<D> acrossWall(const MphPairs<D>& pairs, const ClusterRange& range, std::uint32_t j, VecLanes<D> d) {
  const VecLanes<D> whole = d;
  takeAlongWall<D>(pairs, range, j, whole.v, d.v);
  return d;
}

/// Products of C^T with u: the divergence of eight particles.
template <int D>
void divergenceOf(const PackedRows& rows, std::uint32_t c, const Gathered<D, float>* u, float unit, float* at) {
  FloatPair<D> sum[D] = {};
  forEachPair<D>(rows, c, [&](std::uint32_t i, std::uint32_t j, const FloatPair<D>(&element)[D]) {
    for (int k = 0; k < D; ++k) sum[k] += element[k] * spread<D>(u[i][k], u[j][k]);
  });
  for (int k = 1; k < D; ++k) sum[0] += sum[k];
  storeHalves<D>(sum[0], unit, at);
}

}  // namespace

/// Takes the parts along walls out of the sums of g B d over walls and over all neighbours.
template <int D, class T>
void ParticleProducts<D, T, Cpu>::takeAlongWalls() {
  const ClusterListView& list = pairs_->fluidList;
  forEachClusterOf(list, [&](std::uint32_t c) {
    const SymmetricBlock<D, LanesOf<T>> b = loadBlocks<LanesOf<T>>(ClusterRange(list, c), renormalisation_.data());
    LanesOf<T> along[D] = {};
    const ClusterWalk<D, T> walk(*pairs_, list, c, position_.data(), fluidLanes_.data());
    const T* coefficient = pressure_.data() + pressureStart_[c] * clusterSize +
                           list.segment(c, ListSegment::NearFluid).size() * clusterSize;
    walk.forEach(ListSegment::NearWall, coefficient,
                 [&](int, std::uint32_t j, const LanesOf<T>& g, const LanesOf<T>(&d)[D]) {
                   LanesOf<T> whole[D], across[D];
                   for (int k = 0; k < D; ++k) whole[k] = across[k] = b.row(k, d);
                   takeAlongWall<D>(*pairs_, walk.range, j, d, across);
                   for (int k = 0; k < D; ++k) along[k] += g * (whole[k] - across[k]);
                 });
    for (Buffer<T>* gradient : {&gradient_, &wallGradient_}) {
      T* at = &(*gradient)[std::size_t{D} * clusterSize * c];
      LanesOf<T> v[D];
      for (int k = 0; k < D; ++k) v[k] = load<LanesOf<T>>(at + k * clusterSize);
      for (int k = 0; k < D; ++k) store<T>(v[k] - along[k], at + k * clusterSize);
    }
  });
}

template <int D, class T>
void ParticleProducts<D, T, Cpu>::pack() {
  using enum ListSegment;
  using Element = PackedElement<D>;
  const MphPairs<D>& pairs = *pairs_;
  unit_ = 0;
  if (isTooStiffToPack(pairs)) return;
  const double floor2 = distanceFloor2(pairs), unit = largestElement(pairs) / Element::largest;
  const auto gradient = gradientWithin(pairs, productReach<T>(pairs));
  unit_ = static_cast<T>(unit / Element::unitOfUnpacked);
  allocate(gradientRows_, pairs.fluidList, {NearFluid, NearWall});
  allocate(divergenceRows_, pairs.fluidList, {NearFluid});
  allocate(wallRows_, pairs.wallList, {NearFluid});
  withWalls([&]<bool, bool Smooth>() {
    forEachCluster<D>(pairs, pairs.fluidList,
                      [&](const ClusterRange& range, const ClusterPlaces<D>& x, std::uint32_t c) {
                        PackedWriter<D> columns(gradientRows_, c), divergence(divergenceRows_, c);
                        SymmetricBlock<D, Lanes> b = {};
                        if (pairs.renormalisation) b = loadBlocks<Lanes>(range, pairs.renormalisation);
                        for (ListSegment s : {NearFluid, NearWall})
                          for (std::uint32_t j : pairs.fluidList.segment(c, s)) {
                            const PairLanes<D> pair(pairs, j, x, floor2);
                            const Lanes g = gradient(pair.r) / unit;
                            if (Smooth && s == NearWall)
                              columns.add(j, Element::pack(acrossWall(pairs, range, j, pair.d), g));
                            else
                              columns.add(j, Element::pack(corrected(pairs, j, pair.d), g));
                            if (s == NearWall) continue;
                            VecLanes<D> bd = pair.d;
                            if (pairs.renormalisation)
                              for (int k = 0; k < D; ++k) bd[k] = b.row(k, pair.d);
                            divergence.add(j, Element::pack(bd, -g));
                          }
                      });
    forEachCluster<D>(
        pairs, pairs.wallList, [&](const ClusterRange& range, const ClusterPlaces<D>& x, std::uint32_t c) {
          PackedWriter<D> divergence(wallRows_, c);
          for (std::uint32_t j : pairs.wallList.segment(c, NearFluid)) {
            const PairLanes<D> pair(pairs, j, x, floor2);
            const Lanes g = -gradient(pair.r) / unit;
            divergence.add(j, Element::pack(Smooth ? acrossWall(pairs, range, j, pair.d) : pair.d, g));
          }
        });
  });
}

template <int D, class T>
template <class Store>
void ParticleProducts<D, T, Cpu>::packedSchur(const Context<Cpu>& context, const ProjectionTable<T>& table,
                                              ScalarField<T, Cpu> q, const Store& store) {
  const MphPairs<D>& pairs = *pairs_;
  fillGhosts(context, Held::Active, q.at);
  const StoreWeighted<D, T, Cpu> weighted{table, pairs.classOf(), vectors()};
  forEachClusterOf(pairs.fluidList, [&](std::uint32_t c) {
    FloatPair<D> sum[D] = {};
    forEachPair<D>(gradientRows_, c, [&](std::uint32_t i, std::uint32_t j, const FloatPair<D>(&element)[D]) {
      const FloatPair<D> both = spread<D>(q[i], q[j]);
      for (int k = 0; k < D; ++k) sum[k] += element[k] * both;
    });
    float at[D][clusterSize];
    for (int k = 0; k < D; ++k) storeHalves<D>(sum[k], unit_, at[k]);
    const float* own = &gradient_[std::size_t{D} * clusterSize * c];
    storeSums(pairs, ClusterRange(pairs.fluidList, c), weighted, [&](std::size_t i, std::size_t lane) {
      Vec<D, T> total;
      for (int k = 0; k < D; ++k) total[k] = at[k][lane] + own[k * clusterSize + lane] * q[i];
      return total;
    });
  });
  fillGhosts(context, Held::Fluid, vectors_.data());
  const Gathered<D, T>* u = vectors_.data();
  const auto ofFluid = [&](std::uint32_t c) {
    float at[clusterSize];
    divergenceOf(divergenceRows_, c, u, unit_, at);
    const float* own = &gradient_[std::size_t{D} * clusterSize * c];
    storeSums(pairs, ClusterRange(pairs.fluidList, c), store, [&](std::size_t i, std::size_t lane) {
      T total = at[lane];
      for (int k = 0; k < D; ++k) total += own[k * clusterSize + lane] * u[i][k];
      return total;
    });
  };
  const auto ofWalls = [&](std::uint32_t c) {
    const ClusterRange range(pairs.wallList, c);
    if (wallRows_.pairs[c] == 0)
      return storeSums(pairs, range, store, [](std::size_t, std::size_t) { return T(0); });
    float at[clusterSize];
    divergenceOf(wallRows_, c, u, unit_, at);
    storeSums(pairs, range, store, [&](std::size_t, std::size_t lane) { return at[lane]; });
  };
  // One loop instead of two: each cluster of fluid takes its share of those of walls along.
  const std::size_t fluid = pairs.fluidList.clusterCount(), walls = pairs.wallList.clusterCount();
  if (fluid == 0) forEachClusterOf(pairs.wallList, ofWalls);  // of a process that owns walls alone
  forEachClusterOf(pairs.fluidList, [&](std::uint32_t c) {
    ofFluid(c);
    for (std::size_t w = walls * c / fluid, end = walls * (c + std::size_t{1}) / fluid; w < end; ++w)
      ofWalls(static_cast<std::uint32_t>(w));
  });
}

#define TREACLE_SCHUR(D, ...)                                                                                    \
  template void ParticleProducts<D, float, Cpu>::packedSchur(const Context<Cpu>&, const ProjectionTable<float>&, \
                                                             ScalarField<float, Cpu>, const __VA_ARGS__&);
#define TREACLE_INSTANTIATE(D)                                     \
  template void ParticleProducts<D, float, Cpu>::pack();           \
  template void ParticleProducts<D, float, Cpu>::takeAlongWalls(); \
  TREACLE_SCHUR(D, PressureStep<float, Cpu, StepKind::Residual>)   \
  TREACLE_SCHUR(D, PressureStep<float, Cpu, StepKind::Next>)       \
  TREACLE_SCHUR(D, PressureStep<float, Cpu, StepKind::Last>)       \
  TREACLE_SCHUR(D, StorePressure<float, Cpu>)
TREACLE_INSTANTIATE(2)
TREACLE_INSTANTIATE(3)
#undef TREACLE_INSTANTIATE
#undef TREACLE_SCHUR

}  // namespace treacle
