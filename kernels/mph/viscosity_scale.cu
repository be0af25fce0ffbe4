#include "treacle/mph/viscosity_scale.hpp"

#include "mph/step_sums.cuh"

namespace treacle {
namespace {

/// Sum of c r^4 per fluid particle.
template <int D>
struct ViscousMoment {
  static constexpr int values = 1;
  static constexpr bool uses(ListSegment) { return true; }
  struct Own {};
  using Other = Own;

  MphTerms<D> mph;
  double correction;
  double* scale;

  __device__ Own loadOwn(const MphPairs<D>&, std::uint32_t) const { return {}; }
  __device__ Other loadOther(const MphPairs<D>&, std::uint32_t) const { return {}; }

  __device__ void add(const MphPairs<D>&, double* sum, const Vec<D>& d, const PairDistance<double>& r, Own, Other,
                      ListSegment) const {
    sum[0] = fma(mph.resistanceShape(r), norm2(d), sum[0]);
  }
  __device__ void store(const MphPairs<D>&, std::uint32_t i, int, double sum) const {
    scale[i] = viscosityScaleOf<D>(mph.viscousFactor * sum, correction);
  }
};

}  // namespace

template <int D>
void viscosityScale(Context<Cuda>& context, const MphPairs<D>& pairs, double correction, std::span<double> scale) {
  sumOnFluid(context, pairs, ViscousMoment<D>{pairs.terms, correction, scale.data()});
}

template void viscosityScale<2>(Context<Cuda>&, const MphPairs<2>&, double, std::span<double>);
template void viscosityScale<3>(Context<Cuda>&, const MphPairs<3>&, double, std::span<double>);

}  // namespace treacle
