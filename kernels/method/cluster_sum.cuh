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

/// Squares of distances get this fraction of h_p^2 added: a particle meets itself in its cluster's list, and two
/// may coincide; their differences are then zero and so is every term, whatever 1/r.
template <class T>
inline constexpr double distanceFloor = std::is_same_v<T, double> ? 1e-24 : 1e-12;

/// Positions as a kernel's arithmetic takes them.
template <int D, class T>
struct Places;

template <int D>
struct Places<D, double> {
  using Stored = Vec<D>;
  double floor;

  static Places make(const MphPairs<D>& pairs) {
    const double h = pairs.pressureWeight.radius;
    return {distanceFloor<double> * h * h};
  }
  static double unit(const MphPairs<D>&) { return 1; }  // of length [m]

  /// Particle i of a cluster, at the image nearest to the cluster's first particle.
  __device__ Stored own(const MphPairs<D>& pairs, std::uint32_t i, std::uint32_t first, bool wraps) const {
    Vec<D> x = pairs.position[i];
    if (!wraps) return x;
    for (int k = 0; k < D; ++k) {
      const double away = x[k] - pairs.position[first][k], length = pairs.grid.length[k];
      if (pairs.grid.periodic[k] && fabs(away) > 0.5 * length) x[k] -= length * round(away / length);
    }
    return x;
  }
  __device__ Stored neighbour(const MphPairs<D>& pairs, ListEntry e, bool wraps) const {
    Vec<D> x = pairs.position[e.index()];
    if (wraps && e.image() != 0) x += pairs.images.shift[e.image()];
    return x;
  }
  __device__ Vec<D> local(const Stored& x, const Stored&) const { return x; }
  /// Whether differences of local positions may mean another image: not here, images are in the lists.
  __device__ static bool tornApart(const Vec<D>&) { return false; }
  __device__ static void bringHome(Vec<D>&) {}
};

/// In single precision: differences of positions in units of 2^-32 of the domain's length are exact, and those
/// across periodic ends come out right by themselves; local positions count from the cluster's first particle, in
/// h_v.
template <int D>
struct Places<D, float> {
  using Stored = int4;
  float floor;
  const int4* fixed;
  Vec<D, float> scale;
  Vec<D, float> period;  // in h_v; infinite on open axes

  static Places make(const MphPairs<D>& pairs, const std::int32_t* fixed) {
    const double h = pairs.pressureWeight.radius / unit(pairs);
    Places p{static_cast<float>(distanceFloor<float> * h * h), reinterpret_cast<const int4*>(fixed), {}, {}};
    for (int k = 0; k < D; ++k) {
      const double length = pairs.grid.length[k] / unit(pairs);
      p.scale[k] = static_cast<float>(length / 4294967296.0);
      p.period[k] = static_cast<float>(pairs.grid.periodic[k] ? length : 1e30);
    }
    return p;
  }
  static double unit(const MphPairs<D>& pairs) { return pairs.viscosityWeight.radius; }

  __device__ Stored own(const MphPairs<D>&, std::uint32_t i, std::uint32_t, bool) const { return fixed[i]; }
  __device__ Stored neighbour(const MphPairs<D>&, ListEntry e, bool) const { return fixed[e.index()]; }
  __device__ Vec<D, float> local(const Stored& x, const Stored& origin) const {
    // Rounded here: fused into a later subtraction, a particle would not be at distance zero from itself.
    const auto axis = [this](int a, int b, int k) {
      const auto difference = static_cast<int>(static_cast<unsigned>(a) - static_cast<unsigned>(b));
      return __fmul_rn(static_cast<float>(difference), scale[k]);
    };
    Vec<D, float> d;
    d[0] = axis(x.x, origin.x, 0);
    d[1] = axis(x.y, origin.y, 1);
    if constexpr (D == 3) d[2] = axis(x.z, origin.z, 2);
    return d;
  }
  /// A particle this far from its cluster's first one may have neighbours that are nearer to the first one's other
  /// side: then each difference has to be brought home.
  __device__ bool tornApart(const Vec<D, float>& own) const {
    bool torn = false;
    for (int k = 0; k < D; ++k) torn = torn || fabsf(own[k]) > 0.5f * period[k] - 1.01f;
    return torn;
  }
  __device__ void bringHome(Vec<D, float>& d) const {
    for (int k = 0; k < D; ++k) d[k] -= period[k] * rintf(d[k] / period[k]);
  }
};

/// How a warp shares the work on a cluster: each lane keeps `Own` of its eight particles, so that a neighbour,
/// once loaded, serves that many pairs; the lanes that keep the same particles take turns with the neighbours.
/// `Warps` warps share one cluster's neighbours: small systems would otherwise leave the card idle. With Ranges
/// there are no lists.
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

/// Runs along a part of a list, every `stride`-th entry from k on: load(entry) starts the loads of a neighbour,
/// add(what was loaded, k) uses them one round later, while those of the next are on their way.
template <int Stride, class Load, class Add>
__device__ inline void pipeline(const ListEntry* entry, std::uint32_t k, std::uint32_t count, Load&& load,
                                Add&& add) {
  if (k >= count) return;
  auto loaded = load(entry[k]);
  std::uint32_t next = k + Stride;
  ListEntry nextEntry = next < count ? entry[next] : ListEntry{0};
  while (next < count) {
    const auto nextLoaded = load(nextEntry);
    if (next + Stride < count) nextEntry = entry[next + Stride];
    add(loaded, k);
    loaded = nextLoaded;
    k = next;
    next += Stride;
  }
  add(loaded, k);
}

/// The entries of the segments that the terms need: add(what was loaded, segment).
template <class Terms, class S, class Load, class Add>
__device__ void walkLists(const ClusterListView& list, std::uint32_t cluster, int slot, Load&& load, Add&& add) {
  const std::uint64_t* offset = list.offset + std::size_t{listSegments} * cluster;
  const auto walk = [&](ListSegment near, ListSegment far) {
    const bool usesNear = Terms::uses(near), usesFar = Terms::uses(far);
    if (!usesNear && !usesFar) return;
    const std::uint64_t begin = offset[static_cast<int>(usesNear ? near : far)];
    const auto nearCount = static_cast<std::uint32_t>(offset[static_cast<int>(near) + 1] - begin);
    const auto count = usesFar ? static_cast<std::uint32_t>(offset[static_cast<int>(far) + 1] - begin) : nearCount;
    pipeline<S::slots * S::warps>(list.entry + begin, slot, count, load, [&](const auto& loaded, std::uint32_t k) {
      add(loaded, !usesFar || (usesNear && k < nearCount) ? near : far);
    });
  };
  walk(ListSegment::NearFluid, ListSegment::FarFluid);
  walk(ListSegment::NearWall, ListSegment::FarWall);
}

/// The same from the cell ranges: candidates within reach are queued until a warp has enough of them. All of them
/// count as near: terms vanish beyond their radius by themselves. Returns whether there was fluid.
template <class Terms, class S, int D, class Visit>
__device__ bool walkRanges(const MphPairs<D>& pairs, std::uint32_t first, std::uint32_t count, Visit&& visit) {
  __shared__ ListEntry queues[S::warpsPerBlock][64];
  ListEntry* queue = queues[threadIdx.x / 32];
  const int lane = threadIdx.x % 32, slot = lane % S::slots;
  __shared__ typename ClusterCandidates<D>::Shared shared[S::warpsPerBlock];
  const ClusterCandidates<D> candidates(pairs.grid, pairs.cells, pairs.position.data(), first, count,
                                        shared[threadIdx.x / 32]);
  const auto pass = [&](bool walls, bool counts, double radius) {
    int queued = 0;
    bool any = false;
    const auto work = [&](int entries) {
      __syncwarp();
      for (int k = slot; k < entries; k += S::slots)
        visit(queue[k], walls ? ListSegment::NearWall : ListSegment::NearFluid);
      __syncwarp();
    };
    candidates.forEach({radius, 0}, !walls, walls, [&](ListEntry e, bool near, bool, bool) {
      const unsigned hits = __ballot_sync(~0u, near);
      if (near && counts) queue[queued + __popc(hits & ((1u << lane) - 1))] = e;
      any |= hits != 0;
      if (!counts) return;
      queued += __popc(hits);
      if (queued < 32) return;
      work(32);
      queued -= 32;
      if (lane < queued) queue[lane] = queue[lane + 32];
    });
    work(queued);
    return any;
  };
  const double near = pairs.pressureWeight.radius;
  constexpr bool usesFluid = Terms::uses(ListSegment::NearFluid), usesWalls = Terms::uses(ListSegment::NearWall);
  const auto radius = [&](ListSegment far) {
    return Terms::uses(far) ? pairs.viscosityWeight.radius : pairs.pressureWeight.radius;
  };
  const bool fluid =
      usesFluid || first >= pairs.fluidCount ? pass(false, usesFluid, radius(ListSegment::FarFluid)) : true;
  if (usesWalls) pass(true, true, radius(ListSegment::FarWall));
  return fluid;
}

/// Sums of pair terms over the neighbours of one cluster. `Terms` gives
///   Own loadOwn(pairs, i), Other loadOther(pairs, j)   what they read of a particle
///   values                                             how many sums a particle has
///   uses(segment)                                      which parts of the lists count
///   add(pairs, sums, d, 1/r, own, other, segment)
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
  __device__ void run(const Terms& terms, const Places<D, T>& places, int part, T (*exchange)[32]) const {
    const int lane = threadIdx.x % 32, group = lane / S::slots, slot = lane % S::slots;
    const bool wraps = S::ranges || list_.wraps[cluster_];
    const auto origin = places.own(pairs_, first_, first_, wraps);
    const Vec<D, T> mine = places.local(places.own(pairs_, particle(lane % clusterSize), first_, wraps), origin);
    const bool torn = __any_sync(~0u, places.tornApart(mine));
    Vec<D, T> x[S::own];
    typename Terms::Own own[S::own];
    T sum[paddedSums] = {};
#pragma unroll
    for (int t = 0; t < S::own; ++t) {
      for (int k = 0; k < D; ++k) x[t][k] = __shfl_sync(~0u, mine[k], group * S::own + t);
      own[t] = terms.loadOwn(pairs_, particle(group * S::own + t));
    }
    struct Loaded {
      typename Places<D, T>::Stored x;
      typename Terms::Other other;
    };
    const auto load = [&](ListEntry e) {
      return Loaded{places.neighbour(pairs_, e, wraps), terms.loadOther(pairs_, e.index())};
    };
    const auto add = [&](const Loaded& loaded, ListSegment segment) {
      const Vec<D, T> local = places.local(loaded.x, origin);
#pragma unroll
      for (int t = 0; t < S::own; ++t) {
        Vec<D, T> d = local - x[t];
        if (torn) places.bringHome(d);
        T r2 = places.floor;
        for (int k = 0; k < D; ++k) r2 = fma(d[k], d[k], r2);
        terms.add(pairs_, &sum[t * values], d, inverseSqrt(r2), own[t], loaded.other, segment);
      }
    };
    if constexpr (S::ranges) {
      const bool fluid =
          walkRanges<Terms, S>(pairs_, first_, count_, [&](ListEntry e, ListSegment s) { add(load(e), s); });
      if (first_ >= pairs_.fluidCount && !fluid)  // lists leave such walls out
        for (T& value : sum) value = 0;
    } else {
      walkLists<Terms, S>(list_, cluster_, slot + S::slots * part, load, add);
    }
    store(terms, sum, part, exchange);
  }

 private:
  /// Sums of one lane, filled up to a multiple of the group's lanes.
  static constexpr int rounds = (sums + S::slots - 1) / S::slots;
  static constexpr int paddedSums = rounds * S::slots;

  __device__ std::uint32_t particle(int own) const {
    return first_ + min(static_cast<std::uint32_t>(own), count_ - 1);
  }

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
                                   const Places<D, T>& places) {
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
                     const __grid_constant__ Places<D, T> places) {
  sumOverList<D, T, S>(pairs, task, blockIdx.x, places);
}

/// The same for two lists at once: first the clusters of a, then those of b.
template <int D, class T, class S, class A, class B>
__global__ void __launch_bounds__(32 * S::warpsPerBlock, residentBlocks<T, S>)
    clusterSumsKernel(const __grid_constant__ MphPairs<D> pairs, const __grid_constant__ ListTask<A> a,
                      const __grid_constant__ ListTask<B> b, const __grid_constant__ Places<D, T> places) {
  const unsigned blocksOfA = a.template blocks<S>();
  if (blockIdx.x < blocksOfA)
    sumOverList<D, T, S>(pairs, a, blockIdx.x, places);
  else
    sumOverList<D, T, S>(pairs, b, blockIdx.x - blocksOfA, places);
}

template <int D, class T, class S, class Terms>
void launchClusterSums(Context<Cuda>& context, const MphPairs<D>& pairs, const ListTask<Terms>& task,
                       const Places<D, T>& places) {
  launch(context, task.template blocks<S>(), 32 * S::warpsPerBlock, 0, clusterSumKernel<D, T, S, Terms>, pairs,
         task, places);
}

template <int D, class T, class S, class A, class B>
void launchClusterSums(Context<Cuda>& context, const MphPairs<D>& pairs, const ListTask<A>& a,
                       const ListTask<B>& b, const Places<D, T>& places) {
  launch(context, a.template blocks<S>() + b.template blocks<S>(), 32 * S::warpsPerBlock, 0,
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
