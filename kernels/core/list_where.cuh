#pragma once

#include "core/launch.hpp"
#include "core/scan.hpp"
#include "treacle/core/buffer.hpp"

#include <cstddef>
#include <cstdint>

namespace treacle {

/// Appends those i of [begin, begin + count) for which `chosen(i)` to a list that has room for them all,
/// ascending, behind the `listed` that are there; returns how many it has then, for which the host waits. One
/// thread for each; reads how many come before it, writes its number; atomics no.
template <class Chosen>
std::uint32_t listWhere(Context<Cuda>& context, std::uint32_t begin, std::uint32_t count, Chosen chosen,
                        std::uint32_t* list, std::uint32_t listed = 0) {
  Buffer<std::uint32_t, Cuda> place(context, std::size_t{count} + 1);  // the last one: of all
  forEach(context, std::size_t{count} + 1, [begin, count, chosen, place = place.data()] __device__(std::size_t k) {
    place[k] = k < count && chosen(begin + static_cast<std::uint32_t>(k)) ? 1 : 0;
  });
  sumBefore(context, place.span());
  forEach(context, count, [begin, place = place.data(), list = list + listed] __device__(std::size_t k) {
    if (place[k] != place[k + 1]) list[place[k]] = begin + static_cast<std::uint32_t>(k);
  });
  return listed + valueOnHost(context, place.data() + count);
}

}  // namespace treacle
