#pragma once

#include "treacle/mph/conduction.hpp"
#include "treacle/mph/pair_sums.hpp"
#include "treacle/mph/viscous_moment.hpp"

#include <cmath>

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

/// Whose conductivities a sum reads.
enum class Conductivities { OfMaterials, OfParticles };

/// What decides on the conductivity of a pair of fluid.
template <class At, Conductivities whose>
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
  TREACLE_HD NumberAt<At> with(const Conduction& terms, const ConductingSide<OneParticle, whose>& other) const {
    return 0.5 * (scale + other.scale) *
           ofEach(substance, [&](Substance own) { return terms.table.pairConductivity[own][other.substance]; });
  }
};

template <class At>
struct ConductingSide<At, Conductivities::OfParticles> {
  static constexpr Conductivities whose = Conductivities::OfParticles;

  At at;
  EachAt<Substance, At> substance;
  NumberAt<At> scale, temperature, conductivity, conducted;

  template <int D>
  TREACLE_HD static ConductingSide of(const MphPairs<D>& pairs, const Conduction& terms, const At& at) {
    const auto load = [&](const double* from) {
      return at([&](std::uint32_t i) { return i < pairs.fluidCount ? from[i] : 0.0; });
    };
    return {at,
            at([&](std::uint32_t i) { return pairs.substance(i); }),
            load(terms.scale),
            load(terms.own.temperature),
            load(terms.own.conductivity),
            load(terms.own.conducted)};
  }
  /// Two that do not conduct have a harmonic mean of 0.
  TREACLE_HD NumberAt<At> with(const Conduction&, const ConductingSide<OneParticle, whose>& other) const {
    using Number = NumberAt<At>;
    const Number difference = temperature - other.temperature, half = 0.5 * (scale + other.scale);
    const auto close = difference * difference < OwnConduction::close * OwnConduction::close;
    const Number mean = select(close, Number(0.5 * (conductivity + other.conductivity)),
                               Number((conducted - other.conducted) / select(close, Number(1.0), difference)));
    const Number harmonic = 2 * conductivity * other.conductivity / (conductivity + (other.conductivity + 1e-300));
    const Number same = ofEach(substance, [&](Substance own) { return own == other.substance ? 1.0 : 0.0; });
    return half * (same * mean + (1 - same) * harmonic);
  }
};

/// Per fluid particle the sum of kappa over fluid neighbours, that over walls, and that of kappa T over walls.
template <int D, Conductivities whose>
struct ConductionDiagonal {
  static constexpr int values = 3;
  static constexpr bool uses(ListSegment) { return true; }

  Conduction terms;
  double* ofFluid;
  HeatExchange* ofWalls;

  template <class At>
  TREACLE_HD ConductingSide<At, whose> own(const MphPairs<D>& pairs, const At& at) const {
    return ConductingSide<At, whose>::of(pairs, terms, at);
  }
  template <class T, class O>
  TREACLE_HD void add(const MphPairs<D>& pairs, T* sum, const Vec<D, T>& d, const PairDistance<T>& r, const O& own,
                      const ConductingSide<OneParticle, whose>& other, ListSegment segment) const {
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
template <int D, Conductivities whose>
struct Conduct {
  static constexpr int values = 1;
  static constexpr bool uses(ListSegment s) { return isFluid(s); }
  template <class At>
  struct Own {
    ConductingSide<At, whose> side;
    NumberAt<At> temperature;
  };

  Conduction terms;
  const double *extra, *temperature;
  double* y;

  template <class At>
  TREACLE_HD Own<At> own(const MphPairs<D>& pairs, const At& at) const {
    return {ConductingSide<At, whose>::of(pairs, terms, at), at([&](std::uint32_t i) { return temperature[i]; })};
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
  using enum Conductivities;
  if (terms.own.temperature)
    sumOnFluid(context, pairs, ConductionDiagonal<D, OfParticles>{terms, ofFluid.data(), ofWalls.data()});
  else
    sumOnFluid(context, pairs, ConductionDiagonal<D, OfMaterials>{terms, ofFluid.data(), ofWalls.data()});
}

template <int D, class Backend>
void conduct(Context<Backend>& context, const MphPairs<D>& pairs, const Conduction& terms,
             std::span<const double> extra, std::span<const double> T, std::span<double> y) {
  using enum Conductivities;
  if (terms.own.temperature)
    sumOnFluid(context, pairs, Conduct<D, OfParticles>{terms, extra.data(), T.data(), y.data()});
  else
    sumOnFluid(context, pairs, Conduct<D, OfMaterials>{terms, extra.data(), T.data(), y.data()});
}

#define TREACLE_CONDUCTION_SUMS(D, Backend)                                                                     \
  template void conductionScale(Context<Backend>&, const MphPairs<D>&, const Conduction&, std::span<double>);   \
  template void conductionDiagonal(Context<Backend>&, const MphPairs<D>&, const Conduction&, std::span<double>, \
                                   std::span<HeatExchange>);                                                    \
  template void conduct(Context<Backend>&, const MphPairs<D>&, const Conduction&, std::span<const double>,      \
                        std::span<const double>, std::span<double>);

}  // namespace treacle
