#pragma once

#include "treacle/isph/isph_matrix.hpp"
#include "treacle/isph/isph_terms.hpp"

#include <span>

namespace treacle {

/// Sums of ISPH over neighbours (isph_terms.hpp). Spans "per fluid particle" have fluidCount elements, "per
/// particle" activeCount; all in the backend's memory.

/// Calls `term` for every neighbour of every fluid particle, walls included.
template <int D, class Term>
void sumOnFluid(Context<Cpu>&, const IsphPairs<D>& pairs, const Term& term);
template <int D, class Term>
void sumOnFluid(Context<Cuda>&, const IsphPairs<D>& pairs, const Term& term);

/// The same for the fluid neighbours of every active wall particle.
template <int D, class Term>
void sumOnWalls(Context<Cpu>&, const IsphPairs<D>& pairs, const Term& term);
template <int D, class Term>
void sumOnWalls(Context<Cuda>&, const IsphPairs<D>& pairs, const Term& term);

/// What Galerkin operators take from the pairs of a particle: half the sum of c d d^T over the unknown ones, upper
/// triangle, and the part of the diagonal that no pair of unknowns makes.
template <int D>
struct IsphMoments {
  float m[D * (D + 1) / 2];
  float own;

  /// p^T M q
  TREACLE_HD float between(const Vec<D, float>& p, const Vec<D, float>& q) const {
    float sum = 0;
    for (int a = 0, n = 0; a < D; ++a)
      for (int b = a; b < D; ++b, ++n) sum += m[n] * (a == b ? p[a] * q[a] : p[a] * q[b] + p[b] * q[a]);
    return sum;
  }
};

/// What a matrix of pairs consists of, on the rows of `pairs`; packed or not (IsphMatrix).
template <int D, class T>
struct IsphMatrixParts {
  std::span<T> coefficient;  // per entry of the fluid rows; empty where packed
  std::span<std::uint32_t> word;
  std::span<std::uint16_t> low;
  double unit;
  std::span<double> diagonal;
  std::span<T> inverseNear;
  std::span<IsphMoments<D>> moments;

  /// Stores entry k, which stands for column j; returns it as it is stored.
  TREACLE_HD double put(std::uint64_t k, std::uint32_t j, double c) const {
    if (word.empty()) return coefficient[k] = static_cast<T>(c);
    word[k] = PackedEntry::word(j, c, unit);
    low[k] = PackedEntry::low(c, unit);
    return unit * PackedEntry::value(word[k], low[k]);
  }
};

/// Fills the parts of a matrix whose rows are PressureRow or ViscousRow. Diagonals are made of the coefficients as
/// they are stored: a matrix in single precision is another one, but no less symmetric and semidefinite.
template <int D, class T, class Row>
void fillIsphMatrix(Context<Cpu>&, const IsphPairs<D>& pairs, const Row& row, const IsphMatrixParts<D, T>& parts);
template <int D, class T, class Row>
void fillIsphMatrix(Context<Cuda>&, const IsphPairs<D>& pairs, const Row& row, const IsphMatrixParts<D, T>& parts);

/// What both backends do with a row of such a matrix.
template <int D, class T, class Row>
struct IsphMatrixRow {
  static constexpr int moments = D * (D + 1) / 2, values = 3 + moments;
  enum { Known, All, Near, Moments };  // places of the sums

  const IsphPairs<D>& pairs;
  const Row& row;
  const IsphMatrixParts<D, T>& parts;

  /// Entry k of row i, at x.
  TREACLE_HD void entry(std::uint32_t i, const Vec<D>& x, std::uint64_t k, double* sum) const {
    const NeighbourRowsView& rows = pairs.fluidOfFluid;
    const std::uint32_t j = rows.column[k];
    double c = 0;
    Vec<D> d{};
    if (row.isUnknown(i) && j != i) {
      d = pairs.grid.difference(x, pairs.position[j]);
      c = row.coefficient(pairs, i, j, Distance(d));
      if (!row.isUnknown(j)) {
        sum[Known] += c;
        c = 0;
      }
    }
    const double stored = parts.put(k, j, c);
    sum[All] += stored;
    if (k < rows.start[rows.count])
      sum[Near] += parts.unit * static_cast<int>(static_cast<T>(stored) * static_cast<T>(1 / parts.unit) + T(0.5));
    for (int a = 0, n = Moments; a < D; ++a)
      for (int b = a; b < D; ++b, ++n) sum[n] += 0.5 * stored * d[a] * d[b];
  }
  /// A wall next to it.
  TREACLE_HD void wall(std::uint32_t i, const Vec<D>& x, std::uint64_t k, double* sum) const {
    if (!row.isUnknown(i)) return;
    const std::uint32_t j = pairs.wallsOfFluid.column[k];
    sum[Known] += row.wall(pairs, i, j, Distance(pairs.grid.difference(x, pairs.position[j])));
  }
  TREACLE_HD void finish(std::uint32_t i, const double* sum) const {
    const double known = row.isUnknown(i) ? sum[Known] + row.own(pairs, i) : 0;
    const double near = known + sum[Near];
    parts.diagonal[i] = known + sum[All];
    parts.inverseNear[i] = near > 0 ? static_cast<T>(1 / near) : T(0);
    IsphMoments<D>& m = parts.moments[i];
    for (int n = 0; n < moments; ++n) m.m[n] = static_cast<float>(sum[Moments + n]);
    m.own = static_cast<float>(known);
  }
};

}  // namespace treacle
