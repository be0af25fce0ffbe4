#pragma once

#include "treacle/core/backend.hpp"
#include "treacle/core/buffer.hpp"
#include "treacle/core/cuda.hpp"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace treacle {

/// Hierarchy of buckets over the fluid particles [K23 sect. 3.2]: level 0 are the occupied search cells, each
/// level doubles the edge, empty buckets are left out, the last level has one bucket. Along the Hilbert curve a
/// bucket's members are contiguous at every level, so a level is a list of ranges.
template <class Backend = Cpu>
struct BucketLevels {
  /// Level r: bucket b holds the members begin[b] … begin[b+1]-1, particles for r = 0, else buckets of level r-1.
  std::vector<Buffer<std::uint32_t, Backend>> begin;
  Buffer<std::uint32_t, Backend> bucketOf;  // per fluid particle: its level-0 bucket

  std::uint32_t count(std::size_t level) const { return static_cast<std::uint32_t>(begin[level].size() - 1); }
  std::size_t bytes() const {
    std::size_t sum = bucketOf.bytes();
    for (const auto& level : begin) sum += level.bytes();
    return sum;
  }
};

inline constexpr std::size_t allLevels = std::numeric_limits<std::size_t>::max();

/// `key`: ascending sort keys of the fluid particles; key >> cellShift is the cell's Hilbert index, and dropping
/// another `dimensions` bits gives each coarser bucket's. At most so many levels are made; for one alone keys need
/// not ascend, if those of each cell stand together.
void findBuckets(Context<Cpu>&, std::span<const std::uint64_t> key, int cellShift, int dimensions,
                 BucketLevels<>& levels, std::size_t mostLevels = allLevels);
void findBuckets(Context<Cuda>&, std::span<const std::uint64_t> key, int cellShift, int dimensions,
                 BucketLevels<Cuda>& levels, std::size_t mostLevels = allLevels);

}  // namespace treacle
