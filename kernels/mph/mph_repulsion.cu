#include "treacle/mph/mph_repulsion.hpp"

#include "mph/step_sums.cuh"

namespace treacle {
namespace {

/// What a particle brings to a pair.
struct ApartSide {
  ViscousSide viscous;
  double tension;  // [Pa]

  template <int D>
  __device__ static ApartSide of(const MphPairs<D>& pairs, const PairsApart& apart, std::uint32_t i) {
    return {pairs.viscousSide(i), apart.tension(i)};
  }
};

/// What is to be multiplied by the rate and -d.
template <int D>
__device__ double forceApart(const MphPairs<D>& pairs, const MphTerms<D>& mph, const PairsApart& apart,
                             const PairDistance<double>& r, const ApartSide& own, const ApartSide& other) {
  const double mu = pairs.viscosityOf(own.viscous, other.viscous);
  const double force = mph.viscousFactor * mu * mph.repulsionShape(r);
  if (apart.held.empty()) return force;
  const double tension = fmin(PairsApart::mostTension * mu, (own.tension + other.tension) / apart.rate);
  return fma(mph.gradientFactor * mph.tensionShape(r), tension, force);
}

/// Force of the repulsion on fluid particles, or on wall particles from the fluid.
template <int D, bool OnWalls>
struct Repulsion {
  static constexpr int values = D;
  static constexpr bool uses(ListSegment s) { return OnWalls ? s == ListSegment::NearFluid : isNear(s); }
  using Own = ApartSide;
  using Other = ApartSide;

  MphTerms<D, double> mph;
  PairsApart apart;
  Vec<D>* y;  // of the first fluid or wall particle

  __device__ Own loadOwn(const MphPairs<D>& pairs, std::uint32_t i) const { return Own::of(pairs, apart, i); }
  __device__ Other loadOther(const MphPairs<D>& pairs, std::uint32_t j) const { return Own::of(pairs, apart, j); }

  __device__ void add(const MphPairs<D>& pairs, double* sum, const Vec<D>& d, const PairDistance<double>& r,
                      const Own& own, const Other& other, ListSegment) const {
    addScaled(sum, forceApart(pairs, mph, apart, r, own, other), d);
  }
  __device__ void store(const MphPairs<D>& pairs, std::uint32_t i, int n, double sum) const {
    y[OnWalls ? i - pairs.fluidCount : i][n] -= apart.rate * sum;
  }
};

/// What it gives to the motion per fluid particle, half of a pair of fluid.
template <int D>
struct RepulsionPower {
  static constexpr int values = 1;
  static constexpr bool uses(ListSegment s) { return isNear(s); }
  struct Own {
    Vec<D> u;
    ApartSide side;
  };
  using Other = Own;

  MphTerms<D, double> mph;
  PairsApart apart;
  const Vec<D>* u;
  double* power;

  __device__ Own loadOwn(const MphPairs<D>& pairs, std::uint32_t i) const {
    return {u[i], ApartSide::of(pairs, apart, i)};
  }
  __device__ Other loadOther(const MphPairs<D>& pairs, std::uint32_t j) const { return loadOwn(pairs, j); }

  __device__ void add(const MphPairs<D>& pairs, double* sum, const Vec<D>& d, const PairDistance<double>& r,
                      const Own& own, const Other& other, ListSegment segment) const {
    const double along = differenceAlong(other.u, own.u, d), share = isWall(segment) ? 1 : 0.5;
    sum[0] = fma(share * forceApart(pairs, mph, apart, r, own.side, other.side), along, sum[0]);
  }
  __device__ void store(const MphPairs<D>&, std::uint32_t i, int, double sum) const {
    power[i] = apart.rate * sum;
  }
};

}  // namespace

template <int D>
void addRepulsion(Context<Cuda>& context, const MphPairs<D>& pairs, const PairsApart& apart, std::span<Vec<D>> y) {
  sumOnFluid(context, pairs, Repulsion<D, false>{pairs.terms, apart, y.data()});
}

template <int D>
void addRepulsionOnWalls(Context<Cuda>& context, const MphPairs<D>& pairs, const PairsApart& apart,
                         std::span<Vec<D>> y) {
  sumOnList(context, pairs, pairs.wallList, Repulsion<D, true>{pairs.terms, apart, y.data()});
}

template <int D>
void repulsionPower(Context<Cuda>& context, const MphPairs<D>& pairs, const PairsApart& apart,
                    std::span<const Vec<D>> u, std::span<double> power) {
  sumOnFluid(context, pairs, RepulsionPower<D>{pairs.terms, apart, u.data(), power.data()});
}

#define TREACLE_INSTANTIATE(D)                                                                                    \
  template void addRepulsion<D>(Context<Cuda>&, const MphPairs<D>&, const PairsApart&, std::span<Vec<D>>);        \
  template void addRepulsionOnWalls<D>(Context<Cuda>&, const MphPairs<D>&, const PairsApart&, std::span<Vec<D>>); \
  template void repulsionPower<D>(Context<Cuda>&, const MphPairs<D>&, const PairsApart&, std::span<const Vec<D>>, \
                                  std::span<double>);
TREACLE_INSTANTIATE(2)
TREACLE_INSTANTIATE(3)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
