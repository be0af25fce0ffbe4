#pragma once

#include "treacle/core/communicator.hpp"
#include "treacle/model/particles/particles.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace treacle {

/// The walls that each of these processes has, no fluid beside them, one after the other in the order of ranks, at
/// all processes. `surfaces`: they have surfaces, also where a process has none of them. Collective. Errors:
/// std::bad_alloc.
template <int D>
Particles<D> wallsOfAll(const Communicator& processes, const Particles<D>& own, bool surfaces) {
  const std::vector<std::uint32_t> counts = processes.all(own.count);
  std::uint64_t count = 0;
  for (const std::uint32_t n : counts) count += n;
  Particles<D> all;
  all.resize({0, count, 0, surfaces ? count : 0, 0, own.has.ofWalls()});
  const auto exchange = [&]<class T>(const Buffer<T>& from, Buffer<T>& to) {
    std::vector<Communicator::Message> sent, received;
    T* place = to.data();
    for (int r = 0; r < processes.size(); place += counts[r++]) {
      if (r == processes.rank()) {
        std::copy(from.begin(), from.end(), place);
        continue;
      }
      sent.push_back({r, const_cast<T*>(from.data()), from.size() * sizeof(T)});
      received.push_back({r, place, counts[r] * sizeof(T)});
    }
    processes.exchange(sent, received);
  };
  forEachSharedFieldOf(exchange, own, all);
  if (surfaces) forEachWallFieldOf(exchange, own, all);
  return all;
}

/// Makes them the last wall particles of `whole` at the first process, where there is room for them; that of
/// others is not touched. Collective. Errors: std::bad_alloc.
template <int D>
void appendWallsOfAll(const Communicator& processes, const Particles<D>& own, bool surfaces, Particles<D>& whole) {
  const bool first = processes.rank() == 0;
  const auto collect = [&]<class T>(const Buffer<T>& from, Buffer<T>& to) {
    const std::vector<T> all = processes.collect(std::span<const T>(from));
    if (first) std::copy(all.begin(), all.end(), to.end() - static_cast<std::ptrdiff_t>(all.size()));
  };
  forEachSharedFieldOf(collect, own, whole);
  if (surfaces) forEachWallFieldOf(collect, own, whole);
}

}  // namespace treacle
