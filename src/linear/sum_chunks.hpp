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

// Loops over a chunk take bare pointers: through a closure's references g++ 12 turns them into gathers.

template <class T>
double dotChunk(const T* x, const double* y, std::size_t n) {
  double sum = 0;
#pragma omp simd reduction(+ : sum)
  for (std::size_t i = 0; i < n; ++i) sum += double(x[i]) * y[i];
  return sum;
}

template <class T, class U>
void addChunk(double c, const T* x, U* y, std::size_t n) {
#pragma omp simd
  for (std::size_t i = 0; i < n; ++i) y[i] += static_cast<U>(c * x[i]);
}

inline void directionChunk(const double* z, double beta, double* p, std::size_t n) {
#pragma omp simd
  for (std::size_t i = 0; i < n; ++i) p[i] = z[i] + beta * p[i];
}

}  // namespace treacle
