#pragma once

#include "treacle/mph/free_surface.hpp"
#include "treacle/mph/pair_sums.hpp"

namespace treacle {

// The sums of free_surface.hpp, for the sources of both backends, which instantiate them.

template <int D>
struct SurfaceArea {
  static constexpr int values = D + 1;
  static constexpr bool uses(ListSegment) { return true; }
  using StoresAll = void;

  SurfaceColour<D> colour;
  double* area;

  template <class At>
  TREACLE_HD At own(const MphPairs<D>&, const At& at) const {
    return at;
  }
  TREACLE_HD OneParticle other(const MphPairs<D>&, std::uint32_t j) const { return {j}; }

  template <class T, class At>
  TREACLE_HD void add(const MphPairs<D>&, T* sum, const Vec<D, T>& d, const PairDistance<T>& r, const At& own,
                      const OneParticle& other, ListSegment) const {
    const T part = colour.part(r);
    sum[0] += isAnother(own, other.index) * colour.weight(part);
    addScaled(sum + 1, colour.slope(part), d);
  }
  TREACLE_HD void store(const MphPairs<D>&, std::uint32_t i, const double* sum) const {
    double square = 0;
    for (int k = 0; k < D; ++k) square += sum[1 + k] * sum[1 + k];
    area[i] = colour.area(colour.scale * (1 + sum[0]), colour.scale * sqrt(square));
  }
};

template <int D, class Backend>
void surfaceArea(Context<Backend>& context, const MphPairs<D>& pairs, const SurfaceColour<D>& colour,
                 std::span<double> area) {
  sumOnFluid(context, pairs, SurfaceArea<D>{colour, area.data()});
}

#define TREACLE_FREE_SURFACE_SUMS(D, Backend) \
  template void surfaceArea(Context<Backend>&, const MphPairs<D>&, const SurfaceColour<D>&, std::span<double>);

}  // namespace treacle
