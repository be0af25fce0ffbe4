#include "treacle/precondition/particle_products.hpp"

#include "product_lanes.hpp"
#include "treacle/core/halo.hpp"
#include "treacle/mph/mph_neighbours.hpp"

#include <numeric>

namespace treacle {
namespace {

/// Positions of the clusters of a list.
template <int D, class T>
void positionLanes(const ClusterListView& list, const Buffer<Vec<D, T>>& position, Buffer<T>& lanes) {
  lanes.resize(std::size_t{D} * clusterSize * list.clusterCount());
  parallelFor(list.clusterCount(), parallelGrain / clusterSize, [&](std::size_t c) {
    const ClusterRange range(list, static_cast<std::uint32_t>(c));
    for (std::uint32_t lane = 0; lane < clusterSize; ++lane)
      for (int k = 0; k < D; ++k) lanes[(c * D + k) * clusterSize + lane] = position[range.particle(lane)][k];
  });
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
  for (Buffer<T>& field : scalars_) field.resize(pairs.activeCount);
  vectors_.resize(pairs.fluidCount);
  positionLanes(pairs.fluidList, position_, fluidLanes_);
  positionLanes(pairs.wallList, position_, wallLanes_);
  const double floor2 = distanceFloor2(pairs);
  const auto gradient = gradientWithin(pairs, productReach<T>(pairs));

  forEachCluster<D>(pairs, pairs.fluidList,
                    [&](const ClusterRange& range, const ClusterPlaces<D>& x, std::uint32_t c) {
                      const ViscosityLanes<D> viscosity(pairs, range);
                      std::uint64_t nextViscous = viscousStart_[c], nextPressure = pressureStart_[c];
                      Lanes self[D * D] = {};
                      for (ListSegment s : {NearFluid, FarFluid, NearWall})
                        for (std::uint32_t j : pairs.fluidList.segment(c, s)) {
                          const PairLanes<D> pair(pairs, j, x, floor2);
                          if (s != FarFluid) storeCoefficient(pressure_, nextPressure++, gradient(pair.r));
                          if (s == NearWall) continue;
                          const Lanes f = pairs.terms.viscous(viscosity.with(j), pair.r);
                          storeCoefficient(viscous_, nextViscous++, f);
                          for (int r = 0; r < D; ++r)
                            for (int k = 0; k < D; ++k) self[r * D + k] += f * pair.d[r] * pair.d[k];
                        }
                      for (std::uint32_t lane = 0; lane < range.count; ++lane)
                        for (int e = 0; e < D * D; ++e)
                          selfBlock_[range.first + lane].a[e] =
                              static_cast<T>(terms.block[range.first + lane].a[e] + self[e][lane]);
                    });
  forEachCluster<D>(pairs, pairs.wallList, [&](const ClusterRange&, const ClusterPlaces<D>& x, std::uint32_t c) {
    std::uint64_t next = wallStart_[c];
    for (std::uint32_t j : pairs.wallList.segment(c, NearFluid)) {
      const PairLanes<D> pair(pairs, j, x, floor2);
      storeCoefficient(wall_, next++, gradient(pair.r));
    }
  });
  sumGradients();
  if (pairs.renormalisation) renormalise();
  if constexpr (packed) pack();
}

/// Sums of g d over walls, which meet the particle's own velocity, and over all neighbours, which meet its own
/// pressure: neither need be added per pair.
template <int D, class T>
void ParticleProducts<D, T, Cpu>::sumGradients() {
  const ClusterListView& list = pairs_->fluidList;
  gradient_.resize(fluidLanes_.size());
  wallGradient_.resize(fluidLanes_.size());
  forEachClusterOf(list, [&](std::uint32_t c) {
    const ClusterWalk<D, T> walk(*pairs_, list, c, position_.data(), fluidLanes_.data());
    LanesOf<T> fluid[D] = {}, walls[D] = {};
    const T* coefficient = pressure_.data() + pressureStart_[c] * clusterSize;
    const auto addTo = [&](LanesOf<T>* sum) {
      return [sum](int, std::uint32_t, const LanesOf<T>& g, const LanesOf<T>* d) {
        for (int k = 0; k < D; ++k) sum[k] += g * d[k];
      };
    };
    walk.forEach(ListSegment::NearFluid, coefficient, addTo(fluid));
    walk.forEach(ListSegment::NearWall, coefficient, addTo(walls));
    for (int k = 0; k < D; ++k) {
      const LanesOf<T> all = fluid[k] + walls[k];
      const std::size_t at = (std::size_t{D} * c + k) * clusterSize;
      store(walls[k], &wallGradient_[at]);
      store(all, &gradient_[at]);
    }
  });
}

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
  if constexpr (packed)
    if (hasSmoothWalls()) takeAlongWalls();
}

template <int D, class T>
template <class Store>
void ParticleProducts<D, T, Cpu>::gradient(Context<Cpu>& context, ScalarField<T, Cpu> q,
                                           const Store& store) const {
  fillGhosts(context, Held::Active, q.at);
  withWalls([&]<bool Renormalised, bool Smooth>() {
    const ClusterListView& list = pairs_->fluidList;
    forEachClusterOf(list, [&](std::uint32_t c) {
      const ClusterWalk<D, T> walk(*pairs_, list, c, position_.data(), fluidLanes_.data());
      LanesOf<T> sum[2][D] = {};
      const T* coefficient = pressure_.data() + pressureStart_[c] * clusterSize;
      const auto addFrom = [&](auto wall) {
        return [&](int half, std::uint32_t j, const LanesOf<T>& g, const LanesOf<T>(&d)[D]) {
          const LanesOf<T> f = g * q[j];
          LanesOf<T> fd[D];
          for (int k = 0; k < D; ++k) fd[k] = f * d[k];
          if constexpr (Smooth && decltype(wall)::value) takeAlongWall<D>(*pairs_, walk.range, j, d, fd);
          for (int k = 0; k < D; ++k) {
            if constexpr (Renormalised && !decltype(wall)::value)
              sum[half][k] += renormalisation_[j].row(k, fd);
            else
              sum[half][k] += fd[k];
          }
        };
      };
      walk.forEach(ListSegment::NearFluid, coefficient, addFrom(std::false_type{}));
      walk.forEach(ListSegment::NearWall, coefficient, addFrom(std::true_type{}));
      const VectorSums<D, T> sums(sum);
      const T* own = &gradient_[std::size_t{D} * clusterSize * c];
      storeSums(*pairs_, walk.range, store, [&](std::size_t i, std::size_t lane) {
        Vec<D, T> total;
        for (int k = 0; k < D; ++k) total[k] = sums.at[k][lane] + own[k * clusterSize + lane] * q[i];
        return total;
      });
    });
  });
}

/// The differences of velocities are formed pair by pair, because that of a rigid motion must vanish to the last
/// bit: the bulk viscosity would amplify the rest. Walls rest, and have no B.
template <int D, class T>
template <class Store>
void ParticleProducts<D, T, Cpu>::divergence(Context<Cpu>& context, VectorField<D, T, Cpu> field,
                                             const Store& store) const {
  fillGhosts(context, Held::Fluid, field.at);
  const Gathered<D, T>* u = field.at;
  withRenormalisation(*pairs_, [&]<bool Renormalised>() {
    forEachClusterOf(pairs_->fluidList, [&](std::uint32_t c) {
      const ClusterWalk<D, T> walk(*pairs_, pairs_->fluidList, c, position_.data(), fluidLanes_.data());
      LanesOf<T> ui[D];
      loadVectors(walk.range, u, ui);
      SymmetricBlock<D, LanesOf<T>> b = {};
      if constexpr (Renormalised) b = loadBlocks<LanesOf<T>>(walk.range, renormalisation_.data());
      const auto along = [&](std::uint32_t j, const LanesOf<T>* d) {
        LanesOf<T> sum = {};
        for (int k = 0; k < D; ++k) {
          if constexpr (Renormalised)
            sum += (u[j][k] - ui[k]) * b.row(k, d);
          else
            sum += (u[j][k] - ui[k]) * d[k];
        }
        return sum;
      };
      const VectorSums<1, T> sums = sumOverFluid(walk, pressure_.data() + pressureStart_[c] * clusterSize, along);
      const T* walls = &wallGradient_[std::size_t{D} * clusterSize * c];
      storeSums(*pairs_, walk.range, store, [&](std::size_t i, std::size_t lane) {
        T total = -sums.at[0][lane];
        for (int k = 0; k < D; ++k) total += walls[k * clusterSize + lane] * u[i][k];
        return total;
      });
    });
  });
  const ClusterListView& walls = pairs_->wallList;
  withWalls([&]<bool, bool Smooth>() {
    forEachClusterOf(walls, [&](std::uint32_t c) {
      if (walls.segment(c, ListSegment::NearFluid).empty())
        return storeSums(*pairs_, ClusterRange(walls, c), store, [](std::size_t, std::size_t) { return T(0); });
      const ClusterWalk<D, T> walk(*pairs_, walls, c, position_.data(), wallLanes_.data());
      const auto along = [&](std::uint32_t j, const LanesOf<T>(&d)[D]) {
        LanesOf<T> sum = {};
        if constexpr (Smooth) {
          LanesOf<T> row[D];
          for (int k = 0; k < D; ++k) row[k] = d[k];
          takeAlongWall<D>(*pairs_, walk.range, j, d, row);
          for (int k = 0; k < D; ++k) sum += u[j][k] * row[k];
        } else {
          for (int k = 0; k < D; ++k) sum += u[j][k] * d[k];
        }
        return sum;
      };
      const VectorSums<1, T> sums = sumOverFluid(walk, wall_.data() + wallStart_[c] * clusterSize, along);
      storeSums(*pairs_, walk.range, store, [&](std::size_t, std::size_t lane) { return -sums.at[0][lane]; });
    });
  });
}

template <int D, class T>
template <class Store>
void ParticleProducts<D, T, Cpu>::schur(Context<Cpu>& context, const ProjectionTable<T>& table,
                                        ScalarField<T, Cpu> q, const Store& store) {
  if constexpr (packed)
    if (unit_ > 0) return packedSchur(context, table, q, store);
  gradient(context, q, StoreWeighted<D, T, Cpu>{table, pairs_->classOf(), vectors()});
  divergence(context, vectors(), store);
}

template <int D, class T>
template <class Store>
void ParticleProducts<D, T, Cpu>::viscous(Context<Cpu>& context, Gathered<D, T>* u, const Store& store) const {
  fillGhosts(context, Held::Fluid, u);
  const ClusterListView& list = pairs_->fluidList;
  forEachClusterOf(list, [&](std::uint32_t c) {
    const ClusterWalk<D, T> walk(*pairs_, list, c, position_.data(), fluidLanes_.data());
    LanesOf<T> sum[2][D] = {};
    const T* coefficient = viscous_.data() + viscousStart_[c] * clusterSize;
    const auto add = [&](int half, std::uint32_t j, const LanesOf<T>& v, const LanesOf<T>* d) {
      LanesOf<T> along = u[j][0] * d[0];
      for (int k = 1; k < D; ++k) along += u[j][k] * d[k];
      const LanesOf<T> f = v * along;
      for (int k = 0; k < D; ++k) sum[half][k] += f * d[k];
    };
    walk.forEach(ListSegment::NearFluid, coefficient, add);
    walk.forEach(ListSegment::FarFluid, coefficient, add);
    const VectorSums<D, T> sums(sum);
    storeSums(*pairs_, walk.range, store, [&](std::size_t i, std::size_t lane) {
      return selfBlock_[i] * static_cast<const Vec<D, T>&>(u[i]) - sums[lane];
    });
  });
}

template <int D, class T>
void ParticleProducts<D, T, Cpu>::inverseDiagonals(Context<Cpu>&, const ProjectionTable<T>& table,
                                                   std::span<T> pressure, std::span<Block<D, T>> velocity) const {
  const std::uint8_t* material = pairs_->classOf();
  std::fill(pressure.begin() + pairs_->ownFluid(), pressure.begin() + pairs_->fluidCount, T(0));
  std::fill(pressure.begin() + pairs_->ownEnd(), pressure.end(), T(0));
  const auto sumSquares = [&](const ClusterWalk<D, T>& walk, const T* coefficient, auto&& product) {
    LanesOf<T> sum = {};
    walk.forEach(ListSegment::NearFluid, coefficient,
                 [&](int, std::uint32_t j, const LanesOf<T>& g, const LanesOf<T>* d) {
                   LanesOf<T> square = {};
                   for (int k = 0; k < D; ++k) {
                     const LanesOf<T> c = g * product(k, d);
                     square += c * c;
                   }
                   sum += table.weight[material[j]] * square;
                 });
    return sum;
  };
  forEachClusterOf(pairs_->fluidList, [&](std::uint32_t c) {
    const ClusterWalk<D, T> walk(*pairs_, pairs_->fluidList, c, position_.data(), fluidLanes_.data());
    const T *coefficient = pressure_.data() + pressureStart_[c] * clusterSize,
            *own = &gradient_[std::size_t{D} * clusterSize * c];
    LanesOf<T> sum;
    if (pairs_->renormalisation) {
      const auto b = loadBlocks<LanesOf<T>>(walk.range, renormalisation_.data());
      sum = sumSquares(walk, coefficient, [&](int k, const LanesOf<T>* d) { return b.row(k, d); });
    } else {
      sum = sumSquares(walk, coefficient, [](int k, const LanesOf<T>* d) { return d[k]; });
    }
    for (std::uint32_t lane = 0; lane < walk.range.count; ++lane) {
      const std::uint32_t i = walk.range.first + lane;
      T square = 0;
      for (int k = 0; k < D; ++k) square += own[k * clusterSize + lane] * own[k * clusterSize + lane];
      pressure[i] = 1 / (table.shift[material[i]] + sum[lane] + table.weight[material[i]] * square);
      velocity[i] = inverse(selfBlock_[i]);
    }
  });
  forEachClusterOf(pairs_->wallList, [&](std::uint32_t c) {
    const ClusterWalk<D, T> walk(*pairs_, pairs_->wallList, c, position_.data(), wallLanes_.data());
    const LanesOf<T> sum = sumSquares(walk, wall_.data() + wallStart_[c] * clusterSize,
                                      [](int k, const LanesOf<T>* d) { return d[k]; });
    for (std::uint32_t lane = 0; lane < walk.range.count; ++lane) {
      const std::uint32_t k = walk.range.first + lane;
      pressure[k] = 1 / (table.shiftOf(k, material[k]) + sum[lane]);
    }
  });
}

template <int D, class T>
void ParticleProducts<D, T, Cpu>::resistingViscosity(Context<Cpu>& context, double resistance,
                                                     std::span<double> viscosity) const {
  parallelFor(pairs_->ownFluid(), parallelGrain, [&](std::size_t i) {
    viscosity[i] =
        treacle::resistingViscosity(selfBlock_[i], pairs_->inertia(static_cast<std::uint32_t>(i)), resistance);
  });
  fillGhosts(context, Held::Fluid, viscosity.data());
}

template <int D, class T>
void ParticleProducts<D, T, Cpu>::gather(Context<Cpu>&, std::span<const T> x) {
  std::copy(x.begin(), x.end(), scalars_[0].begin());
}

template <int D, class T>
void ParticleProducts<D, T, Cpu>::gather(Context<Cpu>&, std::span<const Gathered<D, T>> u) {
  std::copy(u.begin(), u.end(), vectors_.begin());
}

template <int D, class T>
void ParticleProducts<D, T, Cpu>::gatherWeighted(Context<Cpu>&, const ProjectionTable<T>& table,
                                                 std::span<const Vec<D>> u) {
  parallelFor(u.size(), parallelGrain, [&](std::size_t i) {
    for (int k = 0; k < D; ++k) vectors_[i][k] = table.weight[pairs_->classOf()[i]] * static_cast<T>(u[i][k]);
  });
}

template <int D, class T>
std::size_t ParticleProducts<D, T, Cpu>::bytes() const {
  return scalars_[0].bytes() + scalars_[1].bytes() + vectors_.bytes() + position_.bytes() + viscousStart_.bytes() +
         pressureStart_.bytes() + wallStart_.bytes() + viscous_.bytes() + pressure_.bytes() + wall_.bytes() +
         selfBlock_.bytes() + renormalisation_.bytes() + fluidLanes_.bytes() + wallLanes_.bytes() +
         gradient_.bytes() + wallGradient_.bytes() + gradientRows_.bytes() + divergenceRows_.bytes() +
         wallRows_.bytes();
}

template <int D, class T>
typename ParticleProducts<D, T, Cpu>::PackedPairs ParticleProducts<D, T, Cpu>::packedPairs() const {
  const auto sum = [](const PackedRows& rows) {
    return std::accumulate(rows.pairs.begin(), rows.pairs.end(), 0.0);
  };
  return {sum(gradientRows_), sum(divergenceRows_) + sum(wallRows_)};
}

#define TREACLE_GRADIENT(D, T, ...)                                                                           \
  template void ParticleProducts<D, T, Cpu>::gradient(Context<Cpu>&, ScalarField<T, Cpu>, const __VA_ARGS__&) \
      const;
#define TREACLE_DIVERGENCE(D, T, ...)                                                          \
  template void ParticleProducts<D, T, Cpu>::divergence(Context<Cpu>&, VectorField<D, T, Cpu>, \
                                                        const __VA_ARGS__&) const;
#define TREACLE_SCHUR(D, T, ...)                                                                                  \
  template void ParticleProducts<D, T, Cpu>::schur(Context<Cpu>&, const ProjectionTable<T>&, ScalarField<T, Cpu>, \
                                                   const __VA_ARGS__&);
#define TREACLE_VISCOUS(D, T, ...) \
  template void ParticleProducts<D, T, Cpu>::viscous(Context<Cpu>&, Gathered<D, T>*, const __VA_ARGS__&) const;
#define TREACLE_INSTANTIATE(D, T)             \
  template class ParticleProducts<D, T, Cpu>; \
  TREACLE_FOR_EACH_STORE(D, T, Cpu)
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
