#pragma once

#include "treacle/mph/free_surface.hpp"
#include "treacle/mph/pair_sums.hpp"

namespace treacle {

// The sums of free_surface.hpp, for the sources of both backends, which instantiate them.

/// Sum of g d per fluid particle over its near neighbours.
template <int D>
struct Lack {
  static constexpr int values = D;
  static constexpr bool uses(ListSegment s) { return isNear(s); }

  Vec<D>* lack;

  template <class At>
  TREACLE_HD At own(const MphPairs<D>&, const At& at) const {
    return at;
  }
  template <class T, class O>
  TREACLE_HD void add(const MphPairs<D>& pairs, T* sum, const Vec<D, T>& d, const PairDistance<T>& r, const O&,
                      const OneParticle&, ListSegment) const {
    addScaled(sum, pairs.terms.gradient(r), d);
  }
  TREACLE_HD void store(const MphPairs<D>&, std::uint32_t i, int n, double sum) const { lack[i][n] = sum; }
};

/// The area per fluid particle, from the number of neighbours where it lacks some.
template <int D>
struct SurfaceArea {
  static constexpr int values = 1;
  static constexpr bool uses(ListSegment s) { return isNear(s); }
  template <class At>
  struct Own {
    VecAt<D, At> lack;
    NumberAt<At> size;
  };

  SurfaceLack surface;
  const Vec<D>* lack;
  double* area;

  template <class At>
  TREACLE_HD Own<At> own(const MphPairs<D>&, const At& at) const {
    return {at([&](std::uint32_t i) { return lack[i]; }), at([&](std::uint32_t i) { return norm(lack[i]); })};
  }
  TREACLE_HD OneParticle other(const MphPairs<D>&, std::uint32_t j) const { return {j}; }

  template <class T, class O>
  TREACLE_HD void add(const MphPairs<D>& pairs, T* sum, const Vec<D, T>& d, const PairDistance<T>& r, const O& own,
                      const OneParticle&, ListSegment) const {
    const T length = r.square * r.inverse;
    const auto counts =
        length < pairs.terms.pressureRadius && SurfaceLack::covers(along(d, own.lack), own.size, length);
    sum[0] += select(counts, T(1.0), T(0.0));
  }
  TREACLE_HD void store(const MphPairs<D>&, std::uint32_t i, int, double sum) const {
    area[i] = sum > 0 ? 0 : surface.area(norm(lack[i]));
  }
};

template <int D, class Backend>
void surfaceArea(Context<Backend>& context, const MphPairs<D>& pairs, const SurfaceLack& surface,
                 std::span<Vec<D>> lack, std::span<double> area) {
  sumOnFluid(context, pairs, Lack<D>{lack.data()});
  sumOnFluid(context, pairs, SurfaceArea<D>{surface, lack.data(), area.data()});
}

#define TREACLE_FREE_SURFACE_SUMS(D, Backend)                                                             \
  template void surfaceArea(Context<Backend>&, const MphPairs<D>&, const SurfaceLack&, std::span<Vec<D>>, \
                            std::span<double>);

}  // namespace treacle
