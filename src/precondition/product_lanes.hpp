#pragma once

#include "treacle/core/buffer.hpp"
#include "treacle/mph/mph_lanes.hpp"

#include <limits>

namespace treacle {

/// A particle meets itself at a 1/r so large that single precision may not hold its cube; the coefficient meets a
/// difference of zero and may be zero, too.
template <class T>
inline void storeCoefficient(Buffer<T>& values, std::uint64_t entry, const Lanes& lanes) {
  const Lanes kept = select(lanes < double{std::numeric_limits<T>::max()}, lanes, Lanes(0.0));
  store(convert<LanesOf<T>>(kept), &values[entry * clusterSize]);
}

/// -w'/r of eight pairs, zero from `reach` h_p on.
template <int D>
inline auto gradientWithin(const MphPairs<D>& pairs, double reach) {
  const double length = reach * pairs.terms.pressureRadius;
  return [&pairs, square = length * length](const PairDistance<Lanes>& r) {
    return select(r.square < square, pairs.terms.gradient(r), Lanes(0.0));
  };
}

/// Entries ahead whose coefficients are asked for: the memory takes longer than the arithmetic in between.
constexpr std::uint64_t prefetchDistance = 64;

/// Walks the lists of one cluster: coefficients, and positions relative to the neighbours, in the precision of the
/// products.
template <int D, class T>
class ClusterWalk {
 public:
  /// `lanes`: positions of all clusters, D times eight numbers each.
  ClusterWalk(const MphPairs<D>& pairs, const ClusterListView& list, std::uint32_t cluster,
              const Vec<D, T>* position, const T* lanes)
      : range(list, cluster), pairs_(pairs), list_(list), cluster_(cluster), position_(position) {
    for (int k = 0; k < D; ++k) x_[k] = load<LanesOf<T>>(lanes + (std::size_t{D} * cluster + k) * clusterSize);
  }

  /// Calls f(half, j, c, d) for the entries of a segment; c: the eight coefficients, d = x_j - x_i; `half`
  /// alternates between 0 and 1, so that two sums in turn hide the latency of the additions.
  /// Always inline: the sums are to stay in registers.
  template <class F>
  [[gnu::always_inline]] void forEach(ListSegment segment, const T*& coefficient, F&& f) const {
    list_.special[cluster_] ? walk<true>(segment, coefficient, f) : walk<false>(segment, coefficient, f);
  }

  const ClusterRange range;

 private:
  template <bool Wraps, class F>
  [[gnu::always_inline]] void walk(ListSegment segment, const T*& coefficient, F&& f) const {
    const std::span<const std::uint32_t> entries = list_.segment(cluster_, segment);
    const T* next = coefficient;
    const auto visit = [&](int half, std::uint32_t j) {
      LanesOf<T> d[D];
      for (int k = 0; k < D; ++k) d[k] = position_[j][k] - x_[k];
      if constexpr (Wraps) moveToNearest(pairs_.grid, d);
      __builtin_prefetch(next + prefetchDistance * clusterSize);
      f(half, j, load<LanesOf<T>>(next), d);
      next += clusterSize;
    };
    std::size_t p = 0;
    for (; p + 1 < entries.size(); p += 2) {
      visit(0, entries[p]);
      visit(1, entries[p + 1]);
    }
    if (p < entries.size()) visit(0, entries[p]);
    coefficient = next;
  }

  const MphPairs<D>& pairs_;
  const ClusterListView& list_;
  std::uint32_t cluster_;
  const Vec<D, T>* position_;
  LanesOf<T> x_[D];
};

template <class F>
inline void forEachClusterOf(const ClusterListView& list, F&& f) {
  parallelFor(list.clusterCount(), parallelGrain / clusterSize,
              [&] [[gnu::flatten]] (std::size_t c) { f(static_cast<std::uint32_t>(c)); });
}

/// f(lane) for the particles of a cluster, which are independent of each other: a full cluster as one vector.
template <class F>
inline void forEachLane(const ClusterRange& range, F&& f) {
  if (range.count == clusterSize) {
#pragma GCC ivdep
    for (std::size_t lane = 0; lane < clusterSize; ++lane) f(lane);
  } else {
    for (std::size_t lane = 0; lane < range.count; ++lane) f(lane);
  }
}

/// Stores the sums sumOf(i, lane). A single class is known before the loop and needs no look-up per particle.
/// `flatten`: the compiler vectorises only what it has inlined.
template <int D, class Store, class F>
[[gnu::flatten]] inline void storeSums(const MphPairs<D>& pairs, const ClusterRange& range, const Store& store,
                                       F&& sumOf) {
  const std::size_t first = range.first;
  if (pairs.isOneClass())
    forEachLane(range, [&](std::size_t lane) { store.put(first + lane, sumOf(first + lane, lane), 0); });
  else
    forEachLane(range, [&](std::size_t lane) {
      store.put(first + lane, sumOf(first + lane, lane), pairs.classOf()[first + lane]);
    });
}

/// The sum of both halves, lane by lane.
template <int D, class T>
struct VectorSums {
  T at[D][clusterSize];

  explicit VectorSums(const LanesOf<T> (&sum)[2][D]) {
    for (int k = 0; k < D; ++k) store(sum[0][k] + sum[1][k], at[k]);
  }
  Vec<D, T> operator[](std::size_t lane) const {
    Vec<D, T> v;
    for (int k = 0; k < D; ++k) v[k] = at[k][lane];
    return v;
  }
};

/// The vectors of a cluster's particles, lane by lane.
template <int D, class T>
inline void loadVectors(const ClusterRange& range, const Gathered<D, T>* u, LanesOf<T> (&lanes)[D]) {
  for (int k = 0; k < D; ++k)
    if (range.count == clusterSize) {
      const Gathered<D, T>* first = u + range.first;
      lanes[k] = generate<LanesOf<T>>([&](auto lane) { return first[lane][k]; });
    } else {
      lanes[k] = generate<LanesOf<T>>([&](auto lane) { return u[range.particle(lane)][k]; });
    }
}

/// Sum of g along(j, d) over near fluid.
template <int D, class T, class Along>
[[gnu::always_inline]] inline VectorSums<1, T> sumOverFluid(const ClusterWalk<D, T>& walk, const T* coefficient,
                                                            Along&& along) {
  LanesOf<T> sum[2][1] = {};
  walk.forEach(ListSegment::NearFluid, coefficient,
               [&](int half, std::uint32_t j, const LanesOf<T>& g, const LanesOf<T>(&d)[D]) {
                 sum[half][0] += g * along(j, d);
               });
  return VectorSums<1, T>(sum);
}

}  // namespace treacle
