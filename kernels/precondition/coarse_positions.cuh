#pragma once

#include "mph/near_sums.cuh"

#include <algorithm>
#include <cstdint>

namespace treacle {

/// Positions of the single-precision products as they stand beside a number, the same in all of them. In two
/// dimensions all bits fit. In three 16 have to do, of which the multiples of a length above twice h_p are left
/// out: particles are displaced by up to 3e-5 spacings.
template <int D>
struct CoarsePositions {
  std::uint32_t periods[D];

  static CoarsePositions make(const MphPairs<D>& pairs) {
    CoarsePositions c;
    for (int k = 0; k < D; ++k) {
      const double radii = pairs.grid.length[k] / pairs.terms.pressureRadius;
      c.periods[k] = D == 2 ? 1 : static_cast<std::uint32_t>(std::max(radii / 2.2, 1.0));
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
    const std::uint32_t within = static_cast<std::uint32_t>(fixed) * periods[k];
    return D == 2 ? within : (within + 0x8000) & ~0xffffu;
  }
};

}  // namespace treacle
