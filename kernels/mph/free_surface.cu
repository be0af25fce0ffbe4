#include "treacle/mph/free_surface.hpp"

#include "mph/step_sums.cuh"

namespace treacle {
namespace {

/// Area of the free surface per fluid particle, from the sum of g d over its near neighbours.
template <int D>
struct SurfaceArea {
  static constexpr int values = D;
  static constexpr bool uses(ListSegment s) { return isNear(s); }
  struct Own {};
  using Other = Own;
  using StoresVectors = void;

  MphTerms<D> mph;
  SurfaceLack surface;
  double* area;

  __device__ Own loadOwn(const MphPairs<D>&, std::uint32_t) const { return {}; }
  __device__ Other loadOther(const MphPairs<D>&, std::uint32_t) const { return {}; }

  __device__ void add(const MphPairs<D>&, double* sum, const Vec<D>& d, const PairDistance<double>& r, Own, Other,
                      ListSegment) const {
    addScaled(sum, mph.gradient(r), d);
  }
  __device__ void store(const MphPairs<D>&, std::uint32_t i, const Vec<D>& sum) const {
    area[i] = surface.area(norm(sum));
  }
};

}  // namespace

template <int D>
void surfaceArea(Context<Cuda>& context, const MphPairs<D>& pairs, const SurfaceLack& surface,
                 std::span<double> area) {
  sumOnFluid(context, pairs, SurfaceArea<D>{pairs.terms, surface, area.data()});
}

template void surfaceArea<2>(Context<Cuda>&, const MphPairs<2>&, const SurfaceLack&, std::span<double>);
template void surfaceArea<3>(Context<Cuda>&, const MphPairs<3>&, const SurfaceLack&, std::span<double>);

}  // namespace treacle
