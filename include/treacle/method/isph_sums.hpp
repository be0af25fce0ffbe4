#pragma once

#include "treacle/linear/pair_matrix.hpp"
#include "treacle/method/isph_terms.hpp"

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
struct PairMoments {
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

/// What a matrix of pairs consists of, on the rows of `pairs`.
template <int D, class T>
struct PairMatrixParts {
  std::span<T> coefficient;  // per entry of the fluid rows
  std::span<double> diagonal;
  std::span<T> inverseNear;
  std::span<PairMoments<D>> moments;
};

/// Fills the parts of a matrix whose rows are PressureRow or ViscousRow. The diagonal is made of the coefficients
/// as they are stored: a matrix in single precision is another one, but no less symmetric and semidefinite.
template <int D, class T, class Row>
void fillPairMatrix(Context<Cpu>&, const IsphPairs<D>& pairs, const Row& row, const PairMatrixParts<D, T>& parts);
template <int D, class T, class Row>
void fillPairMatrix(Context<Cuda>&, const IsphPairs<D>& pairs, const Row& row, const PairMatrixParts<D, T>& parts);

/// Row i of a matrix of pairs: what both backends do.
template <int D, class T, class Row>
struct PairMatrixRow {
  const IsphPairs<D>& pairs;
  const Row& row;
  const PairMatrixParts<D, T>& parts;

  TREACLE_HD void fill(std::uint32_t i) const {
    const NeighbourRowsView& rows = pairs.fluidRows;
    const bool unknown = row.isUnknown(i);
    const Vec<D> x = pairs.position[i];
    double known = unknown ? row.own(pairs, i) : 0, near = 0, far = 0;
    double m[D * (D + 1) / 2] = {};
    const std::uint64_t begin = rows.rowStart[i], nearEnd = begin + rows.nearCount[i], end = rows.rowStart[i + 1];
    for (std::uint64_t k = begin; k < end; ++k) {
      const std::uint32_t j = rows.column[k];
      T c = 0;
      if (unknown && j != i) {
        const Vec<D> d = pairs.grid.difference(x, pairs.position[j]);
        const double exact = row.coefficient(pairs, i, j, norm(d));
        if (row.isUnknown(j)) {
          c = static_cast<T>(exact);
          (k < nearEnd ? near : far) += c;
          for (int a = 0, n = 0; a < D; ++a)
            for (int b = a; b < D; ++b, ++n) m[n] += 0.5 * exact * d[a] * d[b];
        } else {
          known += exact;
        }
      }
      parts.coefficient[k] = c;
    }
    for (std::uint64_t k = pairs.wallRows.rowStart[i]; unknown && k < pairs.wallRows.rowStart[i + 1]; ++k) {
      const std::uint32_t j = pairs.wallRows.column[k];
      known += row.wall(pairs, i, j, norm(pairs.grid.difference(x, pairs.position[j])));
    }
    parts.diagonal[i] = known + near + far;
    parts.inverseNear[i] = known + near > 0 ? static_cast<T>(1 / (known + near)) : T(0);
    PairMoments<D>& moments = parts.moments[i];
    for (int n = 0; n < D * (D + 1) / 2; ++n) moments.m[n] = static_cast<float>(m[n]);
    moments.own = static_cast<float>(known);
  }
};

}  // namespace treacle
