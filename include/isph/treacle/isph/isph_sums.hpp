#pragma once

#include "treacle/isph/isph_flow.hpp"
#include "treacle/isph/isph_matrix.hpp"
#include "treacle/isph/isph_pressure_terms.hpp"
#include "treacle/isph/isph_terms.hpp"
#include "treacle/isph/isph_turbulence.hpp"
#include "treacle/isph/isph_viscous_terms.hpp"

#include <span>

namespace treacle {

/// Sums of ISPH over neighbours (isph_terms.hpp), made for own particles. What a term reads of neighbours must be
/// there for ghosts, too (fillGhosts). All in the backend's memory.

/// Calls `term` for every neighbour of every own fluid particle, walls included.
template <int D, class Term, class Backend>
void sumOnFluid(Context<Backend>&, const IsphPairs<D>& pairs, const Term& term);

/// The same for those that have walls around them; term.storeAway(pairs, i) for the others.
template <int D, class Term, class Backend>
void sumBesideWalls(Context<Backend>&, const IsphPairs<D>& pairs, const Term& term);

/// The same for the fluid neighbours of every own active wall particle.
template <int D, class Term, class Backend>
void sumOnWalls(Context<Backend>&, const IsphPairs<D>& pairs, const Term& term);

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

/// A coefficient as it is stored, and rounded to whole units.
struct StoredCoefficient {
  double value;
  int whole;
};

/// What a matrix of pairs consists of, on the rows of `pairs`; packed or not (IsphMatrix).
template <int D, class T>
struct IsphMatrixParts {
  std::span<T> coefficient;  // per entry of the fluid rows; empty where packed
  PackedEntriesView packed;
  double unit;
  std::span<double> diagonal;
  std::span<T> inverseNear;
  std::span<IsphMoments<D>> moments;

  TREACLE_HD StoredCoefficient put(std::uint64_t k, double c) const {
    const T stored = coefficient[k] = static_cast<T>(c);
    return {static_cast<double>(stored), static_cast<int>(stored * static_cast<T>(1 / unit) + T(0.5))};
  }
  /// The same of a packed matrix; `place` of the column in the row's block.
  TREACLE_HD StoredCoefficient putPacked(std::uint64_t k, std::uint32_t place, double c) const {
    const std::uint32_t word = packed.word[k] = PackedEntry::word(place, c, unit);
    return {unit / PackedEntry::parts * PackedEntry::value(word), static_cast<int>(PackedEntry::whole(word))};
  }
};

/// The column blocks of own fluid, and room for the entries of a matrix on its rows.
template <int D>
void preparePacked(Context<Cuda>&, const IsphPairs<D>& pairs, PackedEntries<Cuda>& packed);

/// Fills the parts of a matrix whose rows are PressureRow or ViscousRow. Diagonals are made of the coefficients as
/// they are stored: a matrix in single precision is another one, but no less symmetric and semidefinite.
template <int D, class T, class Row, class Backend>
void fillIsphMatrix(Context<Backend>&, const IsphPairs<D>& pairs, const Row& row,
                    const IsphMatrixParts<D, T>& parts);

/// What both backends do with a row of such a matrix.
template <int D, class T, class Row>
struct IsphMatrixRow {
  static constexpr int moments = D * (D + 1) / 2, values = 3 + moments;
  enum { Known, All, Near, Moments };  // places of the sums

  const IsphPairs<D>& pairs;
  const Row& row;
  const IsphMatrixParts<D, T>& parts;

  /// Entry k of row i, at x, `near` or far; put(j, c) stores it.
  template <class Put>
  TREACLE_HD void entry(std::uint32_t i, const Vec<D>& x, std::uint64_t k, bool near, double* sum,
                        Put&& put) const {
    const std::uint32_t j = pairs.fluidOfFluid.column[k];
    double c = 0;
    Vec<D> d{};
    if (row.isUnknown(i) && j != i) {
      d = pairs.grid.difference(x, pairs.position[j]);
      c = row.coefficient(pairs, i, j, d, Distance(d));
      if (!row.isUnknown(j)) {
        sum[Known] += c;
        c = 0;
      }
    }
    const StoredCoefficient stored = put(j, c);
    sum[All] += stored.value;
    if (near) sum[Near] += parts.unit * stored.whole;
    addSquare(0.5 * stored.value, d, sum + Moments);
  }
  /// A wall next to it.
  TREACLE_HD void wall(std::uint32_t i, const Vec<D>& x, std::uint64_t k, double* sum) const {
    if (!row.isUnknown(i)) return;
    const std::uint32_t j = pairs.wallsOfFluid.column[k];
    const Vec<D> d = pairs.grid.difference(x, pairs.position[j]);
    sum[Known] += row.wall(pairs, i, j, d, Distance(d));
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

/// For the sources of both backends.
#define TREACLE_ISPH_SUMS(D, Backend)                                                              \
  template void sumOnFluid(Context<Backend>&, const IsphPairs<D>&, const DensityTerm<D>&);         \
  template void sumOnFluid(Context<Backend>&, const IsphPairs<D>&, const PredictorTerm<D>&);       \
  template void sumOnFluid(Context<Backend>&, const IsphPairs<D>&,                                 \
                           const BothTerms<DensityTerm<D>, PredictorTerm<D>>&);                    \
  template void sumOnFluid(Context<Backend>&, const IsphPairs<D>&,                                 \
                           const BothTerms<DensityTerm<D>, SmoothFlowTerm<D>>&);                   \
  template void sumOnFluid(Context<Backend>&, const IsphPairs<D>&, const EddyTerm<D>&);            \
  template void sumOnFluid(Context<Backend>&, const IsphPairs<D>&, const ViscousSourceTerm<D>&);   \
  template void sumOnFluid(Context<Backend>&, const IsphPairs<D>&, const PressureSourceTerm<D>&);  \
  template void sumOnFluid(Context<Backend>&, const IsphPairs<D>&, const CorrectorTerm<D>&);       \
  template void sumOnFluid(Context<Backend>&, const IsphPairs<D>&, const OutsideTerm<D>&);         \
  template void sumOnFluid(Context<Backend>&, const IsphPairs<D>&, const WallFrictionTerm<D>&);    \
  template void sumBesideWalls(Context<Backend>&, const IsphPairs<D>&, const AcrossWallsTerm<D>&); \
  template void sumOnWalls(Context<Backend>&, const IsphPairs<D>&, const WallPressureTerm<D>&);    \
  template void sumOnWalls(Context<Backend>&, const IsphPairs<D>&, const WallForceTerm<D>&);       \
  TREACLE_ISPH_MATRIX(D, double, PressureRow<D>, Backend)                                          \
  TREACLE_ISPH_MATRIX(D, float, PressureRow<D>, Backend)                                           \
  TREACLE_ISPH_MATRIX(D, double, ViscousRow<D>, Backend)                                           \
  TREACLE_ISPH_MATRIX(D, float, ViscousRow<D>, Backend)
#define TREACLE_ISPH_MATRIX(D, T, Row, Backend) \
  template void fillIsphMatrix(Context<Backend>&, const IsphPairs<D>&, const Row&, const IsphMatrixParts<D, T>&);

}  // namespace treacle
