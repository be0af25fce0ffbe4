#pragma once

#include "treacle/mph/mph_pairs.hpp"

namespace treacle {

/// A vector v of particles i and j in products with C without what MphPairs::alongWall takes out; d = x_j - x_i
/// [m].
template <int D>
__device__ inline Vec<D, float> acting(const MphPairs<D>& pairs, std::uint32_t i, std::uint32_t j, const Vec<D>& d,
                                       const Vec<D, float>& v) {
  const bool wall = i >= pairs.fluidCount;
  if (!pairs.slips() || wall == (j >= pairs.fluidCount)) return v;
  const Vec<D> whole = converted<double>(v);
  return v - converted<float>(wall ? pairs.alongWall(j, i, -1.0 * d, whole) : pairs.alongWall(i, j, d, whole));
}

}  // namespace treacle
