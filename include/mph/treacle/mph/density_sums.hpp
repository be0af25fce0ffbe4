#pragma once

#include "treacle/mph/mph_sums.hpp"
#include "treacle/mph/pair_sums.hpp"

namespace treacle {

// Sums of mph_sums.hpp that are made once a step, for the sources of both backends, which instantiate them.

/// n_i = sum_j w_ij^p per particle [K23 eq. (7)].
template <int D, class Mph, bool Far>
struct NumberDensity {
  static constexpr int values = 1;
  static constexpr bool uses(ListSegment s) { return Far || isNear(s); }

  Mph mph;
  double* n;

  template <class At>
  TREACLE_HD At own(const MphPairs<D>&, const At& at) const {
    return at;
  }
  template <class T, class At>
  TREACLE_HD void add(const MphPairs<D>&, T* sum, const Vec<D, T>&, const PairDistance<T>& r, const At& own,
                      const OneParticle& other, ListSegment) const {
    sum[0] += isAnother(own, other.index) * mph.density(1.0, r);
  }
  TREACLE_HD void store(const MphPairs<D>&, std::uint32_t i, int, double sum) const {
    n[i] = mph.densityFactor * sum;
  }
};

/// The same with what else there is to know of the particle's place (PlaceSums), and with volumes or without.
template <int D, bool OfVolumes>
struct DensityAndPlace {
  static constexpr int values = D + 2;
  static constexpr bool uses(ListSegment) { return true; }
  using StoresAll = void;

  double* n;
  PlaceSums places;
  const double* volume;

  template <class At>
  TREACLE_HD At own(const MphPairs<D>&, const At& at) const {
    return at;
  }
  template <class T, class At>
  TREACLE_HD void add(const MphPairs<D>& pairs, T* sum, const Vec<D, T>& d, const PairDistance<T>& r,
                      const At& own, const OneParticle& other, ListSegment segment) const {
    T share = isAnother(own, other.index);
    if constexpr (OfVolumes)
      if (!isWall(segment)) share *= volume[other.index];
    const T v = share * pairs.terms.openness(r);
    sum[0] += share * pairs.terms.density(1.0, r);
    addScaled(sum + 1, v, d);
    sum[1 + D] += v;
  }
  TREACLE_HD void store(const MphPairs<D>& pairs, std::uint32_t i, const double* sum) const {
    double more = 0;  // of the particle itself
    if constexpr (OfVolumes)
      if (i < pairs.fluidCount) more = volume[i] - 1;
    n[i] = pairs.terms.densityFactor * (sum[0] + more * pairs.terms.density(1.0, ExactDistance(0)));
    double square = 0;
    for (int k = 0; k < D; ++k) square += sum[1 + k] * sum[1 + k];
    places.open[i] = pairs.opennessFactor() * sqrt(square);
    places.wide[i] = pairs.wideScale * (sum[1 + D] + more * pairs.terms.openness(ExactDistance(0)));
  }
};

/// What wall particles add to n_i, per fluid particle.
template <int D, class Mph>
struct WallDensity {
  static constexpr int values = 1;
  static constexpr bool uses(ListSegment s) { return isWall(s); }

  Mph mph;
  double* n;

  template <class At>
  TREACLE_HD At own(const MphPairs<D>&, const At& at) const {
    return at;
  }
  template <class T, class O>
  TREACLE_HD void add(const MphPairs<D>&, T* sum, const Vec<D, T>&, const PairDistance<T>& r, const O&,
                      const OneParticle&, ListSegment) const {
    sum[0] += mph.density(1.0, r);
  }
  TREACLE_HD void store(const MphPairs<D>&, std::uint32_t i, int, double sum) const {
    n[i] = mph.densityFactor * sum;
  }
};

/// A fluid particle that meets walls.
template <int D, class At>
struct WettingSide {
  At at;
  typename At::template Viscosity<D> viscosity;
};

/// The viscous pair blocks and the gradients of each fluid particle's walls.
template <int D, class Mph, bool Corrected>
struct SumWallTerms {
  static constexpr int values = D * D + D;
  static constexpr bool uses(ListSegment s) { return isWall(s); }

  Mph mph;
  WallTerms<D> terms;

  template <class At>
  TREACLE_HD WettingSide<D, At> own(const MphPairs<D>& pairs, const At& at) const {
    return {at, at.viscosity(pairs)};
  }
  TREACLE_HD OneParticle other(const MphPairs<D>&, std::uint32_t j) const { return {j}; }

  template <class T, class O>
  TREACLE_HD void add(const MphPairs<D>& pairs, T* sum, const Vec<D, T>& d, const PairDistance<T>& r, const O& own,
                      const OneParticle& other, ListSegment) const {
    const T f = viscosityOf(pairs, own.viscosity, other.index) *
                wallFactorOf<Corrected>(pairs, own.at, other.index, d) * mph.viscousShape(r);
    for (int row = 0; row < D; ++row) addScaled(sum + row * D, f * d[row], d);
    addScaled(sum + D * D, mph.gradientShape(r), d);
  }
  TREACLE_HD void store(const MphPairs<D>& pairs, std::uint32_t i, int n, double sum) const {
    if (n >= D * D) {
      if (!terms.gradient.empty()) terms.gradient[i][n - D * D] = mph.gradientFactor * sum;
    } else {
      const bool diagonal = n % (D + 1) == 0;
      terms.block[i].a[n] = mph.viscousFactor * sum + (diagonal ? pairs.inertia(i) : 0.0);
    }
  }
};

/// What moving walls drag of each fluid particle.
template <int D, class Mph, bool Corrected>
struct WallDrag {
  static constexpr int values = D;
  static constexpr bool uses(ListSegment s) { return isWall(s); }
  struct Neighbour {
    std::uint32_t index;
    Vec<D> u;
  };

  Mph mph;
  const Vec<D>* u;
  Vec<D>* y;

  template <class At>
  TREACLE_HD WettingSide<D, At> own(const MphPairs<D>& pairs, const At& at) const {
    return {at, at.viscosity(pairs)};
  }
  TREACLE_HD Neighbour other(const MphPairs<D>&, std::uint32_t j) const { return {j, u[j]}; }

  template <class T, class O>
  TREACLE_HD void add(const MphPairs<D>& pairs, T* sum, const Vec<D, T>& d, const PairDistance<T>& r, const O& own,
                      const Neighbour& other, ListSegment) const {
    const T f = viscosityOf(pairs, own.viscosity, other.index) *
                wallFactorOf<Corrected>(pairs, own.at, other.index, d) * mph.viscousShape(r);
    addScaled(sum, f * along(d, other.u), d);
  }
  TREACLE_HD void store(const MphPairs<D>&, std::uint32_t i, int n, double sum) const {
    y[i][n] += mph.viscousFactor * sum;
  }
};

template <int D, class Backend>
void numberDensity(Context<Backend>& context, const MphPairs<D>& pairs, std::span<double> n,
                   const PlaceSums& places, std::span<const double> volume) {
  if (!volume.empty()) return sumOnAll(context, pairs, DensityAndPlace<D, true>{n.data(), places, volume.data()});
  if (!places.open.empty()) return sumOnAll(context, pairs, DensityAndPlace<D, false>{n.data(), places, nullptr});
  if (pairs.terms.densityRadius > pairs.terms.pressureRadius)
    return sumOnAll(context, pairs, NumberDensity<D, MphTerms<D>, true>{pairs.terms, n.data()});
  withScheme(pairs.terms, [&]<class Mph>(const Mph& mph) {
    sumOnAll(context, pairs, NumberDensity<D, Mph, false>{mph, n.data()});
  });
}

template <int D, class Backend>
void wallDensity(Context<Backend>& context, const MphPairs<D>& pairs, std::span<double> n) {
  withScheme(pairs.terms, [&]<class Mph>(const Mph& mph) {
    sumOnFluid(context, pairs, WallDensity<D, Mph>{mph, n.data()});
  });
}

template <int D, class Backend>
void wallTerms(Context<Backend>& context, const MphPairs<D>& pairs, const WallTerms<D>& terms) {
  withStepTerms(pairs, [&]<class Mph, class Corrected>(const Mph& mph, Corrected) {
    sumOnFluid(context, pairs, SumWallTerms<D, Mph, Corrected::value>{mph, terms});
  });
  if (!pairs.renormalisation) return;
  const SymmetricBlock<D>* b = pairs.renormalisation;
  const std::span<Vec<D>> gradient = terms.gradient;
  forEach(context, gradient.size(), [=] TREACLE_HD(std::size_t i) { gradient[i] = b[i] * gradient[i]; });
}

template <int D, class Backend>
void addWallDrag(Context<Backend>& context, const MphPairs<D>& pairs, std::span<const Vec<D>> u,
                 std::span<Vec<D>> y) {
  withStepTerms(pairs, [&]<class Mph, class Corrected>(const Mph& mph, Corrected) {
    sumOnFluid(context, pairs, WallDrag<D, Mph, Corrected::value>{mph, u.data(), y.data()});
  });
}

#define TREACLE_DENSITY_SUMS(D, Backend)                                                                  \
  template void numberDensity(Context<Backend>&, const MphPairs<D>&, std::span<double>, const PlaceSums&, \
                              std::span<const double>);                                                   \
  template void wallDensity(Context<Backend>&, const MphPairs<D>&, std::span<double>);                    \
  template void wallTerms(Context<Backend>&, const MphPairs<D>&, const WallTerms<D>&);                    \
  template void addWallDrag(Context<Backend>&, const MphPairs<D>&, std::span<const Vec<D>>, std::span<Vec<D>>);

}  // namespace treacle
