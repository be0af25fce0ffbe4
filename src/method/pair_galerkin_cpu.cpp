#include "corner_galerkin.hpp"
#include "treacle/method/hat_preconditioner.hpp"

namespace treacle {

template <int D, class T>
void pairGalerkin(Context<Cpu>& context, const SortedParticles<D>& particles,
                  std::span<const PairMoments<D>> moments, const HatNodes<D>& nodes, Buffer<T>&, BlockCsr<1>& a) {
  cornerGalerkin<D, 1>(
      context, particles, nodes,
      [&](std::uint32_t i, const CornerHat<D>& p, const CornerHat<D>& q) {
        Vec<D, float> gp, gq;
        for (int k = 0; k < D; ++k)
          gp[k] = static_cast<float>(p.gradient[k]), gq[k] = static_cast<float>(q.gradient[k]);
        const double own = p.node == q.node ? p.value * moments[i].own : 0;
        return Block<1>{{pairGalerkinFactor * moments[i].between(gp, gq) + own}};
      },
      a);
}

#define TREACLE_INSTANTIATE(D, T)                                                                             \
  template void pairGalerkin<D, T>(Context<Cpu>&, const SortedParticles<D>&, std::span<const PairMoments<D>>, \
                                   const HatNodes<D>&, Buffer<T>&, BlockCsr<1>&);
TREACLE_INSTANTIATE(2, double)
TREACLE_INSTANTIATE(3, double)
TREACLE_INSTANTIATE(2, float)
TREACLE_INSTANTIATE(3, float)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
