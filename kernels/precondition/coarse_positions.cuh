#pragma once

#include "mph/near_sums.cuh"

#include <algorithm>
#include <bit>
#include <cstdint>

namespace treacle {

/// Positions of the single-precision products, of fewer bits, the same in all of them. In two dimensions units are
/// so large that 16 h_p have 2^23 of them: what lies that far from a block's middle is a whole number of them in
/// single precision. In three dimensions 16 bits have to do, of which the multiples of a length above eleven times
/// h_p are left out: particles are displaced by up to 3e-4 spacings.
template <int D>
struct CoarsePositions {
  std::uint32_t periods[D], unit[D];

  static CoarsePositions make(const MphPairs<D>& pairs) {
    CoarsePositions c;
    for (int k = 0; k < D; ++k) {
      const double radii = pairs.grid.length[k] / pairs.terms.pressureRadius;
      c.periods[k] = D == 2 ? 1 : static_cast<std::uint32_t>(std::max(radii / 11, 1.0));
      c.unit[k] =
          D == 3 ? 0x10000 : std::bit_ceil(static_cast<std::uint32_t>(std::clamp(512 * 16 / radii, 1.0, 512.0)));
    }
    return c;
  }
  /// Lists whose differences are those of such positions.
  static NearLists<D, float> listsOf(const MphPairs<D>& pairs, const NearProducts<D>& near) {
    auto lists = NearLists<D, float>::make(pairs, near);
    const CoarsePositions coarse = make(pairs);
    for (int k = 0; k < D; ++k) lists.places.scale[k] /= static_cast<float>(coarse.periods[k]);
    return lists;
  }
  __device__ std::uint32_t of(std::int32_t fixed, int k) const {
    return (static_cast<std::uint32_t>(fixed) * periods[k] + unit[k] / 2) & ~(unit[k] - 1);
  }
};

}  // namespace treacle
