#pragma once

#include "treacle/core/symmetric_block.hpp"
#include "treacle/mph/pair_sums.hpp"

#include <cstdint>

namespace treacle {

/// Sum of g d d^T per fluid particle [-], with -e w' = g d of the terms' weight: over the neighbours within the
/// radius of pressures, or over all. A matrix B that is its inverse makes gradients exact for what is linear.
template <int D, class Mph, bool All>
struct GradientMoment {
  static constexpr int values = SymmetricBlock<D>::size;
  static constexpr bool uses(ListSegment s) { return All || isNear(s); }

  Mph mph;
  SymmetricBlock<D>* moment;

  template <class At>
  TREACLE_HD At own(const MphPairs<D>&, const At& at) const {
    return at;
  }
  template <class T, class O>
  TREACLE_HD void add(const MphPairs<D>&, T* sum, const Vec<D, T>& d, const PairDistance<T>& r, const O&,
                      const OneParticle&, ListSegment) const {
    const T g = mph.gradientShape(r);
    int n = 0;
    for (int i = 0; i < D; ++i)
      for (int k = i; k < D; ++k, ++n) sum[n] += g * d[i] * d[k];
  }
  TREACLE_HD void store(const MphPairs<D>&, std::uint32_t i, int n, double sum) const {
    moment[i].a[n] = mph.gradientFactor * sum;
  }
};

}  // namespace treacle
