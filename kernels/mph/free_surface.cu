#include "treacle/mph/free_surface.hpp"

#include "mph/step_sums.cuh"

namespace treacle {
namespace {

/// Sum of g d per fluid particle over its near neighbours.
template <int D>
struct Lack {
  static constexpr int values = D;
  static constexpr bool uses(ListSegment s) { return isNear(s); }
  struct Own {};
  using Other = Own;

  MphTerms<D> mph;
  Vec<D>* lack;

  __device__ Own loadOwn(const MphPairs<D>&, std::uint32_t) const { return {}; }
  __device__ Other loadOther(const MphPairs<D>&, std::uint32_t) const { return {}; }

  __device__ void add(const MphPairs<D>&, double* sum, const Vec<D>& d, const PairDistance<double>& r, Own, Other,
                      ListSegment) const {
    addScaled(sum, mph.gradient(r), d);
  }
  __device__ void store(const MphPairs<D>&, std::uint32_t i, int n, double sum) const { lack[i][n] = sum; }
};

/// The area per fluid particle, from the number of neighbours where it lacks some.
template <int D>
struct SurfaceArea {
  static constexpr int values = 1;
  static constexpr bool uses(ListSegment s) { return isNear(s); }
  struct Own {
    Vec<D> lack;
    double size;
  };
  struct Other {};

  MphTerms<D> mph;
  SurfaceLack surface;
  const Vec<D>* lack;
  double* area;

  __device__ Own loadOwn(const MphPairs<D>&, std::uint32_t i) const { return {lack[i], norm(lack[i])}; }
  __device__ Other loadOther(const MphPairs<D>&, std::uint32_t) const { return {}; }

  __device__ void add(const MphPairs<D>&, double* sum, const Vec<D>& d, const PairDistance<double>& r,
                      const Own& own, Other, ListSegment) const {
    const double length = r.square * r.inverse;
    if (length < mph.pressureRadius && SurfaceLack::covers(dot(d, own.lack), own.size, length)) sum[0] += 1;
  }
  __device__ void store(const MphPairs<D>&, std::uint32_t i, int, double sum) const {
    area[i] = sum > 0 ? 0 : surface.area(norm(lack[i]));
  }
};

}  // namespace

template <int D>
void surfaceArea(Context<Cuda>& context, const MphPairs<D>& pairs, const SurfaceLack& surface,
                 std::span<Vec<D>> lack, std::span<double> area) {
  sumOnFluid(context, pairs, Lack<D>{pairs.terms, lack.data()});
  sumOnFluid(context, pairs, SurfaceArea<D>{pairs.terms, surface, lack.data(), area.data()});
}

template void surfaceArea<2>(Context<Cuda>&, const MphPairs<2>&, const SurfaceLack&, std::span<Vec<2>>,
                             std::span<double>);
template void surfaceArea<3>(Context<Cuda>&, const MphPairs<3>&, const SurfaceLack&, std::span<Vec<3>>,
                             std::span<double>);

}  // namespace treacle
