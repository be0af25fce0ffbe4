#pragma once

#include "treacle/core/macros.hpp"
#include "treacle/search/cell_grid.hpp"
#include "treacle/search/cell_sort.hpp"

namespace treacle {

template <int D>
TREACLE_HD constexpr int power(int base) {
  return D == 2 ? base * base : base * base * base;
}

/// The adjacent cells of a cell, itself in the middle, are counted by three digits, 0 … 3^D-1, and the corners of
/// a cell, as of the cells that a column of R C touches, by two.
template <int D>
TREACLE_HD Vec<D, int> digits(int index, int base) {
  Vec<D, int> v{};
  for (int k = 0; k < D; ++k, index /= base) v[k] = index % base;
  return v;
}
template <int D>
TREACLE_HD Vec<D, int> adjacentOffset(int index) {
  Vec<D, int> v = digits<D>(index, 3);
  for (int k = 0; k < D; ++k) --v[k];
  return v;
}
/// The index of an offset.
template <int D>
TREACLE_HD int adjacentIndex(const Vec<D, int>& offset) {
  int index = 0;
  for (int k = D - 1; k >= 0; --k) index = 3 * index + offset[k] + 1;
  return index;
}

/// An adjacent cell, across periodic ends.
template <int D>
struct AdjacentCell {
  Vec<D, int> cell;    // inside the domain
  Vec<D> shift{};      // of its particles, as seen from the cell that it is adjacent to [m]
  bool inside = true;  // the domain
  std::size_t linear = 0;

  AdjacentCell() = default;
  TREACLE_HD AdjacentCell(const CellGrid<D>& grid, const Vec<D, int>& own, const Vec<D, int>& offset)
      : cell(own + offset) {
    for (int k = 0; k < D; ++k) {
      const int turn = cell[k] < 0 ? -1 : cell[k] >= grid.count[k] ? 1 : 0;
      inside = inside && (turn == 0 || grid.periodic[k]);
      cell[k] -= turn * grid.count[k];
      shift[k] = turn * grid.length[k];
    }
    if (inside) linear = grid.linear(cell);
  }
  TREACLE_HD bool occupied(const CellRangesView& ranges) const {
    return inside && ranges.fluidEnd[linear] > ranges.fluidBegin[linear];
  }
};

/// Cell b as seen from cell a, across periodic ends.
template <int D>
TREACLE_HD Vec<D, int> cellOffset(const CellGrid<D>& grid, const Vec<D, int>& a, const Vec<D, int>& b) {
  Vec<D, int> o = b - a;
  for (int k = 0; k < D; ++k)
    if (grid.periodic[k]) o[k] += o[k] > 1 ? -grid.count[k] : o[k] < -1 ? grid.count[k] : 0;
  return o;
}

/// A column k of R C touches at most two cells per axis: the particle's own, and on each axis the neighbour on the
/// side of the half that x_k stands in, because h_p is at most half an edge. Returns the lower of them, from its
/// own.
template <int D>
TREACLE_HD Vec<D, int> lowerCell(const CellGrid<D>& grid, const Vec<D>& x, const Vec<D, int>& cell) {
  Vec<D, int> lower{};
  for (int k = 0; k < D; ++k) lower[k] = x[k] < grid.origin[k] + (cell[k] + 0.5) * grid.edge[k] ? -1 : 0;
  return lower;
}

/// Place of a cell (as an offset from the lower one) among the 2^D vectors of a column; -1: not one of them.
template <int D>
TREACLE_HD int columnSlot(const Vec<D, int>& fromLower) {
  int slot = 0;
  for (int k = D - 1; k >= 0; --k) {
    if (fromLower[k] < 0 || fromLower[k] > 1) return -1;
    slot = 2 * slot + fromLower[k];
  }
  return slot;
}

}  // namespace treacle
