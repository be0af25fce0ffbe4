#pragma once

#include "treacle/mph/mph_pairs.hpp"
#include "treacle/precondition/hat_cells.hpp"

namespace treacle {

/// Calls f(k) for the own active particles of a cell, fluid and walls.
template <int D, class F>
inline void forEachParticle(const SortedParticles<D>& pairs, const Vec<D, int>& cell, F&& f) {
  const std::size_t c = pairs.grid.linear(cell);
  pairs.forEachOwnFluid(c, f);
  pairs.forEachOwnWall(c, f);
}

/// Calls f(corner, weight) for the corners of a cell at a place in it; bit k of `corner`: the upper one of axis k.
template <int D, class T, class F>
inline void forEachCorner(const Vec<D, T>& place, F&& f) {
  for (int o = 0; o < 1 << D; ++o) {
    T weight = 1;
    for (int k = 0; k < D; ++k) weight *= o >> k & 1 ? place[k] : 1 - place[k];
    f(o, weight);
  }
}

template <int D, class T>
inline Vec<D> toDouble(const Vec<D, T>& v) {
  Vec<D> r;
  for (int k = 0; k < D; ++k) r[k] = v[k];
  return r;
}

}  // namespace treacle
