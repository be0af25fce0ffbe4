#pragma once

#include "treacle/mph/pair_sums.hpp"
#include "treacle/mph/viscosity_scale.hpp"

#include <cstdint>

namespace treacle {

struct AllNeighbours {
  TREACLE_HD bool operator()(std::uint32_t, ListSegment) const { return true; }
};

/// Sum of c r^4 per fluid particle, over the neighbours that count.
template <int D, class Counts = AllNeighbours>
struct ViscousMoment {
  static constexpr int values = 1;
  static constexpr bool uses(ListSegment) { return true; }

  double correction;
  double* scale;
  Counts counts{};

  template <class At>
  TREACLE_HD At own(const MphPairs<D>&, const At& at) const {
    return at;
  }
  template <class T, class O>
  TREACLE_HD void add(const MphPairs<D>& pairs, T* sum, const Vec<D, T>& d, const PairDistance<T>& r, const O&,
                      const OneParticle& other, ListSegment segment) const {
    if (!counts(other.index, segment)) return;
    sum[0] += pairs.terms.resistanceShape(r) * norm2(d);
  }
  TREACLE_HD void store(const MphPairs<D>& pairs, std::uint32_t i, int, double sum) const {
    scale[i] = viscosityScaleOf<D>(pairs.terms.viscousFactor * sum, correction);
  }
};

}  // namespace treacle
