#pragma once

#include "treacle/core/buffer.hpp"

#include <cstdint>

namespace treacle {

/// Rows of C or C^T for the clusters of a list, with elements in 32 bits (src/precondition/packed_lanes.hpp).
/// Columns come in pairs: two fill the widest register of a CPU, the eight rows of the one below those of the
/// other.
struct PackedRows {
  Buffer<std::uint64_t> start;   // of each cluster, in pairs of columns
  Buffer<std::uint32_t> pairs;   // of columns that each cluster has
  Buffer<std::uint32_t> column;  // two per pair
  Buffer<std::uint32_t> word;    // sixteen per pair

  std::size_t bytes() const { return start.bytes() + pairs.bytes() + column.bytes() + word.bytes(); }
};

}  // namespace treacle
