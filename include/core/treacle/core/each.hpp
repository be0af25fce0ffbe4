#pragma once

#include "treacle/core/buffer.hpp"
#include "treacle/core/parallel.hpp"
#include "treacle/core/processes.hpp"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace treacle {

// Loops over elements that do not depend on each other, as what is written once for both backends calls them. A
// device's are in kernels/core/each.cuh.

/// body(i) for i in [0, n).
template <class Body>
void forEach(const Context<Cpu>&, std::size_t n, Body&& body) {
  parallelFor(n, parallelGrain, body);
}

/// N sums over i in [0, n) of what add(i, sums) adds to each, over all processes. Their order depends on n alone.
template <int N, class Add>
std::array<double, N> sumEach(Context<Cpu>& context, std::size_t n, const Add& add) {
  using Sums = std::array<double, N>;
  std::vector<Sums> parts((n + reductionChunk - 1) / reductionChunk);
  parallelFor(parts.size(), 2, [&](std::size_t part) {
    const std::size_t end = std::min(n, (part + 1) * reductionChunk);
    for (std::size_t i = part * reductionChunk; i < end; ++i) add(i, parts[part].data());
  });
  Sums sums{};
  for (const Sums& part : parts)
    for (int k = 0; k < N; ++k) sums[k] += part[k];
  sumOverProcesses(context, std::span<double>(sums));
  return sums;
}

/// Appends those i of [begin, begin + count) for which `chosen(i)` to a list that has room for them all,
/// ascending, behind the `listed` that are there; returns how many it has then.
template <class Chosen>
std::uint32_t listWhere(Context<Cpu>&, std::uint32_t begin, std::uint32_t count, const Chosen& chosen,
                        std::uint32_t* list, std::uint32_t listed = 0) {
  for (std::uint32_t i = begin; i < begin + count; ++i)
    if (chosen(i)) list[listed++] = i;
  return listed;
}

/// Turns the number of entries of each row, rowStart[0 … rows-1], into the start of each row and the end,
/// rowStart[rows]. Returns the end.
template <class Count>
Count startRows(Context<Cpu>&, Buffer<Count>& rowStart) {
  Count sum = 0;
  for (std::size_t row = 0; row + 1 < rowStart.size(); ++row) sum += std::exchange(rowStart[row], sum);
  return rowStart[rowStart.size() - 1] = sum;
}

}  // namespace treacle
