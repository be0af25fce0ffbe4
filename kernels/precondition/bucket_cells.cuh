#pragma once

#include "core/launch.hpp"
#include "treacle/precondition/bucket_cells.hpp"

namespace treacle {

/// Bit o: the adjacent cell o has fluid. For a whole warp; D = 3 takes 27 of its lanes.
template <int D>
__device__ unsigned occupiedNeighbours(const CellGrid<D>& grid, const CellRangesView& ranges,
                                       const Vec<D, int>& cell) {
  const int o = threadIdx.x % 32;
  return __ballot_sync(~0u, o < power<D>(3) && AdjacentCell<D>(grid, cell, adjacentOffset<D>(o)).occupied(ranges));
}

}  // namespace treacle
