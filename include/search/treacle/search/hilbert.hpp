#pragma once

#include "treacle/core/macros.hpp"
#include "treacle/core/vec.hpp"

#include <cstdint>

namespace treacle {

/// Position along the D-dimensional Hilbert curve of the point `p` of a grid with 2^bits points per axis
/// (Skilling's transform, AIP Conf. Proc. 707 (2004) 381). Dropping the lowest D k bits gives the position of the
/// enclosing block of 2^k points per axis: blocks are contiguous at every level.
template <int D>
TREACLE_HD constexpr std::uint64_t hilbertIndex(Vec<D, std::uint32_t> p, int bits) {
  const std::uint32_t top = 1u << (bits - 1);
  for (std::uint32_t q = top; q > 1; q >>= 1) {
    for (int k = 0; k < D; ++k) {
      if (p[k] & q) {
        p[0] ^= q - 1;
      } else {
        const std::uint32_t swap = (p[0] ^ p[k]) & (q - 1);
        p[0] ^= swap;
        p[k] ^= swap;
      }
    }
  }
  for (int k = 1; k < D; ++k) p[k] ^= p[k - 1];
  std::uint32_t flip = 0;
  for (std::uint32_t q = top; q > 1; q >>= 1)
    if (p[D - 1] & q) flip ^= q - 1;
  for (int k = 0; k < D; ++k) p[k] ^= flip;

  std::uint64_t index = 0;
  for (int b = bits - 1; b >= 0; --b)
    for (int k = 0; k < D; ++k) index = index << 1 | (p[k] >> b & 1u);
  return index;
}

}  // namespace treacle
