#pragma once

#include "core/launch.hpp"
#include "mph/cluster_walk.cuh"
#include "mph/local_positions.cuh"

namespace treacle {

/// Adds up v[0 … N-1] over the lanes of each group of N (a power of two): afterwards lane n of the group holds the
/// sum of v[n]. N - 1 exchanges instead of N log N.
template <int N, class T>
__device__ inline T transposedSum(const T* v) {
  if constexpr (N == 1) {
    return v[0];
  } else {
    constexpr int half = N / 2;
    const bool upper = threadIdx.x & half;
    T kept[half];
#pragma unroll
    for (int m = 0; m < half; ++m) {
      const T give = upper ? v[m] : v[m + half];
      kept[m] = (upper ? v[m + half] : v[m]) + __shfl_xor_sync(~0u, give, half);
    }
    return transposedSum<half>(kept);
  }
}

/// Sums of pair terms over the neighbours of one cluster. `Terms` gives
///   Own loadOwn(pairs, i), Other loadOther(pairs, j)   what they read of a particle
///   values                                             how many sums a particle has
///   uses(segment)                                      which parts of the lists count
///   add(pairs, sums, d, distance, own, other, segment)
///   store(pairs, i, n, sum)                            called once per particle and sum
/// or, with a type StoresVectors, store(pairs, i, sums) once per particle, `sums` being a vector, or, with
/// StoresAll, an array; and, where they want what LocalPositions has stored of a particle, loadOther(pairs, j,
/// stored).
template <class Terms>
inline constexpr bool storesVectors = requires {
  typename Terms::StoresVectors;
};
template <class Terms>
inline constexpr bool storesAll = requires {
  typename Terms::StoresAll;
};

template <class Terms, int D, class Stored>
concept ReadsStored = requires(const Terms& terms, const MphPairs<D>& pairs, std::uint32_t j,
                               const Stored& stored) {
  terms.loadOther(pairs, j, stored);
};

/// Square of the distance of a pair that a thin sheet parts: all terms are zero at it, whatever the unit.
template <class T>
inline constexpr T partedDistance2 = 1e30;
struct Nothing {};

template <int D, class T, class S, class Terms>
class ClusterSum {
 public:
  static constexpr int values = Terms::values;
  static constexpr int sums = S::own * values;

  __device__ ClusterSum(const MphPairs<D>& pairs, const ClusterListView& list, std::uint32_t cluster)
      : pairs_(pairs),
        list_(list),
        cluster_(cluster),
        first_(list.first + clusterSize * cluster),
        count_(min(clusterSize, list.last - first_)) {}

  /// `part`: which of the cluster's warps this is; `exchange`: room for the sums of the block's lanes.
  __device__ void run(const Terms& terms, const LocalPositions<D, T>& places, int part, T (*exchange)[32]) const {
    const int lane = threadIdx.x % 32, group = lane / S::slots, slot = lane % S::slots;
    const auto origin = places.of(pairs_, first_);
    const Vec<D, T> mine = places.local(places.of(pairs_, particle(lane % clusterSize)), origin);
    const bool special = S::ranges || list_.special[cluster_];
    const bool apart = __any_sync(~0u, places.imagesMayDiffer(mine, special)) || (pairs_.side && special);
    Vec<D, T> x[S::own];
    typename Terms::Own own[S::own];
    T sum[paddedSums] = {};
#pragma unroll
    for (int t = 0; t < S::own; ++t) {
      for (int k = 0; k < D; ++k) x[t][k] = __shfl_sync(~0u, mine[k], group * S::own + t);
      own[t] = terms.loadOwn(pairs_, particle(group * S::own + t));
    }
    const auto walk = [&](auto kind) {
      constexpr bool isApart = decltype(kind)::value;
      struct Loaded {
        typename LocalPositions<D, T>::Stored x;
        typename Terms::Other other;
        std::conditional_t<isApart, std::uint32_t, Nothing> side;
      };
      const auto load = [&](std::uint32_t j) {
        const auto stored = places.of(pairs_, j);
        Loaded loaded{stored, otherOf(terms, j, stored), {}};
        if constexpr (isApart)
          if (pairs_.side) loaded.side = pairs_.side[j];
        return loaded;
      };
      const auto add = [&](const Loaded& loaded, ListSegment segment) {
        const Vec<D, T> local = places.local(loaded.x, origin);
#pragma unroll
        for (int t = 0; t < S::own; ++t) {
          Vec<D, T> d = local - x[t];
          if (isApart) d = places.nearest(pairs_, d);
          T r2 = places.floor;
          for (int k = 0; k < D; ++k) r2 = fma(d[k], d[k], r2);
          if constexpr (isApart)
            if (pairs_.side && !sides::seeEachOther(pairs_.side[particle(group * S::own + t)], loaded.side))
              r2 = partedDistance2<T>;
          terms.add(pairs_, &sum[t * values], d, PairDistance<T>{r2, inverseSqrt(r2)}, own[t], loaded.other,
                    segment);
        }
      };
      if constexpr (S::ranges) {
        const bool fluid =
            walkRanges<Terms, S>(pairs_, first_, count_, [&](std::uint32_t j, ListSegment s) { add(load(j), s); });
        if (first_ >= pairs_.fluidCount && !fluid)  // lists leave such walls out
          for (T& value : sum) value = 0;
      } else {
        walkLists<Terms, S>(list_, cluster_, slot + S::slots * part, load, add);
      }
    };
    // A loop of its own: the other one has its registers for itself.
    if (apart)
      walk(std::true_type{});
    else
      walk(std::false_type{});
    store(terms, sum, part, exchange);
  }

 private:
  /// Sums of one lane, filled up to a multiple of the group's lanes.
  static constexpr int rounds = (sums + S::slots - 1) / S::slots;
  static constexpr int paddedSums = rounds * S::slots;

  template <class Stored>
  __device__ typename Terms::Other otherOf(const Terms& terms, std::uint32_t j, const Stored& stored) const {
    if constexpr (ReadsStored<Terms, D, Stored>)
      return terms.loadOther(pairs_, j, stored);
    else
      return terms.loadOther(pairs_, j);
  }
  __device__ std::uint32_t particle(int own) const {
    return first_ + min(static_cast<std::uint32_t>(own), count_ - 1);
  }

  __device__ void store(const Terms& terms, T (&sum)[paddedSums], int part, T (*exchange)[32]) const {
    const int lane = threadIdx.x % 32, group = lane / S::slots, slot = lane % S::slots;
    T total[rounds];  // of the lane's slot
#pragma unroll
    for (int r = 0; r < rounds; ++r) {
      total[r] = transposedSum<S::slots>(&sum[r * S::slots]);
      if constexpr (S::warps > 1) {
        const int warp = threadIdx.x / 32;
        __syncthreads();
        exchange[warp][lane] = total[r];
        __syncthreads();
        total[r] = 0;
        for (int w = 0; w < S::warps; ++w) total[r] += exchange[warp - part + w][lane];
      }
    }
    if (part != 0) return;
    if constexpr (storesVectors<Terms> || storesAll<Terms>) {
      std::conditional_t<storesAll<Terms>, T[values], Vec<values, T>> all;
#pragma unroll
      for (int c = 0; c < values; ++c) {
        const int n = slot * values + c;  // of particle `slot` of the group
#pragma unroll
        for (int r = 0; r < rounds; ++r) {
          const T there = __shfl_sync(~0u, total[r], group * S::slots + n % S::slots);
          if (n / S::slots == r) all[c] = there;
        }
      }
      const std::uint32_t own = group * S::own + slot;
      if (slot < S::own && own < count_) terms.store(pairs_, first_ + own, all);
    } else {
#pragma unroll
      for (int r = 0; r < rounds; ++r) {
        const int n = r * S::slots + slot;
        const std::uint32_t own = group * S::own + n / values;
        if (n < sums && own < count_) terms.store(pairs_, first_ + own, n % values, total[r]);
      }
    }
  }

  const MphPairs<D>& pairs_;
  const ClusterListView& list_;
  std::uint32_t cluster_, first_, count_;
};

/// Blocks that a multiprocessor is to hold at once: bounds the registers of a thread.
template <class T, class S>
inline constexpr int residentBlocks = (std::is_same_v<T, double> ? 16 : 24) / S::warpsPerBlock;

/// A list and what is to be added up over it.
template <class Terms>
struct ListTask {
  ClusterListView list;
  Terms terms;

  template <class S>
  TREACLE_HD unsigned blocks() const {
    return (list.clusterCount() + S::clustersPerBlock - 1) / S::clustersPerBlock;
  }
};

template <int D, class T, class S, class Terms>
__device__ inline void sumOverList(const MphPairs<D>& pairs, const ListTask<Terms>& task, unsigned block,
                                   const LocalPositions<D, T>& places) {
  __shared__ T exchange[S::warpsPerBlock][32];
  const int warp = threadIdx.x / 32;
  const std::uint32_t cluster = block * S::clustersPerBlock + warp / S::warps;
  if (cluster < task.list.clusterCount())
    ClusterSum<D, T, S, Terms>(pairs, task.list, cluster).run(task.terms, places, warp % S::warps, exchange);
}

/// Warps share clusters as S says. Reads positions, lists and what the terms read of both particles of a pair;
/// writes what the terms store. No atomics.
template <int D, class T, class S, class Terms>
__global__ void __launch_bounds__(32 * S::warpsPerBlock, residentBlocks<T, S>)
    clusterSumKernel(const __grid_constant__ MphPairs<D> pairs, const __grid_constant__ ListTask<Terms> task,
                     const __grid_constant__ LocalPositions<D, T> places) {
  waitForEarlierKernels();
  sumOverList<D, T, S>(pairs, task, blockIdx.x, places);
}

/// The same for two lists at once: first the clusters of a, then those of b.
template <int D, class T, class S, class A, class B>
__global__ void __launch_bounds__(32 * S::warpsPerBlock, residentBlocks<T, S>)
    clusterSumsKernel(const __grid_constant__ MphPairs<D> pairs, const __grid_constant__ ListTask<A> a,
                      const __grid_constant__ ListTask<B> b, const __grid_constant__ LocalPositions<D, T> places) {
  waitForEarlierKernels();
  const unsigned blocksOfA = a.template blocks<S>();
  if (blockIdx.x < blocksOfA)
    sumOverList<D, T, S>(pairs, a, blockIdx.x, places);
  else
    sumOverList<D, T, S>(pairs, b, blockIdx.x - blocksOfA, places);
}

template <int D, class T, class S, class Terms>
void launchClusterSums(Context<Cuda>& context, const MphPairs<D>& pairs, const ListTask<Terms>& task,
                       const LocalPositions<D, T>& places) {
  launchEarly(context, task.template blocks<S>(), 32 * S::warpsPerBlock, 0, clusterSumKernel<D, T, S, Terms>,
              pairs, task, places);
}

template <int D, class T, class S, class A, class B>
void launchClusterSums(Context<Cuda>& context, const MphPairs<D>& pairs, const ListTask<A>& a,
                       const ListTask<B>& b, const LocalPositions<D, T>& places) {
  launchEarly(context, a.template blocks<S>() + b.template blocks<S>(), 32 * S::warpsPerBlock, 0,
              clusterSumsKernel<D, T, S, A, B>, pairs, a, b, places);
}

/// Systems with fewer clusters share each of them among four warps.
inline constexpr std::uint32_t fewClusters = 3000;

/// Calls f(Sharing) with what suits the lists of the pairs.
template <int D, class F>
void withListSharing(const MphPairs<D>& pairs, F&& f) {
  if (pairs.fluidList.clusterCount() < fewClusters)
    f(Sharing<4, 4>{});
  else
    f(Sharing<4, 1>{});
}
/// The same, also for pairs without lists.
template <int D, class F>
void withSharing(const MphPairs<D>& pairs, F&& f) {
  if (pairs.fluidList.offset)
    withListSharing(pairs, f);
  else
    f(Sharing<4, 1, true>{});
}

}  // namespace treacle
