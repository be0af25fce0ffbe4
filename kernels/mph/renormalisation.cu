#include "treacle/mph/renormalisation.hpp"

#include "mph/step_sums.cuh"

namespace treacle {
namespace {

/// M_i = sum of g d d^T per fluid particle, its upper triangle.
template <int D>
struct Moments {
  static constexpr int values = SymmetricBlock<D>::size;
  static constexpr bool uses(ListSegment s) { return isNear(s); }
  struct Own {};
  using Other = Own;

  MphTerms<D> mph;
  SymmetricBlock<D>* moment;

  __device__ Own loadOwn(const MphPairs<D>&, std::uint32_t) const { return {}; }
  __device__ Other loadOther(const MphPairs<D>&, std::uint32_t) const { return {}; }

  __device__ void add(const MphPairs<D>&, double* sum, const Vec<D>& d, const PairDistance<double>& r, Own, Other,
                      ListSegment) const {
    const double g = mph.gradientShape(r);
    int n = 0;
    for (int i = 0; i < D; ++i)
      for (int k = i; k < D; ++k, ++n) sum[n] = fma(g * d[i], d[k], sum[n]);
  }
  __device__ void store(const MphPairs<D>&, std::uint32_t i, int n, double sum) const {
    moment[i].a[n] = mph.gradientFactor * sum;
  }
};

}  // namespace

/// After the sums one thread per fluid particle; reads its moment, writes its B. No atomics.
template <int D>
void renormalisation(Context<Cuda>& context, const MphPairs<D>& pairs, std::span<SymmetricBlock<D>> b) {
  sumOnFluid(context, pairs, Moments<D>{pairs.terms, b.data()});
  forEach(context, b.size(), [b = b.data()] __device__(std::size_t i) { b[i] = renormalisationOf(b[i]); });
}

template void renormalisation<2>(Context<Cuda>&, const MphPairs<2>&, std::span<SymmetricBlock<2>>);
template void renormalisation<3>(Context<Cuda>&, const MphPairs<3>&, std::span<SymmetricBlock<3>>);

}  // namespace treacle
