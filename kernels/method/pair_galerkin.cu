#include "method/corner_galerkin.cuh"
#include "treacle/method/hat_preconditioner.hpp"

namespace treacle {
namespace {

/// What a fluid particle puts between two corners of its cell.
template <int D, class T>
struct PairCornerTerm {
  const PairMoments<D>* moments;

  __device__ Block<1, T> operator()(std::uint32_t i, const CornerHat<D, T>& a, const CornerHat<D, T>& b) const {
    Vec<D, float> p, q;
    for (int k = 0; k < D; ++k) p[k] = static_cast<float>(a.gradient[k]), q[k] = static_cast<float>(b.gradient[k]);
    const PairMoments<D> m = moments[i];
    const T own = a.corner == b.corner ? a.value * static_cast<T>(m.own) : T(0);
    return {{static_cast<T>(pairGalerkinFactor) * static_cast<T>(m.between(p, q)) + own}};
  }
};

}  // namespace

template <int D, class T>
void pairGalerkin(Context<Cuda>& context, const SortedParticles<D>& particles,
                  std::span<const PairMoments<D>> moments, const HatNodes<D, Cuda>& nodes, Buffer<T, Cuda>& parts,
                  BlockCsr<1, double, Cuda>& a) {
  cornerGalerkin<D, 1, T>(context, particles, nodes, PairCornerTerm<D, T>{moments.data()}, parts, a);
}

#define TREACLE_INSTANTIATE(D, T)                                                                              \
  template void pairGalerkin<D, T>(Context<Cuda>&, const SortedParticles<D>&, std::span<const PairMoments<D>>, \
                                   const HatNodes<D, Cuda>&, Buffer<T, Cuda>&, BlockCsr<1, double, Cuda>&);
TREACLE_INSTANTIATE(2, double)
TREACLE_INSTANTIATE(3, double)
TREACLE_INSTANTIATE(2, float)
TREACLE_INSTANTIATE(3, float)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
