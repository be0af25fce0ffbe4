#pragma once

#include "treacle/mph/mph_balance.hpp"
#include "treacle/mph/pair_sums.hpp"

namespace treacle {

// The sums of mph_balance.hpp, for the sources of both backends, which instantiate them.

/// A particle, its velocity and, where viscosities count, what decides on its own.
template <int D, class At>
struct MovingSide {
  At at;
  VecAt<D, At> u;
  typename At::template Viscosity<D> viscosity;

  TREACLE_HD static MovingSide of(const MphPairs<D>& pairs, const Vec<D>* u, const At& at) {
    return {at, at([&](std::uint32_t i) { return u[i]; }), at.viscosity(pairs)};
  }
};

/// 2 (d+2) mu (u_ij.e_ij)^2 (-w'^v) / r per fluid particle, half of a pair of fluid [K23 eq. (10)]; with Rate the
/// shear rate that follows from it for a viscosity of 1.
template <int D, class Mph, bool Corrected, bool Rate>
struct ShearDissipation {
  static constexpr int values = 1;
  static constexpr bool uses(ListSegment) { return true; }

  Mph mph;
  const Vec<D>* u;
  double* result;
  const double* share;  // of the rate

  template <class At>
  TREACLE_HD MovingSide<D, At> own(const MphPairs<D>& pairs, const At& at) const {
    return MovingSide<D, At>::of(pairs, u, at);
  }
  template <class T, class O>
  TREACLE_HD void add(const MphPairs<D>& pairs, T* sum, const Vec<D, T>& d, const PairDistance<T>& r, const O& own,
                      const MovingSide<D, OneParticle>& other, ListSegment segment) const {
    const std::uint32_t j = other.at.index;
    const T along = differenceAlong(other.u, own.u, d);
    T resists = mph.viscousShape(r) * along * along;
    if constexpr (!Rate) resists *= viscosityOf(pairs, own.viscosity, j);
    sum[0] += isWall(segment) ? T(resists * wallFactorOf<Corrected>(pairs, own.at, j, d)) : T(0.5 * resists);
  }
  TREACLE_HD void store(const MphPairs<D>&, std::uint32_t i, int, double sum) const {
    result[i] = Rate ? sqrt(mph.viscousFactor * sum * share[i]) : mph.viscousFactor * sum;
  }
};

/// Force on a wall particle [K23 eq. (4)], and the parts of its C^T u and n, from the fluid near it.
template <int D, class Mph, bool Corrected>
struct FluidAtWall {
  static constexpr int values = D + 2;
  static constexpr bool uses(ListSegment s) { return isFluid(s); }
  template <class At>
  struct Own {
    MovingSide<D, At> side;
    NumberAt<At> pressure;
  };

  Mph mph;
  const Vec<D>* u;
  const double* pressure;
  FluidAtWalls<D> out;  // of the first wall particle

  template <class At>
  TREACLE_HD Own<At> own(const MphPairs<D>& pairs, const At& at) const {
    return {MovingSide<D, At>::of(pairs, u, at), at([&](std::uint32_t i) { return pressure[i]; })};
  }
  template <class T, class O>
  TREACLE_HD void add(const MphPairs<D>& pairs, T* sum, const Vec<D, T>& d, const PairDistance<T>& r, const O& own,
                      const Own<OneParticle>& other, ListSegment) const {
    const std::uint32_t j = other.side.at.index;
    const T along = differenceAlong(other.side.u, own.side.u, d), g = mph.gradient(r);
    const T viscous = mph.viscousFactor * viscosityOf(pairs, own.side.viscosity, j) *
                      wallFactorOf<Corrected>(pairs, own.side.at, j, d) * mph.viscousShape(r) * along;
    if constexpr (Corrected) {
      addScaled(sum, viscous - g * own.pressure, d);
      addScaled(sum, -g * other.pressure, corrected(pairs, j, d));
      if (pairs.slips()) addAlongWall(pairs, sum, g, d, own.side.at, j);
    } else {
      addScaled(sum, viscous - g * (own.pressure + other.pressure), d);
    }
    sum[D] -= g * along;
    sum[D + 1] += mph.density(1.0, r);
  }
  /// Takes out what is along the wall, where the fluid slips.
  template <class T, class At>
  TREACLE_HD void addAlongWall(const MphPairs<D>& pairs, T* sum, const T& g, const Vec<D, T>& d, const At& at,
                               std::uint32_t j) const {
    for (int k = 0; k < D; ++k)
      sum[k] += g * ofEachPair(at, d, [&](std::uint32_t wall, const Vec<D>& toFluid) {
                  const Vec<D> both = pressure[wall] * toFluid + pressure[j] * pairs.corrected(j, toFluid);
                  return pairs.alongWall(j, wall, -1.0 * toFluid, both)[k];
                });
    sum[D] += g * ofEachPair(at, d, [&](std::uint32_t wall, const Vec<D>& toFluid) {
                return dot(u[j] - u[wall], pairs.alongWall(j, wall, -1.0 * toFluid, toFluid));
              });
  }
  TREACLE_HD void store(const MphPairs<D>& pairs, std::uint32_t i, int n, double sum) const {
    const std::uint32_t wall = i - pairs.fluidCount;
    if (n < D)
      out.force[wall][n] = sum;
    else if (n == D)
      out.divergence[wall] = sum;
    else
      out.density[wall] = mph.densityFactor * sum;
  }
};

template <int D, class Backend>
void shearDissipation(Context<Backend>& context, const MphPairs<D>& pairs, std::span<const Vec<D>> u,
                      std::span<double> dissipation) {
  withStepTerms(pairs, [&]<class Mph, class Corrected>(const Mph& mph, Corrected) {
    using Terms = ShearDissipation<D, Mph, Corrected::value, false>;
    sumOnFluid(context, pairs, Terms{mph, u.data(), dissipation.data(), nullptr});
  });
}

template <int D, class Backend>
void shearRate(Context<Backend>& context, const MphPairs<D>& pairs, std::span<const Vec<D>> u,
               std::span<const double> share, std::span<double> rate) {
  withStepTerms(pairs, [&]<class Mph, class Corrected>(const Mph& mph, Corrected) {
    using Terms = ShearDissipation<D, Mph, Corrected::value, true>;
    sumOnFluid(context, pairs, Terms{mph, u.data(), rate.data(), share.data()});
  });
}

template <int D, class Backend>
void fluidAtWalls(Context<Backend>& context, const MphPairs<D>& pairs, const ClusterListView& walls,
                  std::span<const Vec<D>> u, std::span<const double> pressure, const FluidAtWalls<D>& out) {
  withStepTerms(pairs, [&]<class Mph, class Corrected>(const Mph& mph, Corrected) {
    sumOnList(context, pairs, walls, FluidAtWall<D, Mph, Corrected::value>{mph, u.data(), pressure.data(), out});
  });
}

#define TREACLE_ENERGY_SUMS(D, Backend)                                                          \
  template void shearDissipation(Context<Backend>&, const MphPairs<D>&, std::span<const Vec<D>>, \
                                 std::span<double>);                                             \
  template void shearRate(Context<Backend>&, const MphPairs<D>&, std::span<const Vec<D>>,        \
                          std::span<const double>, std::span<double>);                           \
  template void fluidAtWalls(Context<Backend>&, const MphPairs<D>&, const ClusterListView&,      \
                             std::span<const Vec<D>>, std::span<const double>, const FluidAtWalls<D>&);

}  // namespace treacle
