#pragma once

#include "treacle/core/macros.hpp"
#include "treacle/search/cell_grid.hpp"

namespace treacle {

/// Where particles stand among the nodes of the background grid, which are the corners of the search cells: node n
/// is the lower corner of cell n. Periodic axes have as many nodes as cells, open ones one more.
template <int D>
struct HatCells {
  CellGrid<D> grid;

  TREACLE_HD int nodesOn(int axis) const { return grid.count[axis] + (grid.periodic[axis] ? 0 : 1); }

  /// The cell (CellGrid::linear) that a node is at the lower corner of; of nodes at an open end the cell below.
  TREACLE_HD std::size_t cellOfNode(const Vec<D, int>& node) const {
    Vec<D, int> cell = node;
    for (int k = 0; k < D; ++k)
      if (cell[k] == grid.count[k]) --cell[k];
    return grid.linear(cell);
  }

  /// Place of x in its cell, 0 … 1 per axis.
  TREACLE_HD Vec<D> fraction(const Vec<D>& x, const Vec<D, int>& cell) const {
    Vec<D> f;
    for (int k = 0; k < D; ++k) {
      const double s = (x[k] - grid.origin[k]) * grid.inverseEdge[k] - cell[k];
      f[k] = s < 0 ? 0 : s > 1 ? 1 : s;
    }
    return f;
  }

  /// Node `node` seen from cell or node `from`, across a periodic end: 0, 1, 2, … upwards; negative: below it.
  TREACLE_HD int above(int node, int from, int axis) const {
    const int n = grid.count[axis], rel = node - from;
    return !grid.periodic[axis] ? rel : rel < 0 ? rel + n : rel >= n ? rel - n : rel;
  }

  /// Hat of a node at a particle of a cell: `f` its place in there.
  TREACLE_HD double hat(const Vec<D, int>& node, const Vec<D, int>& cell, const Vec<D>& f) const {
    double w = 1;
    for (int k = 0; k < D; ++k) {
      const int rel = above(node[k], cell[k], k);
      w *= rel == 0 ? 1 - f[k] : rel == 1 ? f[k] : 0;
    }
    return w;
  }

  /// The same and its gradient [1/m], in the precision of `f`; the node must be a corner of the cell.
  template <class T>
  TREACLE_HD void cornerHat(const Vec<D, int>& node, const Vec<D, int>& cell, const Vec<D, T>& f, T& value,
                            Vec<D, T>& gradient) const {
    T one[D];
    value = 1;
    for (int k = 0; k < D; ++k) {
      one[k] = above(node[k], cell[k], k) == 1 ? f[k] : 1 - f[k];
      value *= one[k];
    }
    for (int k = 0; k < D; ++k) {
      gradient[k] = static_cast<T>(above(node[k], cell[k], k) == 1 ? grid.inverseEdge[k] : -grid.inverseEdge[k]);
      for (int other = 0; other < D; ++other)
        if (other != k) gradient[k] *= one[other];
    }
  }
  TREACLE_HD bool isCorner(const Vec<D, int>& node, const Vec<D, int>& cell) const {
    bool corner = true;
    for (int k = 0; k < D; ++k) {
      const int rel = above(node[k], cell[k], k);
      corner = corner && (rel == 0 || rel == 1);
    }
    return corner;
  }

  /// Neighbours within h_p of a particle touch three nodes per axis, because h_p is at most half an edge. The
  /// lowest of them, not wrapped: -1 means the last one.
  TREACLE_HD Vec<D, int> lowestNode(const Vec<D, int>& cell, const Vec<D>& f) const {
    Vec<D, int> lowest;
    for (int k = 0; k < D; ++k) lowest[k] = f[k] < 0.5 ? cell[k] - 1 : cell[k];
    return lowest;
  }

  /// Place of a node among the 3^D from `lowest` on; -1: not one of them.
  TREACLE_HD int slot(const Vec<D, int>& node, const Vec<D, int>& lowest) const {
    int s = 0;
    for (int k = D - 1; k >= 0; --k) {
      const int rel = above(node[k], lowest[k], k);
      if (rel < 0 || rel > 2) return -1;
      s = 3 * s + rel;
    }
    return s;
  }

  /// Calls f(cell) for the cells from `reach` below a node to `reach - 1` above it that exist, each once.
  template <class F>
  TREACLE_HD void forEachCellAround(const Vec<D, int>& node, int reach, F&& f) const {
    Vec<D, int> width;
    int total = 1;
    for (int k = 0; k < D; ++k) {
      width[k] = grid.periodic[k] && grid.count[k] < 2 * reach ? grid.count[k] : 2 * reach;
      total *= width[k];
    }
    for (int o = 0; o < total; ++o) {
      Vec<D, int> c;
      bool inside = true;
      for (int k = 0, rest = o; k < D; rest /= width[k], ++k) {
        c[k] = node[k] - reach + rest % width[k];
        if (grid.periodic[k])
          c[k] = (c[k] + grid.count[k]) % grid.count[k];
        else
          inside = inside && c[k] >= 0 && c[k] < grid.count[k];
      }
      if (inside) f(c);
    }
  }
};

}  // namespace treacle
