#include "treacle/mph/mph_repulsion.hpp"

#include "mph/step_sums.cuh"

namespace treacle {
namespace {

/// Force of the repulsion on fluid particles, or on wall particles from the fluid.
template <int D, bool OnWalls>
struct Repulsion {
  static constexpr int values = D;
  static constexpr bool uses(ListSegment s) { return OnWalls ? s == ListSegment::NearFluid : isNear(s); }
  using Own = ViscousSide;
  using Other = ViscousSide;

  MphTerms<D, double> mph;
  double rate;
  Vec<D>* y;  // of the first fluid or wall particle

  __device__ Own loadOwn(const MphPairs<D>& pairs, std::uint32_t i) const { return pairs.viscousSide(i); }
  __device__ Other loadOther(const MphPairs<D>& pairs, std::uint32_t j) const { return pairs.viscousSide(j); }

  __device__ void add(const MphPairs<D>& pairs, double* sum, const Vec<D>& d, const PairDistance<double>& r,
                      Own own, Other other, ListSegment) const {
    addScaled(sum, pairs.viscosityOf(own, other) * mph.repulsionShape(r), d);
  }
  __device__ void store(const MphPairs<D>& pairs, std::uint32_t i, int n, double sum) const {
    y[OnWalls ? i - pairs.fluidCount : i][n] -= rate * mph.viscousFactor * sum;
  }
};

/// What it gives to the motion per fluid particle, half of a pair of fluid.
template <int D>
struct RepulsionPower {
  static constexpr int values = 1;
  static constexpr bool uses(ListSegment s) { return isNear(s); }
  using Own = VelocityOf<D, double, PairViscosity::Any>;
  using Other = Own;

  MphTerms<D, double> mph;
  double rate;
  const Vec<D>* u;
  double* power;

  __device__ Own loadOwn(const MphPairs<D>& pairs, std::uint32_t i) const {
    return {u[i], {pairs.viscousSide(i)}};
  }
  __device__ Other loadOther(const MphPairs<D>& pairs, std::uint32_t j) const { return loadOwn(pairs, j); }

  __device__ void add(const MphPairs<D>& pairs, double* sum, const Vec<D>& d, const PairDistance<double>& r,
                      const Own& own, const Other& other, ListSegment segment) const {
    const double along = differenceAlong(other.u, own.u, d), share = isWall(segment) ? 1 : 0.5;
    const double mu = pairs.viscosityOf(own.viscosity.side, other.viscosity.side);
    sum[0] = fma(share * mu * mph.repulsionShape(r), along, sum[0]);
  }
  __device__ void store(const MphPairs<D>&, std::uint32_t i, int, double sum) const {
    power[i] = rate * mph.viscousFactor * sum;
  }
};

}  // namespace

template <int D>
void addRepulsion(Context<Cuda>& context, const MphPairs<D>& pairs, double rate, std::span<Vec<D>> y) {
  sumOnFluid(context, pairs, Repulsion<D, false>{pairs.terms, rate, y.data()});
}

template <int D>
void addRepulsionOnWalls(Context<Cuda>& context, const MphPairs<D>& pairs, double rate, std::span<Vec<D>> y) {
  sumOnList(context, pairs, pairs.wallList, Repulsion<D, true>{pairs.terms, rate, y.data()});
}

template <int D>
void repulsionPower(Context<Cuda>& context, const MphPairs<D>& pairs, double rate, std::span<const Vec<D>> u,
                    std::span<double> power) {
  sumOnFluid(context, pairs, RepulsionPower<D>{pairs.terms, rate, u.data(), power.data()});
}

#define TREACLE_INSTANTIATE(D)                                                                         \
  template void addRepulsion<D>(Context<Cuda>&, const MphPairs<D>&, double, std::span<Vec<D>>);        \
  template void addRepulsionOnWalls<D>(Context<Cuda>&, const MphPairs<D>&, double, std::span<Vec<D>>); \
  template void repulsionPower<D>(Context<Cuda>&, const MphPairs<D>&, double, std::span<const Vec<D>>, \
                                  std::span<double>);
TREACLE_INSTANTIATE(2)
TREACLE_INSTANTIATE(3)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
