#pragma once

#include "treacle/core/symmetric_block.hpp"
#include "treacle/core/vec.hpp"

#include <cmath>

namespace treacle {

/// How a fluid particle sees walls along which it slips: what of a vector is along all of them, and so does not
/// act between it and their particles (MphPairs::alongWall).
///
/// A flat wall leaves out what is in its plane, and near an edge or in a corner of two walls only what is along
/// both. The parts along one face are the pressure of the other one there, and without them a uniform pressure
/// would push a closed body. All walls of a particle leave out the same, so that the sum over a curved wall keeps
/// its pressure.
template <int D>
struct SlipSide {
  double whole = 0, part = 0;  // the part along is whole v + part (axis . v) axis
  Vec<D> axis{};

  /// The walls are flat or nearly so, with this mean normal of length 1.
  TREACLE_HD static SlipSide ofPlane(const Vec<D>& normal) { return {1, -1, normal}; }
  /// Nothing but what is along this direction, of length 1.
  TREACLE_HD static SlipSide ofLine(const Vec<D>& direction) { return {0, 1, direction}; }

  TREACLE_HD Vec<D> along(const Vec<D>& v) const { return whole * v + (part * dot(axis, v)) * axis; }
};

/// The eigenvector of the largest eigenvalue of a matrix without negative ones, of length 1; zero if there is
/// none.
template <int D>
TREACLE_HD Vec<D> mainAxis(SymmetricBlock<D> m) {
  for (int squarings = 0; squarings < 4; ++squarings) {
    const double size = trace(m);
    if (!(size > 0)) return {};
    SymmetricBlock<D> square{};
    for (int r = 0; r < D; ++r)
      for (int c = r; c < D; ++c)
        for (int k = 0; k < D; ++k) square(r, c) += m(r, k) * m(k, c) / (size * size);
    m = square;
  }
  int most = 0;
  for (int k = 1; k < D; ++k)
    if (m(k, k) > m(most, most)) most = k;
  Vec<D> column;
  for (int k = 0; k < D; ++k) column[k] = m(k, most);
  return (1 / norm(column)) * column;
}

/// The part of a face's normal that is not along the mean one, of length 1, where both differ by so much that they
/// are of two walls; else zero. A wall with a radius of 10 spacings turns by less within the radius of pressures.
template <int D>
TREACLE_HD Vec<D> otherNormal(const Vec<D>& normal, const Vec<D>& mean) {
  constexpr double turned = 0.25;  // sine of the angle
  const Vec<D> rest = normal - dot(normal, mean) * mean;
  const double size = norm(rest);
  return size > turned ? (1 / size) * rest : Vec<D>{};
}

/// From the mean normal and the sum of the others, each times itself.
template <int D>
TREACLE_HD SlipSide<D> slipSideOf(const Vec<D>& mean, const SymmetricBlock<D>& others) {
  if (mean == Vec<D>{}) return {};
  const double size = trace(others);
  if (size == 0) return SlipSide<D>::ofPlane(mean);
  if constexpr (D == 3) {
    const Vec<3> other = mainAxis(others);
    constexpr double oneLine = 0.95;  // share of the largest eigenvalue
    if (dot(other, others * other) > oneLine * size) return SlipSide<3>::ofLine(cross(mean, other));
  }
  return {};
}

}  // namespace treacle
