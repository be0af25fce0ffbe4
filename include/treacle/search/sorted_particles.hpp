#pragma once

#include "treacle/core/vec.hpp"
#include "treacle/search/cell_grid.hpp"
#include "treacle/search/cell_sort.hpp"

#include <cstdint>
#include <span>

namespace treacle {

/// Particles after the sort, in host or device memory. Particles [0, fluidCount) are fluid, [fluidCount,
/// activeCount) the walls near it. Spans and pointers belong to the step's owner.
template <int D>
struct SortedParticles {
  std::uint32_t fluidCount = 0, activeCount = 0;
  std::span<const Vec<D>> position;  // [m]
  std::span<const std::uint8_t> material;
  CellRangesView cells;
  CellGrid<D> grid;
  double spacing = 0;  // l [m]
};

}  // namespace treacle
