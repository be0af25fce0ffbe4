#include "treacle/method/balance_sums.hpp"

#include "method/step_sums.cuh"

namespace treacle {
namespace {

/// 2 (d+2) mu (u_ij.e_ij)^2 (-w'^v) / r per fluid particle, half of a pair of fluid [K23 eq. (10)].
template <int D>
struct ShearDissipation {
  static constexpr int values = 1;
  static constexpr bool uses(ListSegment) { return true; }
  using Own = VelocityOf<D, double>;
  using Other = VelocityOf<D, double>;

  PairConstants<D, double> constants;
  const Vec<D>* u;
  double* dissipation;

  __device__ Own loadOwn(const MphPairs<D>& pairs, std::uint32_t i) const { return {u[i], pairs.material[i]}; }
  __device__ Other loadOther(const MphPairs<D>& pairs, std::uint32_t j) const { return loadOwn(pairs, j); }

  __device__ void add(const MphPairs<D>& pairs, double* sum, const Vec<D>& d, double inverseR, const Own& own,
                      const Other& other, ListSegment segment) const {
    const double along = differenceAlong(other.u, own.u, d), share = isWall(segment) ? 1 : 0.5;
    const double mu = pairs.materials.pairViscosity[own.material][other.material];
    sum[0] = fma(share * mu * constants.viscosityReach(inverseR), along * along, sum[0]);
  }
  __device__ void store(const MphPairs<D>&, std::uint32_t i, int, double sum) const {
    dissipation[i] = constants.viscosityFactor * sum;
  }
};

/// Force on a wall particle [K23 eq. (4)], and the parts of its C^T u and n, from the fluid near it.
template <int D>
struct FluidAtWall {
  static constexpr int values = D + 2;
  static constexpr bool uses(ListSegment s) { return isFluid(s); }
  struct Own {
    Vec<D> u;
    double pressure;
    std::uint8_t material;
  };
  using Other = Own;

  PairConstants<D, double> constants;
  const Vec<D>* u;
  const double* pressure;
  double densityScale;
  Vec<D>* force;  // of the first wall particle, like those below
  double *divergence, *density;

  __device__ Own loadOwn(const MphPairs<D>& pairs, std::uint32_t i) const {
    return {u[i], pressure[i], pairs.material[i]};
  }
  __device__ Other loadOther(const MphPairs<D>& pairs, std::uint32_t j) const { return loadOwn(pairs, j); }

  __device__ void add(const MphPairs<D>& pairs, double* sum, const Vec<D>& d, double inverseR, const Own& own,
                      const Other& other, ListSegment) const {
    const double along = differenceAlong(other.u, own.u, d);
    const double mu = pairs.materials.pairViscosity[own.material][other.material];
    const double g = constants.pressureFactor * constants.pressureReach(inverseR);
    const double viscous = constants.viscosityFactor * mu * constants.viscosityReach(inverseR) * along;
    addScaled(sum, viscous - g * (own.pressure + other.pressure), d);
    sum[D] = fma(-g, along, sum[D]);
    const double part = positivePart(1 - constants.inversePressureRadius / inverseR);
    sum[D + 1] = fma(part, part, sum[D + 1]);
  }
  __device__ void store(const MphPairs<D>& pairs, std::uint32_t i, int n, double sum) const {
    const std::uint32_t wall = i - pairs.fluidCount;
    if (n < D)
      force[wall][n] = sum;
    else if (n == D)
      divergence[wall] = sum;
    else
      density[wall] = densityScale * sum;
  }
};

}  // namespace

template <int D>
void shearDissipation(Context<Cuda>& context, const MphPairs<D>& pairs, std::span<const Vec<D>> u,
                      std::span<double> dissipation) {
  const auto constants = PairConstants<D, double>::make(pairs, 1);
  sumOnFluid(context, pairs, ShearDissipation<D>{constants, u.data(), dissipation.data()});
}

template <int D>
void fluidAtWalls(Context<Cuda>& context, const MphPairs<D>& pairs, const ClusterListView& walls,
                  std::span<const Vec<D>> u, std::span<const double> pressure, const FluidAtWalls<D>& out) {
  const auto constants = PairConstants<D, double>::make(pairs, 1);
  sumOnList(context, pairs, walls,
            FluidAtWall<D>{constants, u.data(), pressure.data(), pairs.pressureWeight.scale, out.force.data(),
                           out.divergence.data(), out.density.data()});
}

#define TREACLE_INSTANTIATE(D)                                                                   \
  template void shearDissipation<D>(Context<Cuda>&, const MphPairs<D>&, std::span<const Vec<D>>, \
                                    std::span<double>);                                          \
  template void fluidAtWalls<D>(Context<Cuda>&, const MphPairs<D>&, const ClusterListView&,      \
                                std::span<const Vec<D>>, std::span<const double>, const FluidAtWalls<D>&);
TREACLE_INSTANTIATE(2)
TREACLE_INSTANTIATE(3)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
