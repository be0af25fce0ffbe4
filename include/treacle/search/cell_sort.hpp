#pragma once

#include "treacle/core/backend.hpp"
#include "treacle/core/buffer.hpp"
#include "treacle/model/particles.hpp"
#include "treacle/search/cell_grid.hpp"

#include <cstdint>
#include <span>

namespace treacle {

/// Where the particles of each cell stand after the sort.
template <class Backend = Cpu>
struct CellRanges {
  /// Fluid and those walls that have fluid in their own or an adjacent cell come first, [0, activeCount): the
  /// others are too far away to take part in any sum.
  std::uint32_t activeCount = 0;
  Buffer<std::uint32_t, Backend> fluidBegin, fluidEnd;  // per cell (CellGrid::linear): range of fluid particles
  Buffer<std::uint32_t, Backend> wallBegin, wallEnd;    // per cell: range of active wall particles
  Buffer<std::uint64_t, Backend> key;                   // per fluid particle, ascending: CellGrid::key

  std::size_t bytes() const {
    return fluidBegin.bytes() + fluidEnd.bytes() + wallBegin.bytes() + wallEnd.bytes() + key.bytes();
  }
};

template <class Backend = Cpu>
struct SortWorkspace {
  struct KeyedIndex {
    std::uint64_t key;
    std::uint32_t index;
  };
  Buffer<KeyedIndex, Backend> keyed;
  Buffer<std::byte, Backend> field;        // a permuted copy of one field
  Buffer<std::uint8_t, Backend> hasFluid;  // per cell: fluid in it or next to it
};

/// Sorts all fields by CellGrid::key, fluid, active and inactive walls each by itself, stably; fills the ranges.
template <int D>
void sortByCell(Context<Cpu>&, const CellGrid<D>& grid, Particles<D>& particles, CellRanges<>& ranges,
                SortWorkspace<>& workspace);

}  // namespace treacle
