#pragma once

#include "treacle/core/vec.hpp"
#include "treacle/model/case/case.hpp"
#include "treacle/search/cell_grid.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace treacle {

/// The cells in which gas is looked for: no wider than a spacing, as particles would leave holes in wider ones.
template <int D>
struct GasGrid : CellGrid<D> {
  explicit GasGrid(const Case& c) : CellGrid<D>(cellsOf(c)) {}

  Vec<D> centerOf(std::size_t cell) const {
    const Vec<D, int> i = this->cellAt(cell);
    Vec<D> x;
    for (int k = 0; k < D; ++k) x[k] = this->origin[k] + (i[k] + 0.5) * this->edge[k];
    return x;
  }

  /// Calls f(cell) for the cells around one and itself.
  template <class F>
  void forEachAround(std::size_t cell, F&& f) const {
    forEachAdjacentCell(*this, this->cellAt(cell), [&](const Vec<D, int>& at) { f(this->linear(at)); });
  }

  /// The same for the cells that share a face with one.
  template <class F>
  void forEachNext(std::size_t cell, F&& f) const {
    const Vec<D, int> middle = this->cellAt(cell);
    std::size_t stride = 1;
    for (int k = 0; k < D; ++k) {
      const auto cells = static_cast<std::size_t>(this->count[k]);
      const bool wraps = this->periodic[k];
      if (middle[k] > 0)
        f(cell - stride);
      else if (wraps)
        f(cell + (cells - 1) * stride);
      if (middle[k] + 1 < this->count[k])
        f(cell + stride);
      else if (wraps)
        f(cell - (cells - 1) * stride);
      stride *= cells;
    }
  }

  /// Calls f(cell, weight, gradient) for the cells of the quadratic B-spline at x.
  template <class F>
  void forEachWeight(const Vec<D>& x, F&& f) const {
    forEachAround(this->linear(this->cellOf(x)), [&](std::size_t cell) {
      const Vec<D> d = this->difference(centerOf(cell), x);
      double weight = 1;
      Vec<D> gradient = Vec<D>::filled(1);
      for (int k = 0; k < D; ++k) {
        const Spline spline(d[k] * this->inverseEdge[k]);
        weight *= spline.weight;
        for (int a = 0; a < D; ++a) gradient[a] *= a == k ? spline.slope * this->inverseEdge[k] : spline.weight;
      }
      f(cell, weight, gradient);
    });
  }

 private:
  /// At the distance t from the centre of a cell, in cells, and its slope.
  struct Spline {
    double weight, slope;

    explicit Spline(double t) {
      const double outside = 1.5 - std::abs(t);
      if (outside > 1)
        weight = 0.75 - t * t, slope = -2 * t;
      else
        weight = 0.5 * outside * outside, slope = std::copysign(outside, -t);
    }
  };

  static CellGrid<D> cellsOf(const Case& c) {
    Vec<D, bool> periodic{};
    for (int k = 0; k < D; ++k) periodic[k] = c.domain.periodic[static_cast<std::size_t>(k)];
    auto grid = CellGrid<D>::make(resized<D>(c.domain.min), resized<D>(c.domain.max), periodic, c.spacing);
    for (int k = 0; k < D; ++k) {
      grid.count[k] = std::max(3, static_cast<int>(std::ceil(grid.length[k] / c.spacing - 1e-6)));
      grid.edge[k] = grid.length[k] / grid.count[k];
      grid.inverseEdge[k] = grid.count[k] / grid.length[k];
    }
    return grid;
  }
};

}  // namespace treacle
