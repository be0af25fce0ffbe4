#pragma once

#include "search/cluster_candidates.cuh"
#include "treacle/mph/mph_pairs.hpp"

namespace treacle {

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

/// Runs along a part of a list, every `stride`-th entry from k on: load(index) starts the loads of a neighbour,
/// add(what was loaded, k) uses them one round later, while those of the next are on their way.
template <int Stride, class Load, class Add>
__device__ inline void pipeline(const std::uint32_t* entry, std::uint32_t k, std::uint32_t count, Load&& load,
                                Add&& add) {
  if (k >= count) return;
  auto loaded = load(entry[k]);
  std::uint32_t next = k + Stride;
  std::uint32_t nextEntry = next < count ? entry[next] : 0;
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
/// count as near: terms vanish beyond their radius by themselves. Returns whether sums over walls count: those of
/// walls do if there is fluid where their lists would look for it.
template <class Terms, class S, int D, class Visit>
__device__ bool walkRanges(const MphPairs<D>& pairs, std::uint32_t first, std::uint32_t count, Visit&& visit) {
  __shared__ std::uint32_t queues[S::warpsPerBlock][64];
  std::uint32_t* queue = queues[threadIdx.x / 32];
  const int lane = threadIdx.x % 32, slot = lane % S::slots;
  __shared__ typename ClusterCandidates<D>::Shared shared[S::warpsPerBlock];
  const ClusterCandidates<D> candidates(pairs.grid, pairs.cells, pairs.position.data(), pairs.side, first, count,
                                        shared[threadIdx.x / 32]);
  const bool ofFluid = first < pairs.fluidCount;
  const double near =
      ofFluid ? pairs.terms.pressureRadius : fmax(pairs.terms.pressureRadius, pairs.terms.densityRadius);
  const auto pass = [&](bool walls, bool counts, double far) {
    int queued = 0;
    bool any = false;
    const auto work = [&](int entries) {
      __syncwarp();
      for (int k = slot; k < entries; k += S::slots)
        visit(queue[k], walls ? ListSegment::NearWall : ListSegment::NearFluid);
      __syncwarp();
    };
    candidates.forEach({near, far}, !walls, walls, [&](std::uint32_t j, bool isNear, bool isFar, bool) {
      const bool hit = isNear || isFar;
      const unsigned hits = __ballot_sync(~0u, hit);
      if (hit && counts) queue[queued + __popc(hits & ((1u << lane) - 1))] = j;
      any |= __any_sync(~0u, isNear) != 0;
      if (!counts) return;
      queued += __popc(hits);
      if (queued < 32) return;
      work(32);
      queued -= 32;
      if (lane < queued) queue[lane] = queue[lane + 32];
      __syncwarp();
    });
    work(queued);
    return any;
  };
  constexpr bool usesFluid = Terms::uses(ListSegment::NearFluid), usesWalls = Terms::uses(ListSegment::NearWall);
  const auto far = [&](ListSegment segment) {
    return Terms::uses(segment) ? fmax(pairs.terms.densityRadius, pairs.terms.viscosityRadius) : 0.0;
  };
  const bool fluid = usesFluid || !ofFluid ? pass(false, usesFluid, far(ListSegment::FarFluid)) : true;
  if (usesWalls) pass(true, true, far(ListSegment::FarWall));
  return fluid || !usesWalls;
}

}  // namespace treacle
