#pragma once

#include "treacle/core/symmetric_block.hpp"

#include <cmath>
#include <cstdint>

namespace treacle {

/// B of a particle (renormalisation.hpp) in few bits, so that it stands beside the position and a number in 16
/// bytes. Its eigenvalues are above 0 and at most 1; so elements on the diagonal are stored as 0 to `scale`, the
/// others, at most a half, with scale/2 added. The unit matrix is exact. A preconditioner in which all products
/// have these B is symmetric as before; ten (2D) and eight bits (3D) change iterations by 1 %
/// (docs/performance.md).
template <int D>
struct PackedTensor {
  static constexpr int bits = D == 2 ? 10 : 8, scale = D == 2 ? 1022 : 254;
  using Block = SymmetricBlock<D>;

  TREACLE_HD static constexpr bool onDiagonal(int element) {
    return element == 0 || element == Block::size - 1 || (D == 3 && element == 3);
  }
  TREACLE_HD static std::uint64_t pack(const Block& b) {
    std::uint64_t packed = 0;
    for (int e = 0; e < Block::size; ++e) {
      const double number = std::rint(scale * b.a[e]) + (onDiagonal(e) ? 0 : scale / 2);
      packed |= static_cast<std::uint64_t>(std::fmin(std::fmax(number, 0.0), double{scale})) << bits * e;
    }
    return packed;
  }
  /// Elements times `scale`.
  static Block unpack(std::uint64_t packed) {
    Block b;
    for (int e = 0; e < Block::size; ++e)
      b.a[e] = static_cast<double>(packed >> bits * e & ((1u << bits) - 1)) - (onDiagonal(e) ? 0 : scale / 2);
    return b;
  }
};

}  // namespace treacle
