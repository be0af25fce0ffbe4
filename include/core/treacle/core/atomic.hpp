#pragma once

#include "treacle/core/macros.hpp"

#include <atomic>
#include <cstdint>

namespace treacle {

// For loops over elements of either backend. What comes out does not depend on the order.

TREACLE_HD inline void addAtomically(std::uint32_t& to, std::uint32_t value) {
#ifdef __CUDA_ARCH__
  atomicAdd(&to, value);
#else
  std::atomic_ref(to).fetch_add(value, std::memory_order_relaxed);
#endif
}

/// to = min(to, value)
TREACLE_HD inline void lowerAtomically(std::uint32_t& to, std::uint32_t value) {
#ifdef __CUDA_ARCH__
  atomicMin(&to, value);
#else
  std::atomic_ref shared(to);
  std::uint32_t before = shared;
  while (before > value && !shared.compare_exchange_weak(before, value)) {
  }
#endif
}

/// to = max(to, value)
TREACLE_HD inline void raiseAtomically(std::uint32_t& to, std::uint32_t value) {
#ifdef __CUDA_ARCH__
  atomicMax(&to, value);
#else
  std::atomic_ref shared(to);
  std::uint32_t before = shared;
  while (before < value && !shared.compare_exchange_weak(before, value)) {
  }
#endif
}

}  // namespace treacle
