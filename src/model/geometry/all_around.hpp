#pragma once

#include "treacle/core/vec.hpp"

namespace treacle {

/// Whether `holds(x)` is true of a place and of those so far from it along the axes, both ways [m].
template <int D, class Holds>
bool allAround(const Vec<D>& x, double distance, const Holds& holds) {
  if (!holds(x)) return false;
  for (int k = 0; k < D; ++k)
    for (const double way : {-distance, distance}) {
      Vec<D> beside = x;
      beside[k] += way;
      if (!holds(beside)) return false;
    }
  return true;
}

}  // namespace treacle
