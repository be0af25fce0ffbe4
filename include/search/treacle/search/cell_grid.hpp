#pragma once

#include "treacle/core/macros.hpp"
#include "treacle/core/vec.hpp"
#include "treacle/search/hilbert.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace treacle {

/// Search cells that tile the domain: floor(extent / radius) per axis, so that an edge is at least the radius.
/// They are also the buckets of the multigrid's finest level [K23 sect. 3.2].
template <int D>
struct CellGrid {
  /// Sort keys resolve a cell into 2^subBits parts per axis, so that consecutive particles are close together.
  static constexpr int subBits = 2;
  /// Keys have 62 bits; the others tell groups of particles apart (cell_sort.hpp).
  static constexpr int maxBits = 62 / D - subBits;

  Vec<D> origin{};       // lower corner of the domain [m]
  Vec<D> length{};       // of the domain [m]
  Vec<D> edge{};         // of a cell [m]
  Vec<D> inverseEdge{};  // [1/m]
  Vec<D, int> count{};   // cells per axis
  Vec<D, bool> periodic{};
  int bits = 1;  // 2^bits cells per axis suffice

  /// `radius`: largest interaction range [m], at most the domain's length on periodic axes / 3.
  static CellGrid make(const Vec<D>& min, const Vec<D>& max, const Vec<D, bool>& periodic, double radius) {
    CellGrid g;
    g.origin = min;
    g.length = max - min;
    g.periodic = periodic;
    for (int k = 0; k < D; ++k) {
      // The guard keeps a domain of exactly n radii at n cells when the quotient rounds below n. Where there would
      // be more cells than keys tell apart they are larger.
      const double cells = std::floor(g.length[k] / radius * (1 + 1e-12));
      g.count[k] = static_cast<int>(std::clamp(cells, 1.0, static_cast<double>(1 << maxBits)));
      g.edge[k] = g.length[k] / g.count[k];
      g.inverseEdge[k] = g.count[k] / g.length[k];
      while ((1 << g.bits) < g.count[k]) ++g.bits;
    }
    return g;
  }

  std::size_t cellCount() const {
    std::size_t n = 1;
    for (int k = 0; k < D; ++k) n *= static_cast<std::size_t>(count[k]);
    return n;
  }

  TREACLE_HD Vec<D, int> cellOf(const Vec<D>& x) const {
    Vec<D, int> c{};
    for (int k = 0; k < D; ++k)
      c[k] = clampCell(static_cast<int>(std::floor((x[k] - origin[k]) * inverseEdge[k])), k);
    return c;
  }

  TREACLE_HD std::size_t linear(const Vec<D, int>& c) const {
    std::size_t index = 0;
    for (int k = D - 1; k >= 0; --k) index = index * count[k] + c[k];
    return index;
  }

  /// The inverse of linear().
  TREACLE_HD Vec<D, int> cellAt(std::size_t index) const {
    Vec<D, int> c{};
    for (int k = 0; k < D; ++k) {
      c[k] = static_cast<int>(index % count[k]);
      index /= count[k];
    }
    return c;
  }

  /// A difference of two places in the domain, with the second one at its nearest periodic image [m].
  TREACLE_HD Vec<D> nearest(Vec<D> d) const {
    for (int k = 0; k < D; ++k) {
      if (!periodic[k]) continue;
      if (d[k] > 0.5 * length[k]) d[k] -= length[k];
      if (d[k] < -0.5 * length[k]) d[k] += length[k];
    }
    return d;
  }
  /// From x to the nearest periodic image of y [m], for both inside the domain.
  TREACLE_HD Vec<D> difference(const Vec<D>& x, const Vec<D>& y) const { return nearest(y - x); }

  /// The periodic image of y that is nearest to x [m], for both inside the domain; where y is halfway, y itself.
  TREACLE_HD Vec<D> beside(const Vec<D>& x, Vec<D> y) const {
    for (int k = 0; k < D; ++k) {
      if (!periodic[k]) continue;
      const double away = y[k] - x[k];
      if (away > 0.5 * length[k]) y[k] -= length[k];
      if (away < -0.5 * length[k]) y[k] += length[k];
    }
    return y;
  }

  /// Sort key: Hilbert index at the resolution of sub-cells. key >> (D subBits) is the cell's Hilbert index, and
  /// each further shift by D that of the bucket one level coarser.
  TREACLE_HD std::uint64_t key(const Vec<D>& x) const {
    Vec<D, std::uint32_t> p{};
    for (int k = 0; k < D; ++k) {
      const double s = (x[k] - origin[k]) * inverseEdge[k];
      const int cell = clampCell(static_cast<int>(std::floor(s)), k);
      // Not by (s - cell): that may be fused with the product in s, and hosts and devices would differ.
      int sub = static_cast<int>(std::floor(s * (1 << subBits))) - (cell << subBits);
      sub = sub < 0 ? 0 : sub >= (1 << subBits) ? (1 << subBits) - 1 : sub;
      p[k] = static_cast<std::uint32_t>(cell << subBits | sub);
    }
    return hilbertIndex<D>(p, bits + subBits);
  }

  /// Moves x by whole domain lengths into the domain on periodic axes. Returns false where it lies outside on an
  /// open one (or is not finite).
  TREACLE_HD bool wrap(Vec<D>& x) const {
    for (int k = 0; k < D; ++k) {
      if (periodic[k]) {
        x[k] -= length[k] * std::floor((x[k] - origin[k]) / length[k]);
        // Rounding of a value just below the lower end, or of one just below the upper end, whose quotient is a
        // whole one.
        if (x[k] >= origin[k] + length[k] || x[k] < origin[k]) x[k] = origin[k];
      }
      if (!(x[k] >= origin[k] && x[k] <= origin[k] + length[k])) return false;
    }
    return true;
  }

 private:
  TREACLE_HD int clampCell(int c, int k) const { return c < 0 ? 0 : c >= count[k] ? count[k] - 1 : c; }
};

/// Calls f with the cell itself and each one that touches it, across periodic ends too; with the same one several
/// times where a periodic axis has fewer than three cells.
template <int D, class F>
TREACLE_HD void forEachAdjacentCell(const CellGrid<D>& grid, const Vec<D, int>& cell, F&& f) {
  int offsets = 1;
  for (int k = 0; k < D; ++k) offsets *= 3;
  for (int o = 0; o < offsets; ++o) {
    Vec<D, int> c = cell;
    bool inside = true;
    for (int k = 0, digits = o; k < D; ++k, digits /= 3) {
      c[k] += digits % 3 - 1;
      if (grid.periodic[k])
        c[k] = (c[k] + grid.count[k]) % grid.count[k];
      else
        inside = inside && c[k] >= 0 && c[k] < grid.count[k];
    }
    if (inside) f(c);
  }
}

}  // namespace treacle
