#pragma once

#include "treacle/core/block.hpp"
#include "treacle/mph/pair_sums.hpp"
#include "treacle/mph/pressure_stiffness.hpp"

namespace treacle {

// The sums of pressure_stiffness.hpp, for the sources of both backends, which instantiate them.

/// d.(L d)
template <int D, class Number, class T>
TREACLE_HD inline T rateAlong(const Vec<D, Number> (&L)[D], const Vec<D, T>& d) {
  T sum = d[0] * along(L[0], d);
  for (int k = 1; k < D; ++k) sum += d[k] * along(L[k], d);
  return sum;
}

/// Sum of mu_ij viscous (d.L d) d over the neighbours of a fluid particle, or over fluid for a wall particle.
template <int D, bool OnWalls>
struct GivenBack {
  static constexpr int values = D;
  static constexpr bool uses(ListSegment s) { return !OnWalls || isFluid(s); }
  template <class At>
  struct Own {
    At at;
    typename At::template Viscosity<D> viscosity;
    VecAt<D, At> gradient[D];  // rows of L
  };
  struct Neighbour {
    std::uint32_t index;
    Vec<D> gradient[D];
  };

  MphTerms<D, double, AccurateScheme> mph;
  const Block<D>* gradient;
  std::uint32_t fluidCount;
  Vec<D>* force;  // of the first fluid or wall particle

  TREACLE_HD Vec<D> row(std::uint32_t i, int k) const {
    Vec<D> r{};
    for (int s = 0; s < D; ++s) r[s] = i < fluidCount ? gradient[i](k, s) : 0;
    return r;
  }
  template <class At>
  TREACLE_HD Own<At> own(const MphPairs<D>& pairs, const At& at) const {
    Own<At> side{at, at.viscosity(pairs), {}};
    if (!OnWalls)
      for (int k = 0; k < D; ++k) side.gradient[k] = at([&](std::uint32_t i) { return row(i, k); });
    return side;
  }
  TREACLE_HD Neighbour other(const MphPairs<D>&, std::uint32_t j) const {
    Neighbour side{j, {}};
    for (int k = 0; k < D; ++k) side.gradient[k] = row(j, k);
    return side;
  }
  template <class T, class O>
  TREACLE_HD void add(const MphPairs<D>& pairs, T* sum, const Vec<D, T>& d, const PairDistance<T>& r, const O& own,
                      const Neighbour& other, ListSegment segment) const {
    T resists = mph.viscousFactor * viscosityOf(pairs, own.viscosity, other.index) * mph.viscousShape(r);
    if (OnWalls || isWall(segment))
      resists *= ofEachPair(own.at, d, [&](std::uint32_t i, const Vec<D>&) {
        return OnWalls ? pairs.ownShareAtWall(other.index, i) : pairs.ownShareAtWall(i, other.index);
      });
    T rate;
    if constexpr (OnWalls)
      rate = rateAlong(other.gradient, d);
    else
      rate = isWall(segment) ? rateAlong(own.gradient, d)
                             : T(0.5 * (rateAlong(own.gradient, d) + rateAlong(other.gradient, d)));
    addScaled(sum, resists * rate, d);
  }
  TREACLE_HD void store(const MphPairs<D>& pairs, std::uint32_t i, int n, double sum) const {
    force[OnWalls ? i - pairs.fluidCount : i][n] -= sum;
  }
};

template <class Backend>
StiffFluid setStiffness(Context<Backend>& context, const StiffnessTerms& terms) {
  const auto sums = sumEach<StiffnessTerms::count>(
      context, terms.viscosity.size(), [=] TREACLE_HD(std::size_t i, double* each) { terms.add(i, each); });
  return {sums[0], sums[2] > 0 ? sums[1] / sums[2] : 0};
}

template <class Backend>
void setStiffScale(Context<Backend>& context, const StiffScale& terms) {
  forEach(context, terms.viscosity.size(), [=] TREACLE_HD(std::size_t i) { terms.set(i); });
}

template <class Backend>
void setGivenScale(Context<Backend>& context, const GivenScale& terms) {
  forEach(context, terms.viscosity.size(), [=] TREACLE_HD(std::size_t i) { terms.set(i); });
}

template <int D, class Backend>
void giveBack(Context<Backend>& context, const MphPairs<D>& pairs, std::span<const Block<D>> gradient,
              std::span<Vec<D>> force) {
  sumOnFluid(
      context, pairs,
      GivenBack<D, false>{pairs.terms.with(AccurateScheme{}), gradient.data(), pairs.fluidCount, force.data()});
}

template <int D, class Backend>
void giveBackOnWalls(Context<Backend>& context, const MphPairs<D>& pairs, const ClusterListView& walls,
                     std::span<const Block<D>> gradient, std::span<Vec<D>> force) {
  sumOnList(
      context, pairs, walls,
      GivenBack<D, true>{pairs.terms.with(AccurateScheme{}), gradient.data(), pairs.fluidCount, force.data()});
}

#define TREACLE_STIFFNESS_SUMS(D, Backend)                                                                     \
  template void giveBack(Context<Backend>&, const MphPairs<D>&, std::span<const Block<D>>, std::span<Vec<D>>); \
  template void giveBackOnWalls(Context<Backend>&, const MphPairs<D>&, const ClusterListView&,                 \
                                std::span<const Block<D>>, std::span<Vec<D>>);
#define TREACLE_STIFFNESS(Backend)                                            \
  template StiffFluid setStiffness(Context<Backend>&, const StiffnessTerms&); \
  template void setStiffScale(Context<Backend>&, const StiffScale&);          \
  template void setGivenScale(Context<Backend>&, const GivenScale&);

}  // namespace treacle
