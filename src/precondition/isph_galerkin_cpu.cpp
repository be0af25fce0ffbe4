#include "corner_galerkin.hpp"
#include "treacle/precondition/isph_hat_multigrid.hpp"

namespace treacle {

template <int D, class T>
void isphGalerkin(Context<Cpu>& context, const SortedParticles<D>& particles,
                  std::span<const IsphMoments<D>> moments, const HatNodes<D>& nodes, Buffer<T>&, BlockCsr<1>& a) {
  cornerGalerkin<D, 1>(
      context, particles, nodes,
      [&](std::uint32_t i, const NodeHat<D>& p, const NodeHat<D>& q) {
        Vec<D, float> gp, gq;
        for (int k = 0; k < D; ++k)
          gp[k] = static_cast<float>(p.gradient[k]), gq[k] = static_cast<float>(q.gradient[k]);
        const double own = p.node == q.node ? p.value * moments[i].own : 0;
        return Block<1>{{isphGalerkinFactor * moments[i].between(gp, gq) + own}};
      },
      a);
}

#define TREACLE_INSTANTIATE(D, T)                                                                             \
  template void isphGalerkin<D, T>(Context<Cpu>&, const SortedParticles<D>&, std::span<const IsphMoments<D>>, \
                                   const HatNodes<D>&, Buffer<T>&, BlockCsr<1>&);
TREACLE_INSTANTIATE(2, double)
TREACLE_INSTANTIATE(3, double)
TREACLE_INSTANTIATE(2, float)
TREACLE_INSTANTIATE(3, float)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
