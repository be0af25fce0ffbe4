#pragma once

#include "core/launch.hpp"

#include <span>

namespace treacle {

/// The coarse row that each fine row is a member of. `members`: first fine row of each coarse one, and the end.
inline void findParents(const Context<Cuda>& context, std::span<const std::uint32_t> members,
                        std::uint32_t fineRows, Buffer<std::uint32_t, Cuda>& parent) {
  parent.resize(context, fineRows);
  forEach(context, members.size() - 1, [begin = members.data(), to = parent.data()] __device__(std::size_t row) {
    for (std::uint32_t i = begin[row]; i < begin[row + 1]; ++i) to[i] = static_cast<std::uint32_t>(row);
  });
}

}  // namespace treacle
