#pragma once

#include "treacle/core/buffer.hpp"
#include "treacle/core/parallel.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace treacle {

/// The numbers in [begin, end) for which keep(i) holds, ascending. `keep` is called twice for each. Errors:
/// std::bad_alloc.
template <class F>
Buffer<std::uint32_t> selected(std::uint32_t begin, std::uint32_t end, F&& keep) {
  constexpr std::size_t piece = std::size_t{1} << 14;
  const std::size_t pieces = (end - begin + piece - 1) / piece;
  const auto forEachKept = [&](std::size_t p, auto&& f) {
    const std::size_t first = begin + p * piece, last = std::min<std::size_t>(first + piece, end);
    for (std::size_t i = first; i < last; ++i)
      if (const auto number = static_cast<std::uint32_t>(i); keep(number)) f(number);
  };
  std::vector<std::size_t> start(pieces + 1);
  parallelFor(pieces, 2, [&](std::size_t p) {
    std::size_t kept = 0;
    forEachKept(p, [&](std::uint32_t) { ++kept; });
    start[p + 1] = kept;
  });
  for (std::size_t p = 0; p < pieces; ++p) start[p + 1] += start[p];
  Buffer<std::uint32_t> numbers(start[pieces]);
  parallelFor(pieces, 2, [&](std::size_t p) {
    std::size_t next = start[p];
    forEachKept(p, [&](std::uint32_t i) { numbers[next++] = i; });
  });
  return numbers;
}

/// to[k] = from[which[k] - first]
template <class T>
void gather(std::span<const T> from, std::span<const std::uint32_t> which, T* to, std::uint32_t first = 0) {
  parallelFor(which.size(), parallelGrain, [&](std::size_t k) { to[k] = from[which[k] - first]; });
}

}  // namespace treacle
