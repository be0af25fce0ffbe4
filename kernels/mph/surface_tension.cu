#include "treacle/mph/surface_tension.hpp"

#include "mph/step_sums.cuh"

namespace treacle {
namespace {

/// m per fluid particle, from G: all neighbours, walls included.
template <int D>
struct SurfaceSlope {
  static constexpr int values = D;
  static constexpr bool uses(ListSegment) { return true; }
  using StoresVectors = void;
  struct Own {};
  using Other = Own;

  SurfaceTerms<D> terms;
  Vec<D>* m;

  __device__ Own loadOwn(const MphPairs<D>&, std::uint32_t) const { return {}; }
  __device__ Other loadOther(const MphPairs<D>&, std::uint32_t) const { return {}; }

  __device__ void add(const MphPairs<D>&, double* sum, const Vec<D>& d, const PairDistance<double>& r, Own, Other,
                      ListSegment) const {
    addScaled(sum, terms.gradient(r.square), d);
  }
  __device__ void store(const MphPairs<D>& pairs, std::uint32_t i, const Vec<D>& g) const {
    m[i] = terms.slope(pairs.material[i], g);
  }
};

/// y += force of the surface per fluid particle, from the fluid around it.
template <int D>
struct SurfaceForce {
  static constexpr int values = D;
  static constexpr bool uses(ListSegment s) { return isFluid(s); }
  using Own = Vec<D>;
  using Other = Vec<D>;

  SurfaceTerms<D> terms;
  const Vec<D>* m;
  Vec<D>* y;

  __device__ Own loadOwn(const MphPairs<D>&, std::uint32_t i) const { return m[i]; }
  __device__ Other loadOther(const MphPairs<D>&, std::uint32_t j) const { return m[j]; }

  __device__ void add(const MphPairs<D>&, double* sum, const Vec<D>& d, const PairDistance<double>& r,
                      const Own& own, const Other& other, ListSegment) const {
    const double g = terms.gradient(r.square);
    addScaled(sum, (g - terms.core(r.inverse)) * (norm2(own) + norm2(other)), d);
    addScaled(sum, -g * dot(own, d), own);
    addScaled(sum, -g * dot(other, d), other);
  }
  __device__ void store(const MphPairs<D>&, std::uint32_t i, int n, double sum) const { y[i][n] += sum; }
};

}  // namespace

template <int D>
void surfaceSlope(Context<Cuda>& context, const MphPairs<D>& pairs, const SurfaceTerms<D>& terms,
                  std::span<Vec<D>> m) {
  sumOnFluid(context, pairs, SurfaceSlope<D>{terms, m.data()});
}

template <int D>
void addSurfaceTension(Context<Cuda>& context, const MphPairs<D>& pairs, const SurfaceTerms<D>& terms,
                       std::span<const Vec<D>> m, std::span<Vec<D>> y) {
  sumOnFluid(context, pairs, SurfaceForce<D>{terms, m.data(), y.data()});
}

#define TREACLE_INSTANTIATE(D)                                                                                  \
  template void surfaceSlope<D>(Context<Cuda>&, const MphPairs<D>&, const SurfaceTerms<D>&, std::span<Vec<D>>); \
  template void addSurfaceTension<D>(Context<Cuda>&, const MphPairs<D>&, const SurfaceTerms<D>&,                \
                                     std::span<const Vec<D>>, std::span<Vec<D>>);
TREACLE_INSTANTIATE(2)
TREACLE_INSTANTIATE(3)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
