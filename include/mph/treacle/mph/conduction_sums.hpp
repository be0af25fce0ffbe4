#pragma once

#include "treacle/mph/conduction.hpp"
#include "treacle/mph/pair_sums.hpp"
#include "treacle/mph/viscous_moment.hpp"

namespace treacle {

// The sums of conduction.hpp, for the sources of both backends, which instantiate them.

/// Fluid, and the walls that have a temperature.
struct ConductingNeighbours {
  Conduction terms;
  TREACLE_HD bool operator()(std::uint32_t j, ListSegment segment) const {
    return isFluid(segment) || terms.conducts(j);
  }
};

/// By what sums of conduction are multiplied.
template <int D>
TREACLE_HD double laplacianFactor(const MphPairs<D>& pairs) {
  return pairs.terms.viscousFactor / (D + 2);
}

/// What decides on the conductivity of a pair of fluid.
template <class At>
struct ConductingSide {
  At at;
  EachAt<Substance, At> substance;
  NumberAt<At> scale;

  template <int D>
  TREACLE_HD static ConductingSide of(const MphPairs<D>& pairs, const Conduction& terms, const At& at) {
    return {at, at([&](std::uint32_t i) { return pairs.substance(i); }),
            at([&](std::uint32_t i) { return i < pairs.fluidCount ? terms.scale[i] : 0.0; })};
  }
  /// Over what the weight has for the pair.
  TREACLE_HD NumberAt<At> with(const Conduction& terms, const ConductingSide<OneParticle>& other) const {
    return 0.5 * (scale + other.scale) *
           ofEach(substance, [&](Substance own) { return terms.table.pairConductivity[own][other.substance]; });
  }
};

/// Per fluid particle the sum of kappa over fluid neighbours, that over walls, and that of kappa T over walls.
template <int D>
struct ConductionDiagonal {
  static constexpr int values = 3;
  static constexpr bool uses(ListSegment) { return true; }

  Conduction terms;
  double* ofFluid;
  HeatExchange* ofWalls;

  template <class At>
  TREACLE_HD ConductingSide<At> own(const MphPairs<D>& pairs, const At& at) const {
    return ConductingSide<At>::of(pairs, terms, at);
  }
  template <class T, class O>
  TREACLE_HD void add(const MphPairs<D>& pairs, T* sum, const Vec<D, T>& d, const PairDistance<T>& r, const O& own,
                      const ConductingSide<OneParticle>& other, ListSegment segment) const {
    const std::uint32_t j = other.at.index;
    if (isFluid(segment)) {
      sum[0] += isAnother(own.at, j) * own.with(terms, other) * pairs.terms.resistanceShape(r);
      return;
    }
    if (!terms.conducts(j)) return;
    const T kappa =
        ofEachPair(own.at, d,
                   [&](std::uint32_t i, const Vec<D>& toWall) { return terms.ofWall(pairs, i, j, toWall); }) *
        pairs.terms.resistanceShape(r);
    sum[1] += kappa;
    sum[2] += kappa * terms.walls[terms.body[j]].temperature;
  }
  TREACLE_HD void store(const MphPairs<D>& pairs, std::uint32_t i, int n, double sum) const {
    double& value = n == 0 ? ofFluid[i] : n == 1 ? ofWalls[i].coefficient : ofWalls[i].gain;
    value = laplacianFactor(pairs) * sum;
  }
};

/// extra T + sum of kappa (T_i - T_j) per fluid particle.
template <int D>
struct Conduct {
  static constexpr int values = 1;
  static constexpr bool uses(ListSegment s) { return isFluid(s); }
  template <class At>
  struct Own {
    ConductingSide<At> side;
    NumberAt<At> temperature;
  };

  Conduction terms;
  const double *extra, *temperature;
  double* y;

  template <class At>
  TREACLE_HD Own<At> own(const MphPairs<D>& pairs, const At& at) const {
    return {ConductingSide<At>::of(pairs, terms, at), at([&](std::uint32_t i) { return temperature[i]; })};
  }
  template <class T, class O>
  TREACLE_HD void add(const MphPairs<D>& pairs, T* sum, const Vec<D, T>&, const PairDistance<T>& r, const O& own,
                      const Own<OneParticle>& other, ListSegment) const {
    sum[0] +=
        own.side.with(terms, other.side) * pairs.terms.resistanceShape(r) * (own.temperature - other.temperature);
  }
  TREACLE_HD void store(const MphPairs<D>& pairs, std::uint32_t i, int, double sum) const {
    y[i] = extra[i] * temperature[i] + laplacianFactor(pairs) * sum;
  }
};

template <int D, class Backend>
void conductionScale(Context<Backend>& context, const MphPairs<D>& pairs, const Conduction& terms,
                     std::span<double> scale) {
  sumOnFluid(context, pairs, ViscousMoment<D, ConductingNeighbours>{1, scale.data(), {terms}});
}

template <int D, class Backend>
void conductionDiagonal(Context<Backend>& context, const MphPairs<D>& pairs, const Conduction& terms,
                        std::span<double> ofFluid, std::span<HeatExchange> ofWalls) {
  sumOnFluid(context, pairs, ConductionDiagonal<D>{terms, ofFluid.data(), ofWalls.data()});
}

template <int D, class Backend>
void conduct(Context<Backend>& context, const MphPairs<D>& pairs, const Conduction& terms,
             std::span<const double> extra, std::span<const double> T, std::span<double> y) {
  sumOnFluid(context, pairs, Conduct<D>{terms, extra.data(), T.data(), y.data()});
}

#define TREACLE_CONDUCTION_SUMS(D, Backend)                                                                     \
  template void conductionScale(Context<Backend>&, const MphPairs<D>&, const Conduction&, std::span<double>);   \
  template void conductionDiagonal(Context<Backend>&, const MphPairs<D>&, const Conduction&, std::span<double>, \
                                   std::span<HeatExchange>);                                                    \
  template void conduct(Context<Backend>&, const MphPairs<D>&, const Conduction&, std::span<const double>,      \
                        std::span<const double>, std::span<double>);

}  // namespace treacle
