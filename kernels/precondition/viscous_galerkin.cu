#include "mph/product_terms.cuh"
#include "precondition/corner_galerkin.cuh"
#include "treacle/precondition/hat_grid.hpp"

namespace treacle {
namespace {

/// Moments of the viscous pairs; as SelfSums in form.
template <int D, class T, class Mph>
struct MomentSums {
  static constexpr int values = momentCount<D>;
  static constexpr bool uses(ListSegment s) { return isFluid(s); }
  using Own = ViscousSide;
  using Other = ViscousSide;

  Mph mph;
  ViscousMoments<D, T>* moments;

  __device__ Own loadOwn(const MphPairs<D>& pairs, std::uint32_t i) const { return pairs.viscousSide(i); }
  __device__ Other loadOther(const MphPairs<D>& pairs, std::uint32_t j) const { return pairs.viscousSide(j); }
  __device__ void add(const MphPairs<D>& pairs, double* sum, const Vec<D>& d, const PairDistance<double>& r,
                      Own own, Other other, ListSegment) const {
    const double f = pairs.viscosityOf(own, other) * mph.viscousShape(r);
    forEachMoment<D>(d, [&](int m, double product) { sum[m] = fma(f, product, sum[m]); });
  }
  __device__ void store(const MphPairs<D>&, std::uint32_t i, int n, double sum) const {
    moments[i].m[n] = static_cast<T>(0.5 * viscousGalerkinFactor * mph.viscousFactor * sum);
  }
};

/// What a fluid particle puts between two corners of its cell.
template <int D, class T>
struct ViscousCornerTerm {
  const ViscousMoments<D, T>* moments;
  const Block<D>* own;  // inertia and walls

  __device__ Block<D, T> operator()(std::uint32_t i, const CornerHat<D, T>& a, const CornerHat<D, T>& b) const {
    Block<D, T> sum = moments[i].between(a.gradient, b.gradient);
    for (int k = 0; k < D * D; ++k) sum.a[k] += a.value * b.value * static_cast<T>(own[i].a[k]);
    return sum;
  }
};

}  // namespace

template <int D, class T>
void viscousGalerkin(Context<Cuda>& context, const MphPairs<D>& pairs, const WallTerms<D>& terms,
                     const HatNodes<D, Cuda>& nodes, Buffer<ViscousMoments<D, T>, Cuda>& moments,
                     Buffer<T, Cuda>& parts, BlockCsr<D, double, Cuda>& a) {
  moments.resize(context, pairs.fluidCount);
  withScheme(pairs.terms, [&]<class Mph>(const Mph& mph) {
    using Terms = MomentSums<D, T, Mph>;
    const ListTask<Terms> task{pairs.fluidList, {mph, moments.data()}};
    launchClusterSums<D, double, Sharing<2, 1>>(context, pairs, task, LocalPositions<D, double>::make(pairs));
  });
  cornerGalerkin<D, D, T>(context, pairs, nodes, ViscousCornerTerm<D, T>{moments.data(), terms.block.data()},
                          parts, a);
}

#define TREACLE_INSTANTIATE(D, T)                                                                    \
  template void viscousGalerkin<D, T>(Context<Cuda>&, const MphPairs<D>&, const WallTerms<D>&,       \
                                      const HatNodes<D, Cuda>&, Buffer<ViscousMoments<D, T>, Cuda>&, \
                                      Buffer<T, Cuda>&, BlockCsr<D, double, Cuda>&);
TREACLE_INSTANTIATE(2, double)
TREACLE_INSTANTIATE(3, double)
TREACLE_INSTANTIATE(2, float)
TREACLE_INSTANTIATE(3, float)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
