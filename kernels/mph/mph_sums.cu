#include "treacle/mph/mph_sums.hpp"

#include "mph/step_sums.cuh"

namespace treacle {
namespace {

/// n_i = sum_j w_ij^p per particle [K23 eq. (7)].
template <int D, class Mph, bool Far>
struct NumberDensity {
  static constexpr int values = 1;
  static constexpr bool uses(ListSegment s) { return Far || isNear(s); }
  using Own = std::uint32_t;  // the index: a particle is not its own neighbour
  using Other = std::uint32_t;

  Mph mph;
  double* n;

  __device__ Own loadOwn(const MphPairs<D>&, std::uint32_t i) const { return i; }
  __device__ Other loadOther(const MphPairs<D>&, std::uint32_t j) const { return j; }

  __device__ void add(const MphPairs<D>&, double* sum, const Vec<D>&, const PairDistance<double>& r, Own own,
                      Other other, ListSegment) const {
    if (own != other) sum[0] += mph.density(1.0, r);
  }
  __device__ void store(const MphPairs<D>&, std::uint32_t i, int, double sum) const {
    n[i] = mph.densityFactor * sum;
  }
};

/// The same with what else there is to know of the particle's place (PlaceSums).
template <int D>
struct DensityAndPlace {
  static constexpr int values = D + 2;
  static constexpr bool uses(ListSegment) { return true; }
  using StoresAll = void;
  using Own = std::uint32_t;
  using Other = std::uint32_t;

  MphTerms<D> mph;
  double openScale, wideScale;  // MphPairs::opennessFactor, wideScale
  double *n, *open, *wide;

  __device__ Own loadOwn(const MphPairs<D>&, std::uint32_t i) const { return i; }
  __device__ Other loadOther(const MphPairs<D>&, std::uint32_t j) const { return j; }

  __device__ void add(const MphPairs<D>&, double* sum, const Vec<D>& d, const PairDistance<double>& r, Own own,
                      Other other, ListSegment) const {
    if (own == other) return;
    sum[0] += mph.density(1.0, r);
    const double v = mph.openness(r);
    for (int k = 0; k < D; ++k) sum[1 + k] = fma(v, d[k], sum[1 + k]);
    sum[1 + D] += v;
  }
  __device__ void store(const MphPairs<D>&, std::uint32_t i, const double* sum) const {
    n[i] = mph.densityFactor * sum[0];
    double square = 0;
    for (int k = 0; k < D; ++k) square = fma(sum[1 + k], sum[1 + k], square);
    open[i] = openScale * sqrt(square);
    wide[i] = wideScale * sum[1 + D];
  }
};

/// What wall particles add to n_i, per fluid particle.
template <int D, class Mph>
struct WallDensity {
  static constexpr int values = 1;
  static constexpr bool uses(ListSegment s) { return isWall(s); }
  struct Own {};
  using Other = Own;

  Mph mph;
  double* n;

  __device__ Own loadOwn(const MphPairs<D>&, std::uint32_t) const { return {}; }
  __device__ Other loadOther(const MphPairs<D>&, std::uint32_t) const { return {}; }

  __device__ void add(const MphPairs<D>&, double* sum, const Vec<D>&, const PairDistance<double>& r, Own, Other,
                      ListSegment) const {
    sum[0] += mph.density(1.0, r);
  }
  __device__ void store(const MphPairs<D>&, std::uint32_t i, int, double sum) const {
    n[i] = mph.densityFactor * sum;
  }
};

/// Of a pair of fluid and wall.
struct Side {
  std::uint32_t index;
  ViscousSide viscous;

  template <int D>
  __device__ static Side of(const MphPairs<D>& pairs, std::uint32_t i) {
    return {i, pairs.viscousSide(i)};
  }
};

template <int D, class Mph, bool Corrected>
struct WallSums {
  static constexpr int values = D * D + D;
  static constexpr bool uses(ListSegment s) { return isWall(s); }
  using Own = Side;
  using Other = Side;

  Mph mph;
  WallTerms<D> terms;

  __device__ Own loadOwn(const MphPairs<D>& pairs, std::uint32_t i) const { return Side::of(pairs, i); }
  __device__ Other loadOther(const MphPairs<D>& pairs, std::uint32_t j) const { return Side::of(pairs, j); }

  __device__ void add(const MphPairs<D>& pairs, double* sum, const Vec<D>& d, const PairDistance<double>& r, Own i,
                      Other j, ListSegment) const {
    const double f = pairs.viscosityOf(i.viscous, j.viscous) *
                     viscosityFactor<Corrected>(pairs, i.index, j.index, d) * mph.viscousShape(r);
    for (int r = 0; r < D; ++r) addScaled(sum + r * D, f * d[r], d);
    addScaled(sum + D * D, mph.gradientShape(r), d);
  }
  __device__ void store(const MphPairs<D>& pairs, std::uint32_t i, int n, double sum) const {
    if (n >= D * D) {
      if (!terms.gradient.empty()) terms.gradient[i][n - D * D] = mph.gradientFactor * sum;
    } else {
      const bool diagonal = n % (D + 1) == 0;
      terms.block[i].a[n] = mph.viscousFactor * sum + (diagonal ? pairs.inertia(i) : 0.0);
    }
  }
};

template <int D, class Mph, bool Corrected>
struct WallDrag {
  static constexpr int values = D;
  static constexpr bool uses(ListSegment s) { return isWall(s); }
  using Own = Side;
  struct Other {
    Side side;
    Vec<D> u;
  };

  Mph mph;
  const Vec<D>* u;
  Vec<D>* y;

  __device__ Own loadOwn(const MphPairs<D>& pairs, std::uint32_t i) const { return Side::of(pairs, i); }
  __device__ Other loadOther(const MphPairs<D>& pairs, std::uint32_t j) const {
    return {Side::of(pairs, j), u[j]};
  }

  __device__ void add(const MphPairs<D>& pairs, double* sum, const Vec<D>& d, const PairDistance<double>& r, Own i,
                      const Other& other, ListSegment) const {
    const Side& j = other.side;
    const double f = pairs.viscosityOf(i.viscous, j.viscous) *
                     viscosityFactor<Corrected>(pairs, i.index, j.index, d) * mph.viscousShape(r);
    addScaled(sum, f * dot(d, other.u), d);
  }
  __device__ void store(const MphPairs<D>&, std::uint32_t i, int n, double sum) const {
    y[i][n] += mph.viscousFactor * sum;
  }
};

}  // namespace

template <int D>
void numberDensity(Context<Cuda>& context, const MphPairs<D>& pairs, std::span<double> n,
                   const PlaceSums& places) {
  if (!places.open.empty())
    return sumOnAll(context, pairs,
                    DensityAndPlace<D>{pairs.terms, pairs.opennessFactor(), pairs.wideScale, n.data(),
                                       places.open.data(), places.wide.data()});
  if (pairs.terms.densityRadius > pairs.terms.pressureRadius)
    return sumOnAll(context, pairs, NumberDensity<D, MphTerms<D>, true>{pairs.terms, n.data()});
  withScheme(pairs.terms, [&]<class Mph>(const Mph& mph) {
    sumOnAll(context, pairs, NumberDensity<D, Mph, false>{mph, n.data()});
  });
}

template <int D>
void wallDensity(Context<Cuda>& context, const MphPairs<D>& pairs, std::span<double> n) {
  withScheme(pairs.terms, [&]<class Mph>(const Mph& mph) {
    sumOnFluid(context, pairs, WallDensity<D, Mph>{mph, n.data()});
  });
}

template <int D>
void addPressureGradient(Context<Cuda>& context, const MphPairs<D>& pairs, std::span<const double> q,
                         double factor, std::span<Vec<D>> y) {
  withStepTerms(pairs, [&]<class Mph, class Corrected>(const Mph& mph, Corrected) {
    sumOnFluid(context, pairs,
               PressureForce<D, double, Mph, Corrected::value, true>{mph, q.data(), y.data(), factor});
  });
}

template <int D>
void divergence(Context<Cuda>& context, const MphPairs<D>& pairs, std::span<const Vec<D>> u,
                std::span<double> div) {
  withStepTerms(pairs, [&]<class Mph, class Corrected>(const Mph& mph, Corrected) {
    sumOnAll(context, pairs,
             Divergence<D, double, Mph, Corrected::value, false, false>{mph, u.data(), div.data()});
  });
}

template <int D>
void wallTerms(Context<Cuda>& context, const MphPairs<D>& pairs, const WallTerms<D>& terms) {
  withStepTerms(pairs, [&]<class Mph, class Corrected>(const Mph& mph, Corrected) {
    sumOnFluid(context, pairs, WallSums<D, Mph, Corrected::value>{mph, terms});
  });
  if (pairs.renormalisation)
    forEach(context, terms.gradient.size(),
            [b = pairs.renormalisation, g = terms.gradient] __device__(std::size_t i) { g[i] = b[i] * g[i]; });
}

template <int D>
void addWallDrag(Context<Cuda>& context, const MphPairs<D>& pairs, std::span<const Vec<D>> u,
                 std::span<Vec<D>> y) {
  withStepTerms(pairs, [&]<class Mph, class Corrected>(const Mph& mph, Corrected) {
    sumOnFluid(context, pairs, WallDrag<D, Mph, Corrected::value>{mph, u.data(), y.data()});
  });
}

#define TREACLE_INSTANTIATE(D)                                                                                 \
  template void numberDensity<D>(Context<Cuda>&, const MphPairs<D>&, std::span<double>, const PlaceSums&);     \
  template void wallDensity<D>(Context<Cuda>&, const MphPairs<D>&, std::span<double>);                         \
  template void addPressureGradient<D>(Context<Cuda>&, const MphPairs<D>&, std::span<const double>, double,    \
                                       std::span<Vec<D>>);                                                     \
  template void divergence<D>(Context<Cuda>&, const MphPairs<D>&, std::span<const Vec<D>>, std::span<double>); \
  template void wallTerms<D>(Context<Cuda>&, const MphPairs<D>&, const WallTerms<D>&);                         \
  template void addWallDrag<D>(Context<Cuda>&, const MphPairs<D>&, std::span<const Vec<D>>, std::span<Vec<D>>);
TREACLE_INSTANTIATE(2)
TREACLE_INSTANTIATE(3)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
