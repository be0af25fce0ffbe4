#include "treacle/mph/conduction.hpp"

#include "mph/step_sums.cuh"
#include "treacle/mph/viscosity_scale.hpp"

namespace treacle {
namespace {

template <int D>
double laplacianFactor(const MphPairs<D>& pairs) {
  return pairs.terms.viscousFactor / (D + 2);
}

struct ParticleIndex {
  std::uint32_t i;
};

/// Sum of c r^4 per fluid particle, of neighbours that conduct.
template <int D>
struct ConductingMoment {
  static constexpr int values = 1;
  static constexpr bool uses(ListSegment) { return true; }
  using Own = ParticleIndex;
  using Other = ParticleIndex;

  MphTerms<D> mph;
  Conduction terms;
  double* scale;

  __device__ Own loadOwn(const MphPairs<D>&, std::uint32_t i) const { return {i}; }
  __device__ Other loadOther(const MphPairs<D>&, std::uint32_t j) const { return {j}; }

  __device__ void add(const MphPairs<D>&, double* sum, const Vec<D>& d, const PairDistance<double>& r, Own,
                      Other other, ListSegment segment) const {
    if (isWall(segment) && !terms.conducts(other.i)) return;
    sum[0] = fma(mph.resistanceShape(r), norm2(d), sum[0]);
  }
  __device__ void store(const MphPairs<D>&, std::uint32_t i, int, double sum) const {
    scale[i] = viscosityScaleOf<D>(mph.viscousFactor * sum, 1);
  }
};

/// Per fluid particle the sum of kappa over fluid neighbours, that over walls, and that of kappa T over walls.
template <int D>
struct ConductionDiagonal {
  static constexpr int values = 3;
  static constexpr bool uses(ListSegment) { return true; }
  using Own = ParticleIndex;
  using Other = ParticleIndex;

  MphTerms<D> mph;
  Conduction terms;
  double factor;
  double* ofFluid;
  HeatExchange* ofWalls;

  __device__ Own loadOwn(const MphPairs<D>&, std::uint32_t i) const { return {i}; }
  __device__ Other loadOther(const MphPairs<D>&, std::uint32_t j) const { return {j}; }

  __device__ void add(const MphPairs<D>& pairs, double* sum, const Vec<D>& d, const PairDistance<double>& r,
                      Own own, Other other, ListSegment segment) const {
    const double shape = mph.resistanceShape(r);
    if (isFluid(segment)) {
      if (own.i == other.i) return;
      sum[0] = fma(terms.ofFluid(pairs.substance(own.i), pairs.substance(other.i), terms.scale[own.i],
                                 terms.scale[other.i]),
                   shape, sum[0]);
      return;
    }
    const double kappa = terms.ofWall(pairs, own.i, other.i, d) * shape;
    sum[1] += kappa;
    sum[2] = fma(kappa, terms.walls[terms.body[other.i]].temperature, sum[2]);
  }
  __device__ void store(const MphPairs<D>&, std::uint32_t i, int n, double sum) const {
    double& value = n == 0 ? ofFluid[i] : n == 1 ? ofWalls[i].coefficient : ofWalls[i].gain;
    value = factor * sum;
  }
};

/// extra T + sum of kappa (T_i - T_j) per fluid particle.
template <int D>
struct Conduct {
  static constexpr int values = 1;
  static constexpr bool uses(ListSegment s) { return isFluid(s); }
  struct Own {
    double T, scale;
    Substance substance;
  };
  using Other = Own;

  MphTerms<D> mph;
  Conduction terms;
  double factor;
  const double *extra, *T;
  double* y;

  __device__ Own loadOwn(const MphPairs<D>& pairs, std::uint32_t i) const {
    return {T[i], terms.scale[i], pairs.substance(i)};
  }
  __device__ Other loadOther(const MphPairs<D>& pairs, std::uint32_t j) const { return loadOwn(pairs, j); }

  __device__ void add(const MphPairs<D>&, double* sum, const Vec<D>&, const PairDistance<double>& r,
                      const Own& own, const Other& other, ListSegment) const {
    const double k = terms.ofFluid(own.substance, other.substance, own.scale, other.scale);
    sum[0] = fma(k * mph.resistanceShape(r), own.T - other.T, sum[0]);
  }
  __device__ void store(const MphPairs<D>&, std::uint32_t i, int, double sum) const {
    y[i] = fma(extra[i], T[i], factor * sum);
  }
};

}  // namespace

template <int D>
void conductionScale(Context<Cuda>& context, const MphPairs<D>& pairs, const Conduction& terms,
                     std::span<double> scale) {
  sumOnFluid(context, pairs, ConductingMoment<D>{pairs.terms, terms, scale.data()});
}

template <int D>
void conductionDiagonal(Context<Cuda>& context, const MphPairs<D>& pairs, const Conduction& terms,
                        std::span<double> ofFluid, std::span<HeatExchange> ofWalls) {
  sumOnFluid(context, pairs,
             ConductionDiagonal<D>{pairs.terms, terms, laplacianFactor(pairs), ofFluid.data(), ofWalls.data()});
}

template <int D>
void conduct(Context<Cuda>& context, const MphPairs<D>& pairs, const Conduction& terms,
             std::span<const double> extra, std::span<const double> T, std::span<double> y) {
  sumOnFluid(context, pairs,
             Conduct<D>{pairs.terms, terms, laplacianFactor(pairs), extra.data(), T.data(), y.data()});
}

#define TREACLE_INSTANTIATE(D)                                                                                  \
  template void conductionScale<D>(Context<Cuda>&, const MphPairs<D>&, const Conduction&, std::span<double>);   \
  template void conductionDiagonal<D>(Context<Cuda>&, const MphPairs<D>&, const Conduction&, std::span<double>, \
                                      std::span<HeatExchange>);                                                 \
  template void conduct<D>(Context<Cuda>&, const MphPairs<D>&, const Conduction&, std::span<const double>,      \
                           std::span<const double>, std::span<double>);
TREACLE_INSTANTIATE(2)
TREACLE_INSTANTIATE(3)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
