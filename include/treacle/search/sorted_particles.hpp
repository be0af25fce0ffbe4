#pragma once

#include "treacle/core/vec.hpp"
#include "treacle/search/cell_grid.hpp"
#include "treacle/search/cell_sort.hpp"

#include <cstdint>
#include <span>

namespace treacle {

/// Particles after the sort, in host or device memory. Particles [0, fluidCount) are fluid, [fluidCount,
/// activeCount) the walls near it; "per particle" means activeCount, "per fluid particle" fluidCount. Spans and
/// pointers belong to the step's owner.
template <int D>
struct SortedParticles {
  std::uint32_t fluidCount = 0, activeCount = 0;
  std::uint32_t ghostFluid = 0, ghostWalls = 0;  // the last ones of either, which other processes own
  std::span<const Vec<D>> position;              // [m]
  std::span<const std::uint8_t> material;
  CellRangesView cells;
  CellGrid<D> grid;
  double spacing = 0;  // l [m]

  /// The process's own particles are [0, ownFluid()) and [fluidCount, ownEnd()): what is computed per particle is
  /// computed for them, and sums over all particles are sums over them.
  TREACLE_HD std::uint32_t ownFluid() const { return fluidCount - ghostFluid; }
  TREACLE_HD std::uint32_t ownEnd() const { return activeCount - ghostWalls; }

  /// f(i) for the own fluid particles of a cell, whose particles are all own or all ghosts; then for own walls.
  template <class F>
  TREACLE_HD void forEachOwnFluid(std::size_t cell, F&& f) const {
    if (cells.fluidBegin[cell] >= ownFluid()) return;
    for (std::uint32_t i = cells.fluidBegin[cell]; i < cells.fluidEnd[cell]; ++i) f(i);
  }
  template <class F>
  TREACLE_HD void forEachOwnWall(std::size_t cell, F&& f) const {
    if (cells.wallBegin[cell] >= ownEnd()) return;
    for (std::uint32_t i = cells.wallBegin[cell]; i < cells.wallEnd[cell]; ++i) f(i);
  }
};

}  // namespace treacle
