#pragma once

#include "treacle/core/backend.hpp"
#include "treacle/core/parallel.hpp"

#include <algorithm>
#include <vector>

namespace treacle {

/// Runs body(begin, length) on chunks of fixed length and adds what it returns in the order of the chunks.
template <class F>
double sumChunks(Context<Cpu>& context, std::size_t n, F&& body) {
  const std::size_t chunks = (n + reductionChunk - 1) / reductionChunk;
  if (chunks <= 1) return body(std::size_t{0}, n);
  std::vector<double>& partial = context.partialSums;
  partial.resize(chunks);
  parallelFor(chunks, 2, [&](std::size_t c) {
    const std::size_t begin = c * reductionChunk;
    partial[c] = body(begin, std::min(reductionChunk, n - begin));
  });
  double sum = 0;
  for (double p : partial) sum += p;
  return sum;
}

}  // namespace treacle
