#pragma once

#include "treacle/core/backend.hpp"
#include "treacle/core/buffer.hpp"
#include "treacle/core/cuda.hpp"
#include "treacle/search/cell_grid.hpp"
#include "treacle/search/sorted_particles.hpp"

#include <cstdint>

namespace treacle {

/// Whose rows, and who stands in them.
enum class RowKind {
  FluidOfFluid,  // the fluid around each own fluid particle, itself included: also the pattern of a matrix
  WallsOfFluid,  // the walls around each own fluid particle
  FluidOfWalls   // the fluid around each own active wall particle
};

/// Neighbours of every particle in compressed rows, in two sections: first the near neighbours of all rows, then
/// the far ones. Row k, of particle first + k, is column[start[k] … start[k+1]-1] and column[start[count+k] …
/// start[count+k+1]-1]. Of a pair the nearest periodic images are meant (CellGrid::difference).
struct NeighbourRowsView {
  std::uint32_t first = 0, count = 0;
  const std::uint64_t* start = nullptr;
  const std::uint32_t* column = nullptr;

  /// f(k) for the places of every `step`-th neighbour in each section of a row, from number `from` on.
  template <class F>
  TREACLE_HD void forEachPlace(std::uint32_t row, F&& f, std::uint32_t from = 0, std::uint32_t step = 1) const {
    for (const std::uint64_t section : {std::uint64_t{row}, std::uint64_t{count} + row})
      for (std::uint64_t k = start[section] + from, end = start[section + 1]; k < end; k += step) f(k);
  }
  TREACLE_HD bool isEmpty(std::uint32_t row) const {
    const std::uint64_t far = std::uint64_t{count} + row;
    return start[row] == start[row + 1] && start[far] == start[far + 1];
  }
};

template <class Backend = Cpu>
struct NeighbourRows {
  std::uint32_t first = 0, count = 0;
  Buffer<std::uint64_t, Backend> start;  // 2 count + 1
  Buffer<std::uint32_t, Backend> column;

  NeighbourRowsView view() const { return {first, count, start.data(), column.data()}; }
  std::size_t bytes() const { return start.bytes() + column.bytes(); }
};

struct RowRadii {
  double near, far;  // [m]
};

/// Fills the rows with all particles of the kind within the far radius, ghosts included, in the order of the cells
/// around a particle.
template <int D>
void findNeighbours(Context<Cpu>&, const SortedParticles<D>& particles, RowRadii radii, RowKind kind,
                    NeighbourRows<>& rows);
template <int D>
void findNeighbours(Context<Cuda>&, const SortedParticles<D>& particles, RowRadii radii, RowKind kind,
                    NeighbourRows<Cuda>& rows);

/// The rows of a kind: whose they are, and who is looked for.
struct RowSearch {
  std::uint32_t first, count;
  bool walls;

  template <int D>
  static RowSearch make(RowKind kind, const SortedParticles<D>& particles) {
    const std::uint32_t walls = particles.fluidCount;
    if (kind == RowKind::FluidOfWalls) return {walls, particles.ownEnd() - walls, false};
    return {0, particles.ownFluid(), kind == RowKind::WallsOfFluid};
  }
};

/// Calls f(j, near) for the neighbours of particle i.
template <int D, class F>
TREACLE_HD void forEachNeighbour(const SortedParticles<D>& particles, std::uint32_t i, const RowRadii& radii,
                                 bool walls, F&& f) {
  const CellGrid<D>& grid = particles.grid;
  const CellRangesView& cells = particles.cells;
  const Vec<D>* position = particles.position.data();
  const Vec<D> x = position[i];
  const double near2 = radii.near * radii.near, far2 = radii.far * radii.far;
  forEachAdjacentCell(grid, grid.cellOf(x), [&](const Vec<D, int>& cell) {
    const std::size_t c = grid.linear(cell);
    const std::uint32_t end = walls ? cells.wallEnd[c] : cells.fluidEnd[c];
    for (std::uint32_t j = walls ? cells.wallBegin[c] : cells.fluidBegin[c]; j < end; ++j) {
      const double r2 = norm2(grid.difference(x, position[j]));
      if (r2 < far2 && !particles.areParted(i, j)) f(j, r2 < near2);
    }
  });
}

}  // namespace treacle
