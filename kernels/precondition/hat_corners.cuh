#pragma once

#include "treacle/precondition/hat_cells.hpp"

namespace treacle {

/// Hat of a corner of a cell at a place in it; bit k of `corner`: the upper one of axis k.
template <int D, class T>
__device__ inline T cornerWeight(const Vec<D, T>& place, int corner) {
  T weight = 1;
  for (int k = 0; k < D; ++k) weight *= corner >> k & 1 ? place[k] : 1 - place[k];
  return weight;
}

/// Which corner of a cell a node is: bit k is set for the upper one of axis k.
template <int D>
__device__ inline int cornerOf(const HatCells<D>& cells, const Vec<D, int>& node, const Vec<D, int>& cell) {
  int corner = 0;
  for (int k = 0; k < D; ++k) corner |= cells.above(node[k], cell[k], k) << k;
  return corner;
}

/// The cell below a node with bit k of `corner` set, else above it; false where there is none.
template <int D>
__device__ inline bool cellBeside(const HatCells<D>& cells, Vec<D, int>& cell, int corner) {
  bool inside = true;
  for (int k = 0; k < D; ++k) {
    cell[k] -= corner >> k & 1;
    if (cells.grid.periodic[k] && cell[k] < 0) cell[k] += cells.grid.count[k];
    inside = inside && cell[k] >= 0 && cell[k] < cells.grid.count[k];
  }
  return inside;
}

}  // namespace treacle
