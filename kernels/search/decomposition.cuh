#pragma once

#include "core/launch.hpp"
#include "treacle/core/communicator.hpp"
#include "treacle/core/cuda.hpp"

#include <bit>
#include <cstddef>
#include <cstdint>

namespace treacle {

// What the parts of a decomposition on a device share (decomposition.cu, ghosts.cu).

/// Keys of particles that go behind each other by rank have so many bits above their own: for the ranks and one
/// more.
inline int rankBits(const Communicator& job) { return std::bit_width(static_cast<unsigned>(job.size())); }

/// One thread per particle of a sorted group; the first one of those with the same key brings their indices into
/// the order of their ids, which does not depend on who had the particles before; atomics no.
inline void orderById(Context<Cuda>& context, std::size_t size, const std::uint64_t* key, const std::uint32_t* id,
                      std::uint32_t* index) {
  forEach(context, size, [=] __device__(std::size_t k) {
    if (k > 0 && key[k - 1] == key[k]) return;
    for (std::size_t next = k + 1; next < size && key[next] == key[k]; ++next) {
      const std::uint32_t inserted = index[next];
      std::size_t at = next;
      for (; at > k && id[index[at - 1]] > id[inserted]; --at) index[at] = index[at - 1];
      index[at] = inserted;
    }
  });
}

/// The number of indices [0, count) that `isBefore` holds for, which are the first ones.
template <class IsBefore>
__device__ std::uint32_t countFirst(std::uint32_t count, const IsBefore& isBefore) {
  std::uint32_t begin = 0, end = count;
  while (begin < end) {
    const std::uint32_t middle = begin + (end - begin) / 2;
    if (isBefore(middle))
      begin = middle + 1;
    else
      end = middle;
  }
  return begin;
}

}  // namespace treacle
