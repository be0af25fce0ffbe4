#pragma once

#include "treacle/core/team.hpp"

#include <omp.h>

#include <algorithm>
#include <atomic>
#include <cstddef>

namespace treacle {

/// Loops shorter than this run on one thread: calling the others costs more than it saves. Results do not depend
/// on it.
inline constexpr std::size_t parallelGrain = 64;

/// Sums are formed over chunks of fixed length and the chunks' sums added in order, so that the result does not
/// depend on the number of threads.
inline constexpr std::size_t reductionChunk = 4096;

/// body(i) for i in [begin, end). Compiled once for all threads: copies of a loop may be rounded differently.
template <class F>
#ifdef __clang__
[[gnu::noinline]]
#else
[[gnu::noinline, gnu::noclone]]
#endif
void iterate(F& body, std::size_t begin, std::size_t end) {
  for (std::size_t i = begin; i < end; ++i) body(i);
}

/// body(i) for i in [0, n), on all threads when n reaches the grain: those of the team that the caller leads, else
/// those of OpenMP. Iterations must not depend on each other.
template <class F>
void parallelFor(std::size_t n, std::size_t grain, F&& body) {
  if (n < grain || omp_get_max_threads() == 1) return iterate(body, 0, n);  // a team of one costs an allocation
  if (Team* team = Team::led()) {
    const std::size_t size = static_cast<std::size_t>(team->size());
    auto share = [&body, n, size](int thread) {
      const std::size_t t = static_cast<std::size_t>(thread);
      iterate(body, n * t / size, n * (t + 1) / size);
    };
    return team->run(share);
  }
#pragma omp parallel
  {
    const std::size_t t = static_cast<std::size_t>(omp_get_thread_num()),
                      size = static_cast<std::size_t>(omp_get_num_threads());
    iterate(body, n * t / size, n * (t + 1) / size);
  }
}

/// The same for iterations of unequal length: threads take `chunk` of them at a time.
template <class F>
void parallelForDynamic(std::size_t n, std::size_t grain, std::size_t chunk, F&& body) {
  if (n < grain || omp_get_max_threads() == 1) return iterate(body, 0, n);
  std::atomic<std::size_t> next{0};
  const std::size_t chunks = (n + chunk - 1) / chunk;
  const std::size_t threads = static_cast<std::size_t>(omp_get_max_threads());
  parallelFor(std::min(chunks, threads), 2, [&](std::size_t) {
    for (std::size_t c; (c = next.fetch_add(1, std::memory_order_relaxed)) < chunks;)
      iterate(body, c * chunk, std::min(n, (c + 1) * chunk));
  });
}

}  // namespace treacle
