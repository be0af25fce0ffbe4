#pragma once

#include "treacle/core/halo.hpp"
#include "treacle/search/buckets.hpp"
#include "treacle/search/sorted_particles.hpp"

#include <cstdint>
#include <span>

namespace treacle {

/// Buckets in a simulation that processes share. What a process computes for the finest ones it computes for those
/// that it has particles of; the hierarchy is that of all processes, the same everywhere.
template <class Backend = Cpu>
struct SharedBuckets {
  BucketLevels<Backend> local;            // one level: buckets of the own fluid, behind them those of ghosts
  std::uint32_t own = 0;                  // how many of the local ones are the process's own
  Buffer<std::uint32_t, Backend> number;  // per local bucket: its number among those of all
  /// Of all. A bucket of level 0 has its particles where they are the process's own, else none. Without bucketOf.
  BucketLevels<Backend> all;

  std::size_t bytes() const { return local.bytes() + number.bytes() + all.bytes(); }
};

/// `key`: of the own fluid, as the sort leaves it (CellRanges::key). Collective.
template <int D, class Backend>
void findSharedBuckets(Context<Backend>&, const SortedParticles<D>&, std::span<const std::uint64_t> key,
                       SharedBuckets<Backend>& buckets);

/// cells[b] = key >> shift of the first particle of each bucket.
template <class Backend>
void bucketCells(Context<Backend>&, std::span<const std::uint64_t> key, std::span<const std::uint32_t> begin,
                 int shift, std::span<std::uint64_t> cells);
/// The sort keys of particles.
template <int D, class Backend>
void sortKeys(Context<Backend>&, const CellGrid<D>&, std::span<const Vec<D>> position,
              std::span<std::uint64_t> key);

}  // namespace treacle
