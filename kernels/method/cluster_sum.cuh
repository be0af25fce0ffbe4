#pragma once

#include "core/launch.hpp"
#include "search/cluster_candidates.cuh"
#include "treacle/method/mph_pairs.hpp"

namespace treacle {

/// 1 / sqrt(x), x > 0, to full double precision: the hardware's estimate (2^-22) and one step of third order.
__device__ inline double inverseSqrt(double x) {
  double y;
  asm("rsqrt.approx.ftz.f64 %0, %1;" : "=d"(y) : "d"(x));
  const double e = fma(-x * y, y, 1.0);
  return fma(y * e, fma(e, 0.375, 0.5), y);
}
/// The same to single precision.
__device__ inline float inverseSqrt(float x) { return rsqrtf(x); }

/// a where it is positive, else zero; without occupying the double-precision units.
__device__ inline double positivePart(double a) {
  const int high = __double2hiint(a), keep = ~(high >> 31);
  return __hiloint2double(high & keep, __double2loint(a) & keep);
}
__device__ inline float positivePart(float a) { return fmaxf(a, 0.f); }

/// Lengths in the arithmetic of a kernel: double as they are; float from the cluster's first particle and in units
/// of h, differences of positions being formed in double.
template <int D, class T>
struct Frame;
template <int D>
struct Frame<D, double> {
  __device__ Frame(const Vec<D>&, double) {}
  __device__ Vec<D> local(const Vec<D>& x) const { return x; }
};
template <int D>
struct Frame<D, float> {
  Vec<D> origin;
  double inverseUnit;
  __device__ Frame(const Vec<D>& o, double unit) : origin(o), inverseUnit(1 / unit) {}
  __device__ Vec<D, float> local(const Vec<D>& x) const {
    Vec<D, float> r;
    for (int k = 0; k < D; ++k) r[k] = static_cast<float>((x[k] - origin[k]) * inverseUnit);
    return r;
  }
};
/// The unit of length of the arithmetic [m].
template <class T>
inline double frameUnit(double farRadius) {
  return std::is_same_v<T, double> ? 1.0 : farRadius;
}

/// Squares of distances get this fraction of h^2 added: a particle meets itself in its cluster's list, and two may
/// coincide; their differences are then zero and so is every term, whatever 1/r.
template <class T>
inline constexpr double distanceFloor = std::is_same_v<T, double> ? 1e-24 : 1e-12;

/// How a warp shares the work on a cluster: each lane keeps `Own` of its eight particles, so that a neighbour, once
/// loaded, serves that many pairs; the lanes that keep the same particles take turns with the neighbours. `Warps`
/// warps share one cluster's neighbours: small systems would otherwise leave the card idle.
/// With Ranges there are no lists.
template <int Own_, int Warps_, bool Ranges_ = false>
struct Sharing {
  static constexpr int own = Own_, warps = Warps_;
  static constexpr bool ranges = Ranges_;
  static_assert(!ranges || warps == 1);
  static constexpr int groups = clusterSize / own;
  static constexpr int slots = 32 / groups;
  static constexpr int warpsPerBlock = 4;
  static constexpr int clustersPerBlock = warpsPerBlock / warps;
};

/// Adds up v[0 … N-1] over the lanes of each group of N (a power of two): afterwards lane n of the group holds the sum
/// of v[n]. N - 1 exchanges instead of N log N.
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

/// Calls visit(integral_constant<ListSegment>, entry) for the entries of the segments that the terms need, every
/// `slots * warps`-th in each lane, from `slot` on.
template <class Terms, class S, class Visit>
__device__ void walkLists(const ClusterListView& list, std::uint32_t cluster, int slot, Visit&& visit) {
  constexpr std::uint32_t stride = S::slots * S::warps;
  const std::uint64_t* offset = list.offset + std::size_t{listSegments} * cluster;
  const auto walk = [&](auto segment) {
    constexpr int s = static_cast<int>(decltype(segment)::value);
    if constexpr (Terms::uses(decltype(segment)::value)) {
      const ListEntry* entry = list.entry + offset[s];
      const auto count = static_cast<std::uint32_t>(offset[s + 1] - offset[s]);
      std::uint32_t k = slot;
      ListEntry next = k < count ? entry[k] : ListEntry{0};
      while (k < count) {
        const ListEntry e = next;
        k += stride;
        if (k < count) next = entry[k];  // on its way while this one is worked on
        visit(segment, e);
      }
    }
  };
  walk(std::integral_constant<ListSegment, ListSegment::NearFluid>{});
  walk(std::integral_constant<ListSegment, ListSegment::FarFluid>{});
  walk(std::integral_constant<ListSegment, ListSegment::NearWall>{});
  walk(std::integral_constant<ListSegment, ListSegment::FarWall>{});
}

/// The same from the cell ranges: candidates within reach are queued until a warp has enough of them. All of them
/// count as near: terms vanish beyond their radius by themselves. Returns whether there was fluid.
template <class Terms, class S, int D, class Visit>
__device__ bool walkRanges(const MphPairs<D>& pairs, std::uint32_t first, std::uint32_t count, Visit&& visit) {
  __shared__ ListEntry queues[S::warpsPerBlock][64];
  ListEntry* queue = queues[threadIdx.x / 32];
  const int lane = threadIdx.x % 32, slot = lane % S::slots;
  const ClusterCandidates<D> candidates(pairs.grid, pairs.cells, pairs.position.data(), first, count);
  const auto pass = [&](auto segment, bool walls, double radius) {
    int queued = 0;
    bool any = false;
    const auto work = [&](int entries) {
      __syncwarp();
      for (int k = slot; k < entries; k += S::slots) visit(segment, queue[k]);
      __syncwarp();
    };
    candidates.forEach({radius, 0}, !walls, walls, [&](ListEntry e, bool near, bool, bool) {
      const unsigned hits = __ballot_sync(~0u, near);
      if (near) queue[queued + __popc(hits & ((1u << lane) - 1))] = e;
      queued += __popc(hits);
      any |= hits != 0;
      if (queued < 32) return;
      work(32);
      queued -= 32;
      if (lane < queued) queue[lane] = queue[lane + 32];
    });
    work(queued);
    return any;
  };
  const double near = pairs.pressureWeight.radius;
  const bool fluid = pass(std::integral_constant<ListSegment, ListSegment::NearFluid>{}, false,
                          Terms::uses(ListSegment::FarFluid) ? pairs.viscosityWeight.radius : near);
  if (Terms::uses(ListSegment::NearWall))
    pass(std::integral_constant<ListSegment, ListSegment::NearWall>{}, true,
         Terms::uses(ListSegment::FarWall) ? pairs.viscosityWeight.radius : near);
  return fluid;
}

/// Sums of pair terms over the neighbours of one cluster. `Terms` gives
///   Own loadOwn(pairs, i), Other loadOther(pairs, j)   what they read of a particle
///   values                                             how many sums a particle has
///   uses(segment)                                      which parts of the lists count
///   add<segment>(pairs, sums, d, 1/r, own, other)
///   store(pairs, i, n, sum)                            called once per particle and sum
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
  __device__ void run(const Terms& terms, double unit, int part, T (*exchange)[32]) const {
    const int lane = threadIdx.x % 32, group = lane / S::slots, slot = lane % S::slots;
    const Vec<D> origin = pairs_.position[first_];
    const Frame<D, T> frame(origin, unit);
    Vec<D, T> x[S::own];
    typename Terms::Own own[S::own];
    T sum[paddedSums] = {};
#pragma unroll
    for (int t = 0; t < S::own; ++t) {
      const std::uint32_t i = particle(group * S::own + t);
      Vec<D> xi = pairs_.position[i];
      for (int k = 0; k < D; ++k) {
        const double away = xi[k] - origin[k];
        if (fabs(away) > 0.5 * pairs_.grid.length[k] && pairs_.grid.periodic[k])
          xi[k] -= pairs_.grid.length[k] * round(away / pairs_.grid.length[k]);
      }
      x[t] = frame.local(xi);
      own[t] = terms.loadOwn(pairs_, i);
    }
    const double h = pairs_.pressureWeight.radius / unit;
    const T floor = static_cast<T>(distanceFloor<T> * h * h);
    const auto visit = [&](auto segment, ListEntry e) {
      const std::uint32_t j = e.index();
      Vec<D> xj = pairs_.position[j];
      if (e.image() != 0) xj += pairs_.images.shift[e.image()];
      const Vec<D, T> local = frame.local(xj);
      const typename Terms::Other other = terms.loadOther(pairs_, j);
#pragma unroll
      for (int t = 0; t < S::own; ++t) {
        const Vec<D, T> d = local - x[t];
        T r2 = floor;
        for (int k = 0; k < D; ++k) r2 = fma(d[k], d[k], r2);
        terms.template add<decltype(segment)::value>(pairs_, &sum[t * values], d, inverseSqrt(r2), own[t], other);
      }
    };
    if constexpr (S::ranges) {
      const bool fluid = walkRanges<Terms, S>(pairs_, first_, count_, visit);
      if (first_ >= pairs_.fluidCount && !fluid)  // lists leave such walls out
        for (T& value : sum) value = 0;
    } else {
      walkLists<Terms, S>(list_, cluster_, slot + S::slots * part, visit);
    }
    store(terms, sum, part, exchange);
  }

 private:
  /// Sums of one lane, filled up to a multiple of the group's lanes.
  static constexpr int rounds = (sums + S::slots - 1) / S::slots;
  static constexpr int paddedSums = rounds * S::slots;

  __device__ std::uint32_t particle(int own) const { return first_ + min(static_cast<std::uint32_t>(own), count_ - 1); }

  __device__ void store(const Terms& terms, T (&sum)[paddedSums], int part, T (*exchange)[32]) const {
    const int lane = threadIdx.x % 32, group = lane / S::slots, slot = lane % S::slots;
#pragma unroll
    for (int r = 0; r < rounds; ++r) {
      T total = transposedSum<S::slots>(&sum[r * S::slots]);
      if constexpr (S::warps > 1) {
        const int warp = threadIdx.x / 32;
        __syncthreads();
        exchange[warp][lane] = total;
        __syncthreads();
        total = 0;
        for (int w = 0; w < S::warps; ++w) total += exchange[warp - part + w][lane];
        if (part != 0) continue;
      }
      const int n = r * S::slots + slot, t = n / values;
      const std::uint32_t own = group * S::own + t;
      if (n < sums && own < count_) terms.store(pairs_, first_ + own, n % values, total);
    }
  }

  const MphPairs<D>& pairs_;
  const ClusterListView& list_;
  std::uint32_t cluster_, first_, count_;
};

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
                                   double unit) {
  __shared__ T exchange[S::warpsPerBlock][32];
  const int warp = threadIdx.x / 32;
  const std::uint32_t cluster = block * S::clustersPerBlock + warp / S::warps;
  if (cluster < task.list.clusterCount())
    ClusterSum<D, T, S, Terms>(pairs, task.list, cluster).run(task.terms, unit, warp % S::warps, exchange);
}

/// Warps share clusters as S says. Reads positions, lists and what the terms read of both particles of a pair; writes
/// what the terms store. No atomics.
template <int D, class T, class S, class Terms>
__global__ void __launch_bounds__(32 * S::warpsPerBlock)
    clusterSumKernel(const __grid_constant__ MphPairs<D> pairs, const __grid_constant__ ListTask<Terms> task,
                     double unit) {
  sumOverList<D, T, S>(pairs, task, blockIdx.x, unit);
}

/// The same for two lists at once: first the clusters of a, then those of b.
template <int D, class T, class S, class A, class B>
__global__ void __launch_bounds__(32 * S::warpsPerBlock)
    clusterSumsKernel(const __grid_constant__ MphPairs<D> pairs, const __grid_constant__ ListTask<A> a,
                      const __grid_constant__ ListTask<B> b, double unit) {
  const unsigned blocksOfA = a.template blocks<S>();
  if (blockIdx.x < blocksOfA)
    sumOverList<D, T, S>(pairs, a, blockIdx.x, unit);
  else
    sumOverList<D, T, S>(pairs, b, blockIdx.x - blocksOfA, unit);
}

template <int D, class T, class S, class Terms>
void launchClusterSums(Context<Cuda>& context, const MphPairs<D>& pairs, const ListTask<Terms>& task, double unit) {
  launch(context, task.template blocks<S>(), 32 * S::warpsPerBlock, 0, clusterSumKernel<D, T, S, Terms>, pairs, task,
         unit);
}

template <int D, class T, class S, class A, class B>
void launchClusterSums(Context<Cuda>& context, const MphPairs<D>& pairs, const ListTask<A>& a, const ListTask<B>& b,
                       double unit) {
  launch(context, a.template blocks<S>() + b.template blocks<S>(), 32 * S::warpsPerBlock, 0,
         clusterSumsKernel<D, T, S, A, B>, pairs, a, b, unit);
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
