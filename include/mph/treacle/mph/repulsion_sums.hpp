#pragma once

#include "treacle/mph/mph_repulsion.hpp"
#include "treacle/mph/pair_sums.hpp"

namespace treacle {

// The sums of mph_repulsion.hpp, for the sources of both backends, which instantiate them.

/// Force of the repulsion on fluid particles, or on wall particles from the fluid.
template <int D, bool OnWalls>
struct Repulsion {
  static constexpr int values = D;
  static constexpr bool uses(ListSegment s) { return OnWalls ? s == ListSegment::NearFluid : isNear(s); }
  template <class At>
  struct Own {
    typename At::template Viscosity<D> viscosity;
  };

  double rate;
  Vec<D>* y;  // of the first fluid or wall particle

  template <class At>
  TREACLE_HD Own<At> own(const MphPairs<D>& pairs, const At& at) const {
    return {at.viscosity(pairs)};
  }
  TREACLE_HD std::uint32_t other(const MphPairs<D>&, std::uint32_t j) const { return j; }

  template <class T, class O>
  TREACLE_HD void add(const MphPairs<D>& pairs, T* sum, const Vec<D, T>& d, const PairDistance<T>& r, const O& own,
                      std::uint32_t other, ListSegment) const {
    addScaled(sum, viscosityOf(pairs, own.viscosity, other) * pairs.terms.repulsionShape(r), d);
  }
  TREACLE_HD void store(const MphPairs<D>& pairs, std::uint32_t i, int n, double sum) const {
    y[OnWalls ? i - pairs.fluidCount : i][n] -= rate * pairs.terms.viscousFactor * sum;
  }
};

/// What it gives to the motion per fluid particle, half of a pair of fluid.
template <int D>
struct RepulsionPower {
  static constexpr int values = 1;
  static constexpr bool uses(ListSegment s) { return isNear(s); }
  template <class At>
  struct Own {
    typename At::template Viscosity<D> viscosity;
    VecAt<D, At> u;
  };
  struct Neighbour {
    std::uint32_t index;
    Vec<D> u;
  };

  double rate;
  const Vec<D>* u;
  double* power;

  template <class At>
  TREACLE_HD Own<At> own(const MphPairs<D>& pairs, const At& at) const {
    return {at.viscosity(pairs), at([&](std::uint32_t i) { return u[i]; })};
  }
  TREACLE_HD Neighbour other(const MphPairs<D>&, std::uint32_t j) const { return {j, u[j]}; }

  template <class T, class O>
  TREACLE_HD void add(const MphPairs<D>& pairs, T* sum, const Vec<D, T>& d, const PairDistance<T>& r, const O& own,
                      const Neighbour& other, ListSegment segment) const {
    const double share = isWall(segment) ? 1 : 0.5;
    sum[0] += share * viscosityOf(pairs, own.viscosity, other.index) * pairs.terms.repulsionShape(r) *
              differenceAlong(other.u, own.u, d);
  }
  TREACLE_HD void store(const MphPairs<D>& pairs, std::uint32_t i, int, double sum) const {
    power[i] = rate * pairs.terms.viscousFactor * sum;
  }
};

template <int D, class Backend>
void addRepulsion(Context<Backend>& context, const MphPairs<D>& pairs, double rate, std::span<Vec<D>> y) {
  sumOnFluid(context, pairs, Repulsion<D, false>{rate, y.data()});
}

template <int D, class Backend>
void addRepulsionOnWalls(Context<Backend>& context, const MphPairs<D>& pairs, double rate, std::span<Vec<D>> y) {
  sumOnList(context, pairs, pairs.wallList, Repulsion<D, true>{rate, y.data()});
}

template <int D, class Backend>
void repulsionPower(Context<Backend>& context, const MphPairs<D>& pairs, double rate, std::span<const Vec<D>> u,
                    std::span<double> power) {
  sumOnFluid(context, pairs, RepulsionPower<D>{rate, u.data(), power.data()});
}

#define TREACLE_REPULSION_SUMS(D, Backend)                                                             \
  template void addRepulsion(Context<Backend>&, const MphPairs<D>&, double, std::span<Vec<D>>);        \
  template void addRepulsionOnWalls(Context<Backend>&, const MphPairs<D>&, double, std::span<Vec<D>>); \
  template void repulsionPower(Context<Backend>&, const MphPairs<D>&, double, std::span<const Vec<D>>, \
                               std::span<double>);

}  // namespace treacle
