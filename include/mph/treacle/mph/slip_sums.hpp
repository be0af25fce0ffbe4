#pragma once

#include "treacle/mph/mph_sums.hpp"
#include "treacle/mph/pair_sums.hpp"

namespace treacle {

// The sums of mph_sums.hpp along walls at which fluid slips (MphPairs::alongWall), for the sources of both
// backends, which instantiate them.

/// (C q)_i along walls, taken out of y += factor C q.
template <int D, class Mph>
struct GradientAlongWalls {
  static constexpr int values = D;
  static constexpr bool uses(ListSegment s) { return s == ListSegment::NearWall; }

  Mph mph;
  const double* q;
  Vec<D>* y;
  double factor;

  template <class At>
  TREACLE_HD At own(const MphPairs<D>&, const At& at) const {
    return at;
  }
  template <class T, class O>
  TREACLE_HD void add(const MphPairs<D>& pairs, T* sum, const Vec<D, T>& d, const PairDistance<T>& r, const O& own,
                      const OneParticle& other, ListSegment) const {
    const T g = mph.gradientShape(r);
    const std::uint32_t j = other.index;
    for (int k = 0; k < D; ++k)
      sum[k] += g * ofEachPair(own, d, [&](std::uint32_t i, const Vec<D>& toWall) {
                  return pairs.alongWall(i, j, toWall, q[i] * pairs.corrected(i, toWall) + q[j] * toWall)[k];
                });
  }
  TREACLE_HD void store(const MphPairs<D>&, std::uint32_t i, int n, double sum) const {
    y[i][n] -= factor * mph.gradientFactor * sum;
  }
};

/// (C^T u)_k along walls, taken out of it: of fluid, or OfWalls. Bulk: out of lambda C^T u with walls at rest.
template <int D, class Mph, bool OfWalls, bool Bulk>
struct DivergenceAlongWalls {
  static constexpr int values = 1;
  static constexpr bool uses(ListSegment s) {
    return s == (OfWalls ? ListSegment::NearFluid : ListSegment::NearWall);
  }

  Mph mph;
  const Vec<D>* u;
  double* div;

  template <class At>
  TREACLE_HD At own(const MphPairs<D>&, const At& at) const {
    return at;
  }
  template <class T, class O>
  TREACLE_HD void add(const MphPairs<D>& pairs, T* sum, const Vec<D, T>& d, const PairDistance<T>& r, const O& own,
                      const OneParticle& other, ListSegment) const {
    const std::uint32_t j = other.index;
    sum[0] += mph.gradientShape(r) * ofEachPair(own, d, [&](std::uint32_t k, const Vec<D>& toOther) {
                const Vec<D> along = OfWalls ? pairs.alongWall(j, k, -1.0 * toOther, toOther)
                                             : pairs.alongWall(k, j, toOther, pairs.corrected(k, toOther));
                return dot(velocity(pairs, j) - velocity(pairs, k), along);
              });
  }
  TREACLE_HD Vec<D> velocity(const MphPairs<D>& pairs, std::uint32_t k) const {
    return Bulk && k >= pairs.fluidCount ? Vec<D>{} : u[k];
  }
  TREACLE_HD void store(const MphPairs<D>& pairs, std::uint32_t k, int, double sum) const {
    div[k] += (Bulk ? pairs.bulkViscosity(k) : 1.0) * mph.gradientFactor * sum;
  }
};

template <int D, class Backend>
void subtractGradientAlongWalls(Context<Backend>& context, const MphPairs<D>& pairs, std::span<const double> q,
                                double factor, std::span<Vec<D>> y) {
  if (!pairs.slips()) return;
  const auto mph = pairs.terms.with(AccurateScheme{});
  sumOnFluid(context, pairs, GradientAlongWalls<D, std::decay_t<decltype(mph)>>{mph, q.data(), y.data(), factor});
}

template <bool Bulk, int D, class Backend>
void takeDivergenceAlongWalls(Context<Backend>& context, const MphPairs<D>& pairs, std::span<const Vec<D>> u,
                              std::span<double> div) {
  if (!pairs.slips()) return;
  const auto mph = pairs.terms.with(AccurateScheme{});
  using Mph = std::decay_t<decltype(mph)>;
  sumOnList(context, pairs, pairs.fluidList, DivergenceAlongWalls<D, Mph, false, Bulk>{mph, u.data(), div.data()});
  sumOnList(context, pairs, pairs.wallList, DivergenceAlongWalls<D, Mph, true, Bulk>{mph, u.data(), div.data()});
}
template <int D, class Backend>
void subtractDivergenceAlongWalls(Context<Backend>& context, const MphPairs<D>& pairs, std::span<const Vec<D>> u,
                                  std::span<double> div) {
  takeDivergenceAlongWalls<false>(context, pairs, u, div);
}
template <int D, class Backend>
void subtractBulkStressAlongWalls(Context<Backend>& context, const MphPairs<D>& pairs, std::span<const Vec<D>> u,
                                  std::span<double> q) {
  takeDivergenceAlongWalls<true>(context, pairs, u, q);
}

#define TREACLE_SLIP_SUMS(D, Backend)                                                                        \
  template void subtractGradientAlongWalls(Context<Backend>&, const MphPairs<D>&, std::span<const double>,   \
                                           double, std::span<Vec<D>>);                                       \
  template void subtractDivergenceAlongWalls(Context<Backend>&, const MphPairs<D>&, std::span<const Vec<D>>, \
                                             std::span<double>);                                             \
  template void subtractBulkStressAlongWalls(Context<Backend>&, const MphPairs<D>&, std::span<const Vec<D>>, \
                                             std::span<double>);

}  // namespace treacle
