#include "treacle/method/particle_products.hpp"

#include "pair_lanes.hpp"
#include "pair_scalar.hpp"

#include <limits>

namespace treacle {
namespace {

/// Eight numbers of the preconditioner's precision.
template <class T>
struct LaneType;
template <>
struct LaneType<double> {
  using type = Lanes;
};
template <>
struct LaneType<float> {
  using type = float __attribute__((vector_size(laneCount * sizeof(float))));
};
template <class T>
using LanesOf = typename LaneType<T>::type;

/// A particle meets itself at a 1/r so large that single precision may not hold its cube; the coefficient meets a
/// difference of zero and may be zero, too.
template <class T>
void storeCoefficient(Buffer<T>& values, std::uint64_t entry, const Lanes& lanes) {
  for (int k = 0; k < laneCount; ++k)
    values[entry * clusterSize + k] = lanes[k] < std::numeric_limits<T>::max() ? static_cast<T>(lanes[k]) : T(0);
}

template <class T>
LanesOf<T> loadCoefficient(const Buffer<T>& values, std::uint64_t entry) {
  LanesOf<T> lanes;
  std::memcpy(&lanes, values.data() + entry * clusterSize, sizeof(lanes));
  return lanes;
}

/// D components of eight particles.
template <int D, class T>
struct VectorLanes {
  LanesOf<T> c[D];

  template <class V>
  VectorLanes(const ClusterRange& range, const V* values) {
    for (std::uint32_t lane = 0; lane < clusterSize; ++lane)
      for (int k = 0; k < D; ++k) c[k][lane] = values[range.particle(lane)][k];
  }
};

/// Walks the lists of one cluster: positions relative to the neighbours in the precision of the products.
template <int D, class T>
class ClusterWalk {
 public:
  ClusterWalk(const MphPairs<D>& pairs, const ClusterListView& list, std::uint32_t cluster,
              const Vec<D, T>* position)
      : range(list, cluster),
        pairs_(pairs),
        list_(list),
        cluster_(cluster),
        position_(position),
        x_(range, position) {
    const Vec<D, T>& first = position[range.first];
    for (int k = 0; k < D; ++k)
      for (std::uint32_t lane = 1; pairs.grid.periodic[k] && lane < clusterSize; ++lane) {
        const T length = static_cast<T>(pairs.grid.length[k]);
        x_.c[k][lane] -= length * std::round((x_.c[k][lane] - first[k]) / length);
      }
  }

  /// Calls f(j, d) for the entries of a segment; d = x_j - x_i.
  template <class F>
  void forEach(ListSegment segment, F&& f) const {
    list_.wraps[cluster_] ? walk<true>(segment, f) : walk<false>(segment, f);
  }

  const ClusterRange range;

 private:
  template <bool Wraps, class F>
  void walk(ListSegment segment, F&& f) const {
    for (ListEntry e : list_.segment(cluster_, segment)) {
      const std::uint32_t j = Wraps ? e.index() : e.bits;
      LanesOf<T> d[D];
      for (int k = 0; k < D; ++k) {
        T xj = position_[j][k];
        if constexpr (Wraps) xj += static_cast<T>(pairs_.images.shift[e.image()][k]);
        d[k] = xj - x_.c[k];
      }
      f(j, d);
    }
  }

  const MphPairs<D>& pairs_;
  const ClusterListView& list_;
  std::uint32_t cluster_;
  const Vec<D, T>* position_;
  VectorLanes<D, T> x_;
};

template <class F>
void forEachClusterOf(const ClusterListView& list, F&& f) {
  parallelFor(list.clusterCount(), parallelGrain / clusterSize,
              [&](std::size_t c) { f(static_cast<std::uint32_t>(c)); });
}

template <int D, class T, class Store>
void storeVectors(const ClusterRange& range, const LanesOf<T>* sum, const Store& store) {
  for (std::uint32_t lane = 0; lane < range.count; ++lane) {
    Vec<D, T> v;
    for (int k = 0; k < D; ++k) v[k] = sum[k][lane];
    store(range.first + lane, v);
  }
}

/// Where the entries of each cluster's segments start, counted over clusters.
void countEntries(const ClusterListView& list, std::initializer_list<ListSegment> segments,
                  Buffer<std::uint64_t>& start) {
  start.resize(list.clusterCount() + 1);
  start[0] = 0;
  for (std::uint32_t c = 0; c < list.clusterCount(); ++c) {
    start[c + 1] = start[c];
    for (ListSegment s : segments) start[c + 1] += list.segment(c, s).size();
  }
}

}  // namespace

template <int D, class T>
void ParticleProducts<D, T, Cpu>::prepare(Context<Cpu>&, const MphPairs<D>& pairs, const WallTerms<D>& terms,
                                          const MphOperator<D, Cpu>&) {
  using enum ListSegment;
  pairs_ = &pairs;
  terms_ = terms;
  position_.resize(pairs.activeCount);
  for (std::uint32_t i = 0; i < pairs.activeCount; ++i)
    for (int k = 0; k < D; ++k) position_[i][k] = static_cast<T>(pairs.position[i][k] - pairs.grid.origin[k]);
  countEntries(pairs.fluidList, {NearFluid, FarFluid}, viscousStart_);
  countEntries(pairs.fluidList, {NearFluid, NearWall}, pressureStart_);
  countEntries(pairs.wallList, {NearFluid}, wallStart_);
  viscous_.resize(viscousStart_[pairs.fluidList.clusterCount()] * clusterSize);
  pressure_.resize(pressureStart_[pairs.fluidList.clusterCount()] * clusterSize);
  wall_.resize(wallStart_[pairs.wallList.clusterCount()] * clusterSize);
  selfBlock_.resize(pairs.fluidCount);
  scalars_.resize(pairs.activeCount);
  vectors_.resize(pairs.fluidCount);
  const double floor2 = distanceFloor2(pairs);

  forEachCluster<D>(pairs, pairs.fluidList, [&](const ClusterRange& range, const VecLanes<D>& x, std::uint32_t c) {
    const ViscosityLanes<D> viscosity(pairs, range);
    std::uint64_t nextViscous = viscousStart_[c], nextPressure = pressureStart_[c];
    Lanes self[D * D] = {};
    for (ListSegment s : {NearFluid, FarFluid, NearWall})
      for (ListEntry e : pairs.fluidList.segment(c, s)) {
        const PairLanes<D> pair(pairs.positionOf(e), x, floor2);
        if (s != FarFluid)
          storeCoefficient(pressure_, nextPressure++, pairs.pressure.factor * pair.reach(pairs.pressure));
        if (s == NearWall) continue;
        const Lanes f = viscosity.ofMaterial[pairs.material[e.index()]] * pair.reach(pairs.viscosity) *
                        pair.inverseR * pair.inverseR;
        storeCoefficient(viscous_, nextViscous++, f);
        for (int r = 0; r < D; ++r)
          for (int k = 0; k < D; ++k) self[r * D + k] += f * pair.d[r] * pair.d[k];
      }
    for (std::uint32_t lane = 0; lane < range.count; ++lane)
      for (int e = 0; e < D * D; ++e)
        selfBlock_[range.first + lane].a[e] = static_cast<T>(terms.block[range.first + lane].a[e] + self[e][lane]);
  });
  forEachCluster<D>(pairs, pairs.wallList, [&](const ClusterRange&, const VecLanes<D>& x, std::uint32_t c) {
    std::uint64_t next = wallStart_[c];
    for (ListEntry e : pairs.wallList.segment(c, NearFluid)) {
      const PairLanes<D> pair(pairs.positionOf(e), x, floor2);
      storeCoefficient(wall_, next++, pairs.pressure.factor * pair.reach(pairs.pressure));
    }
  });
}

template <int D, class T>
template <class Store>
void ParticleProducts<D, T, Cpu>::gradient(Context<Cpu>&, ScalarField<T, Cpu> q, const Store& store) const {
  const ClusterListView& list = pairs_->fluidList;
  forEachClusterOf(list, [&](std::uint32_t c) {
    const ClusterWalk<D, T> walk(*pairs_, list, c, position_.data());
    LanesOf<T> own, sum[D] = {};
    for (std::uint32_t lane = 0; lane < clusterSize; ++lane) own[lane] = q[walk.range.particle(lane)];
    std::uint64_t next = pressureStart_[c];
    const auto add = [&](std::uint32_t j, const LanesOf<T>* d) {
      const LanesOf<T> f = loadCoefficient(pressure_, next++) * (own + q[j]);
      for (int k = 0; k < D; ++k) sum[k] += f * d[k];
    };
    walk.forEach(ListSegment::NearFluid, add);
    walk.forEach(ListSegment::NearWall, add);
    storeVectors<D, T>(walk.range, sum, store);
  });
}

template <int D, class T>
template <class Store>
void ParticleProducts<D, T, Cpu>::divergence(Context<Cpu>&, VectorField<D, T, Cpu> field,
                                             const Store& store) const {
  const Gathered<D, T>* u = field.at;
  const auto storeSums = [&](const ClusterRange& range, const LanesOf<T>& sum) {
    for (std::uint32_t lane = 0; lane < range.count; ++lane) store(range.first + lane, -sum[lane]);
  };
  forEachClusterOf(pairs_->fluidList, [&](std::uint32_t c) {
    const ClusterWalk<D, T> walk(*pairs_, pairs_->fluidList, c, position_.data());
    const VectorLanes<D, T> own(walk.range, u);
    LanesOf<T> sum = {};
    std::uint64_t next = pressureStart_[c];
    walk.forEach(ListSegment::NearFluid, [&](std::uint32_t j, const LanesOf<T>* d) {
      LanesOf<T> along = (u[j][0] - own.c[0]) * d[0];
      for (int k = 1; k < D; ++k) along += (u[j][k] - own.c[k]) * d[k];
      sum += loadCoefficient(pressure_, next++) * along;
    });
    // Walls at rest: (0 - u_i).g summed over walls.
    for (std::uint32_t lane = 0; lane < walk.range.count; ++lane) {
      const std::uint32_t i = walk.range.first + lane;
      for (int k = 0; k < D; ++k) sum[lane] -= u[i][k] * static_cast<T>(terms_.gradient[i][k]);
    }
    storeSums(walk.range, sum);
  });
  forEachClusterOf(pairs_->wallList, [&](std::uint32_t c) {
    const ClusterWalk<D, T> walk(*pairs_, pairs_->wallList, c, position_.data());
    LanesOf<T> sum = {};
    std::uint64_t next = wallStart_[c];
    walk.forEach(ListSegment::NearFluid, [&](std::uint32_t j, const LanesOf<T>* d) {
      LanesOf<T> along = u[j][0] * d[0];
      for (int k = 1; k < D; ++k) along += u[j][k] * d[k];
      sum += loadCoefficient(wall_, next++) * along;
    });
    storeSums(walk.range, sum);
  });
}

template <int D, class T>
template <class Store>
void ParticleProducts<D, T, Cpu>::viscous(Context<Cpu>&, const Gathered<D, T>* u, const Store& store) const {
  const ClusterListView& list = pairs_->fluidList;
  forEachClusterOf(list, [&](std::uint32_t c) {
    const ClusterWalk<D, T> walk(*pairs_, list, c, position_.data());
    LanesOf<T> sum[D] = {};
    std::uint64_t next = viscousStart_[c];
    const auto add = [&](std::uint32_t j, const LanesOf<T>* d) {
      LanesOf<T> along = u[j][0] * d[0];
      for (int k = 1; k < D; ++k) along += u[j][k] * d[k];
      const LanesOf<T> f = loadCoefficient(viscous_, next++) * along;
      for (int k = 0; k < D; ++k) sum[k] += f * d[k];
    };
    walk.forEach(ListSegment::NearFluid, add);
    walk.forEach(ListSegment::FarFluid, add);
    storeVectors<D, T>(walk.range, sum, [&](std::uint32_t i, const Vec<D, T>& neighbours) {
      store(i, selfBlock_[i] * u[i] - neighbours);
    });
  });
}

template <int D, class T>
void ParticleProducts<D, T, Cpu>::inverseDiagonals(Context<Cpu>&, const ProjectionTable<T>& table,
                                                   std::span<T> pressure, std::span<Block<D, T>> velocity) const {
  parallelFor(pairs_->activeCount, parallelGrain, [&](std::size_t index) {
    const auto k = static_cast<std::uint32_t>(index);
    const bool fluid = k < pairs_->fluidCount;
    T sum = table.shift[pairs_->material[k]];
    Vec<D> own{};
    forEachNear(*pairs_, k, [&](std::uint32_t j, const Vec<D>& g) {
      own += g;
      if (j < pairs_->fluidCount) sum += table.weight[pairs_->material[j]] * static_cast<T>(norm2(g));
    });
    if (fluid) {
      sum += table.weight[pairs_->material[k]] * static_cast<T>(norm2(own));
      velocity[k] = inverse(selfBlock_[k]);
    }
    pressure[k] = 1 / sum;
  });
}

template <int D, class T>
void ParticleProducts<D, T, Cpu>::gather(Context<Cpu>&, std::span<const T> x) {
  std::copy(x.begin(), x.end(), scalars_.begin());
}

template <int D, class T>
void ParticleProducts<D, T, Cpu>::gather(Context<Cpu>&, std::span<const Gathered<D, T>> u) {
  std::copy(u.begin(), u.end(), vectors_.begin());
}

template <int D, class T>
void ParticleProducts<D, T, Cpu>::gatherWeighted(Context<Cpu>&, const ProjectionTable<T>& table,
                                                 std::span<const Vec<D>> u) {
  parallelFor(u.size(), parallelGrain, [&](std::size_t i) {
    for (int k = 0; k < D; ++k) vectors_[i][k] = table.weight[pairs_->material[i]] * static_cast<T>(u[i][k]);
  });
}

template <int D, class T>
std::size_t ParticleProducts<D, T, Cpu>::bytes() const {
  return scalars_.bytes() + vectors_.bytes() + position_.bytes() + viscousStart_.bytes() + pressureStart_.bytes() +
         wallStart_.bytes() + viscous_.bytes() + pressure_.bytes() + wall_.bytes() + selfBlock_.bytes();
}

#define TREACLE_GRADIENT(D, T, ...)                                                                           \
  template void ParticleProducts<D, T, Cpu>::gradient(Context<Cpu>&, ScalarField<T, Cpu>, const __VA_ARGS__&) \
      const;
#define TREACLE_DIVERGENCE(D, T, ...)                                                          \
  template void ParticleProducts<D, T, Cpu>::divergence(Context<Cpu>&, VectorField<D, T, Cpu>, \
                                                        const __VA_ARGS__&) const;
#define TREACLE_VISCOUS(D, T, ...)                                                                             \
  template void ParticleProducts<D, T, Cpu>::viscous(Context<Cpu>&, const Gathered<D, T>*, const __VA_ARGS__&) \
      const;
#define TREACLE_INSTANTIATE(D, T)             \
  template class ParticleProducts<D, T, Cpu>; \
  TREACLE_FOR_EACH_STORE(D, T, Cpu)
TREACLE_INSTANTIATE(2, double)
TREACLE_INSTANTIATE(3, double)
TREACLE_INSTANTIATE(2, float)
TREACLE_INSTANTIATE(3, float)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
