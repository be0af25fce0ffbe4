#include "precondition/corner_galerkin.cuh"
#include "treacle/precondition/isph_hat_multigrid.hpp"

namespace treacle {
namespace {

/// What a fluid particle puts between two corners of its cell.
template <int D, class T>
struct IsphCornerTerm {
  const IsphMoments<D>* moments;

  __device__ Block<1, T> operator()(std::uint32_t i, const CornerHat<D, T>& a, const CornerHat<D, T>& b) const {
    Vec<D, float> p, q;
    for (int k = 0; k < D; ++k) p[k] = static_cast<float>(a.gradient[k]), q[k] = static_cast<float>(b.gradient[k]);
    const IsphMoments<D> m = moments[i];
    const T own = a.corner == b.corner ? a.value * static_cast<T>(m.own) : T(0);
    return {{static_cast<T>(isphGalerkinFactor) * static_cast<T>(m.between(p, q)) + own}};
  }
};

}  // namespace

template <int D, class T>
void isphGalerkin(Context<Cuda>& context, const SortedParticles<D>& particles,
                  std::span<const IsphMoments<D>> moments, const HatNodes<D, Cuda>& nodes, Buffer<T, Cuda>& parts,
                  BlockCsr<1, double, Cuda>& a) {
  cornerGalerkin<D, 1, T>(context, particles, nodes, IsphCornerTerm<D, T>{moments.data()}, parts, a);
}

#define TREACLE_INSTANTIATE(D, T)                                                                              \
  template void isphGalerkin<D, T>(Context<Cuda>&, const SortedParticles<D>&, std::span<const IsphMoments<D>>, \
                                   const HatNodes<D, Cuda>&, Buffer<T, Cuda>&, BlockCsr<1, double, Cuda>&);
TREACLE_INSTANTIATE(2, double)
TREACLE_INSTANTIATE(3, double)
TREACLE_INSTANTIATE(2, float)
TREACLE_INSTANTIATE(3, float)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
