#pragma once

#include "treacle/core/each.hpp"

#include <algorithm>
#include <vector>

namespace treacle {

/// Runs body(begin, length) on chunks of fixed length.
template <class F>
void forChunks(std::size_t n, F&& body) {
  const std::size_t chunks = (n + reductionChunk - 1) / reductionChunk;
  parallelFor(chunks, 2, [&](std::size_t c) {
    const std::size_t begin = c * reductionChunk;
    body(begin, std::min(reductionChunk, n - begin));
  });
}

/// Runs body(begin, length) on chunks of fixed length and adds what it returns in the order of the chunks.
template <class F>
double sumChunks(Context<Cpu>& context, std::size_t n, F&& body) {
  const std::size_t chunks = (n + reductionChunk - 1) / reductionChunk;
  if (chunks <= 1) return body(std::size_t{0}, n);
  std::vector<double>& partial = context.partialSums;
  partial.resize(chunks);
  forChunks(n,
            [&](std::size_t begin, std::size_t length) { partial[begin / reductionChunk] = body(begin, length); });
  double sum = 0;
  for (double p : partial) sum += p;
  return sum;
}

// Loops over a chunk take bare pointers, or a closure's own copy: through references g++ 12 turns them into
// gathers. Like iterate(), those of bodies are compiled once.

template <bool InLanes, class S, class Body>
[[gnu::noinline]] double sumOfChunk(const S* scalars, const Body& of, std::size_t begin, std::size_t end) {
  const S s = *scalars;
  const Body body = of;
  double sum = 0;
  if constexpr (InLanes) {
#pragma omp simd reduction(+ : sum)
    for (std::size_t i = begin; i < end; ++i) sum += body(i, s);
  } else {
    for (std::size_t i = begin; i < end; ++i) sum += body(i, s);
  }
  return sum;
}

template <class S, class Body>
[[gnu::noinline]] void setChunk(const S* scalars, const Body& of, std::size_t begin, std::size_t end) {
  const S s = *scalars;
  const Body body = of;
#pragma omp simd
  for (std::size_t i = begin; i < end; ++i) body(i, s);
}

// As each_number.hpp takes them.

template <class S, class Body>
void forEachNumber(Context<Cpu>&, std::size_t n, const S* scalars, const Body& body) {
  forChunks(n, [&](std::size_t begin, std::size_t length) { setChunk(scalars, body, begin, begin + length); });
}

template <bool InLanes = true, class S, class Body, class Finish>
void reduceNumbers(Context<Cpu>& context, std::size_t n, S* scalars, const Body& body, const Finish& finish) {
  const double sum = sumChunks(context, n, [&](std::size_t begin, std::size_t length) {
    return sumOfChunk<InLanes>(scalars, body, begin, begin + length);
  });
  finish(sumOverProcesses(context, sum), *scalars);
}
template <class S, class Body, class Finish>
void reduceInOrder(Context<Cpu>& context, std::size_t n, S* scalars, const Body& body, const Finish& finish) {
  reduceNumbers<false>(context, n, scalars, body, finish);
}

template <int D, class Body>
void forEachComponent(Context<Cpu>&, std::size_t n, const Body& body) {
  parallelFor(n, reductionChunk, [&](std::size_t i) {
    for (int c = 0; c < D; ++c) body(i, c);
  });
}

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
