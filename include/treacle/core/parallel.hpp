#pragma once

#include <omp.h>

#include <cstddef>

namespace treacle {

/// Loops shorter than this run on one thread: starting a team costs more than it saves. Results do not depend on
/// it.
inline constexpr std::size_t parallelGrain = 256;

/// Sums are formed over chunks of fixed length and the chunks' sums added in order, so that the result does not
/// depend on the number of threads.
inline constexpr std::size_t reductionChunk = 4096;

/// body(i) for i in [0, n), on all threads when n reaches the grain. Iterations must not depend on each other.
template <class F>
void parallelFor(std::size_t n, std::size_t grain, F&& body) {
  if (n < grain || omp_get_max_threads() == 1) {  // a team of one still costs an allocation
    for (std::size_t i = 0; i < n; ++i) body(i);
    return;
  }
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < n; ++i) body(i);
}

/// The same for iterations of unequal length: threads take `chunk` of them at a time.
template <class F>
void parallelForDynamic(std::size_t n, std::size_t grain, int chunk, F&& body) {
  if (n < grain || omp_get_max_threads() == 1) {
    for (std::size_t i = 0; i < n; ++i) body(i);
    return;
  }
#pragma omp parallel for schedule(dynamic, chunk)
  for (std::size_t i = 0; i < n; ++i) body(i);
}

}  // namespace treacle
