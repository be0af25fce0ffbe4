#include "treacle/mph/mph_balance.hpp"

#include "mph/step_sums.cuh"

namespace treacle {
namespace {

/// 2 (d+2) mu (u_ij.e_ij)^2 (-w'^v) / r per fluid particle, half of a pair of fluid [K23 eq. (10)].
template <int D, class Mph, bool Corrected>
struct ShearDissipation {
  static constexpr int values = 1;
  static constexpr bool uses(ListSegment) { return true; }
  struct Own {
    std::uint32_t i;
    Vec<D> u;
  };
  using Other = Own;

  Mph mph;
  const Vec<D>* u;
  double* dissipation;

  __device__ Own loadOwn(const MphPairs<D>&, std::uint32_t i) const { return {i, u[i]}; }
  __device__ Other loadOther(const MphPairs<D>&, std::uint32_t j) const { return {j, u[j]}; }

  __device__ void add(const MphPairs<D>& pairs, double* sum, const Vec<D>& d, const PairDistance<double>& r,
                      const Own& own, const Other& other, ListSegment segment) const {
    const double along = differenceAlong(other.u, own.u, d);
    const double share = isWall(segment) ? viscosityFactor<Corrected>(pairs, own.i, other.i, d) : 0.5;
    const double mu = pairs.viscosityOf(own.i, other.i);
    sum[0] = fma(share * mu * mph.viscousShape(r), along * along, sum[0]);
  }
  __device__ void store(const MphPairs<D>&, std::uint32_t i, int, double sum) const {
    dissipation[i] = mph.viscousFactor * sum;
  }
};

/// gamma per fluid particle.
template <int D, class Mph, bool Corrected>
struct ShearRate {
  static constexpr int values = 1;
  static constexpr bool uses(ListSegment) { return true; }
  struct Own {
    std::uint32_t i;
    Vec<D> u;
  };
  using Other = Own;

  Mph mph;
  const Vec<D>* u;
  const double* share;
  double* rate;

  __device__ Own loadOwn(const MphPairs<D>&, std::uint32_t i) const { return {i, u[i]}; }
  __device__ Other loadOther(const MphPairs<D>&, std::uint32_t j) const { return {j, u[j]}; }

  __device__ void add(const MphPairs<D>& pairs, double* sum, const Vec<D>& d, const PairDistance<double>& r,
                      const Own& own, const Other& other, ListSegment segment) const {
    const double along = differenceAlong(other.u, own.u, d);
    const double part = isWall(segment) ? viscosityFactor<Corrected>(pairs, own.i, other.i, d) : 0.5;
    sum[0] = fma(part * mph.viscousShape(r), along * along, sum[0]);
  }
  __device__ void store(const MphPairs<D>&, std::uint32_t i, int, double sum) const {
    rate[i] = sqrt(mph.viscousFactor * sum * share[i]);
  }
};

/// Force on a wall particle [K23 eq. (4)], and the parts of its C^T u and n, from the fluid near it.
template <int D, class Mph, bool Corrected>
struct FluidAtWall {
  static constexpr int values = D + 2;
  static constexpr bool uses(ListSegment s) { return isFluid(s); }
  struct Own {
    std::uint32_t i;
    Vec<D> u;
    double pressure;
  };
  using Other = Own;

  Mph mph;
  const Vec<D>* u;
  const double* pressure;
  Vec<D>* force;  // of the first wall particle, like those below
  double *divergence, *density;

  __device__ Own loadOwn(const MphPairs<D>&, std::uint32_t i) const { return {i, u[i], pressure[i]}; }
  __device__ Other loadOther(const MphPairs<D>& pairs, std::uint32_t j) const { return loadOwn(pairs, j); }

  __device__ void add(const MphPairs<D>& pairs, double* sum, const Vec<D>& d, const PairDistance<double>& r,
                      const Own& own, const Other& other, ListSegment) const {
    const double along = differenceAlong(other.u, own.u, d);
    const double mu =
        pairs.viscosityOf(own.i, other.i) * viscosityFactor<Corrected>(pairs, other.i, own.i, -1.0 * d);
    const double g = mph.gradient(r);
    const double viscous = mph.viscousFactor * mu * mph.viscousShape(r) * along;
    if constexpr (Corrected) {
      addScaled(sum, viscous - g * own.pressure, d);
      addScaled(sum, -g * other.pressure, pairs.corrected(other.i, d));
    } else {
      addScaled(sum, viscous - g * (own.pressure + other.pressure), d);
    }
    sum[D] = fma(-g, along, sum[D]);
    sum[D + 1] += mph.density(1.0, r);
  }
  __device__ void store(const MphPairs<D>& pairs, std::uint32_t i, int n, double sum) const {
    const std::uint32_t wall = i - pairs.fluidCount;
    if (n < D)
      force[wall][n] = sum;
    else if (n == D)
      divergence[wall] = sum;
    else
      density[wall] = mph.densityFactor * sum;
  }
};

}  // namespace

template <int D>
void shearDissipation(Context<Cuda>& context, const MphPairs<D>& pairs, std::span<const Vec<D>> u,
                      std::span<double> dissipation) {
  withStepTerms(pairs, [&]<class Mph, class Corrected>(const Mph& mph, Corrected) {
    sumOnFluid(context, pairs, ShearDissipation<D, Mph, Corrected::value>{mph, u.data(), dissipation.data()});
  });
}

template <int D>
void shearRate(Context<Cuda>& context, const MphPairs<D>& pairs, std::span<const Vec<D>> u,
               std::span<const double> share, std::span<double> rate) {
  withStepTerms(pairs, [&]<class Mph, class Corrected>(const Mph& mph, Corrected) {
    sumOnFluid(context, pairs, ShearRate<D, Mph, Corrected::value>{mph, u.data(), share.data(), rate.data()});
  });
}

template <int D>
void fluidAtWalls(Context<Cuda>& context, const MphPairs<D>& pairs, const ClusterListView& walls,
                  std::span<const Vec<D>> u, std::span<const double> pressure, const FluidAtWalls<D>& out) {
  withStepTerms(pairs, [&]<class Mph, class Corrected>(const Mph& mph, Corrected) {
    using Terms = FluidAtWall<D, Mph, Corrected::value>;
    sumOnList(context, pairs, walls,
              Terms{mph, u.data(), pressure.data(), out.force.data(), out.divergence.data(), out.density.data()});
  });
}

#define TREACLE_INSTANTIATE(D)                                                                   \
  template void shearDissipation<D>(Context<Cuda>&, const MphPairs<D>&, std::span<const Vec<D>>, \
                                    std::span<double>);                                          \
  template void shearRate<D>(Context<Cuda>&, const MphPairs<D>&, std::span<const Vec<D>>,        \
                             std::span<const double>, std::span<double>);                        \
  template void fluidAtWalls<D>(Context<Cuda>&, const MphPairs<D>&, const ClusterListView&,      \
                                std::span<const Vec<D>>, std::span<const double>, const FluidAtWalls<D>&);
TREACLE_INSTANTIATE(2)
TREACLE_INSTANTIATE(3)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
