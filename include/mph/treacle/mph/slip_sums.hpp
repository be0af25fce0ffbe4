#pragma once

#include "treacle/mph/mph_sums.hpp"
#include "treacle/mph/pair_sums.hpp"
#include "treacle/mph/renormalisation.hpp"

namespace treacle {

// The sums of mph_sums.hpp along walls at which fluid slips (MphPairs::alongWall), for the sources of both
// backends, which instantiate them.

/// A sum of symmetric matrices over the walls of each fluid particle, of terms with
///   weight(distance)              [any]
///   of(pairs, i, j, d)            the matrix of fluid particle i and wall particle j, d = x_j - x_i [m]
///   store(pairs, i, sum)
template <int D, class Terms>
struct MatrixOfWalls {
  static constexpr int values = SymmetricBlock<D>::size;
  static constexpr bool uses(ListSegment s) { return s == ListSegment::NearWall; }
  using StoresAll = void;

  Terms terms;

  template <class At>
  TREACLE_HD At own(const MphPairs<D>&, const At& at) const {
    return at;
  }
  template <class T, class O>
  TREACLE_HD void add(const MphPairs<D>& pairs, T* sum, const Vec<D, T>& d, const PairDistance<T>& r, const O& own,
                      const OneParticle& other, ListSegment) const {
    const T weight = terms.weight(r);
    for (int n = 0; n < values; ++n)
      sum[n] += weight * ofEachPair(own, d, [&](std::uint32_t i, const Vec<D>& toWall) {
                  return terms.of(pairs, i, other.index, toWall).a[n];
                });
  }
  TREACLE_HD void store(const MphPairs<D>& pairs, std::uint32_t i, const double* sum) const {
    SymmetricBlock<D> matrix;
    for (int n = 0; n < values; ++n) matrix.a[n] = sum[n];
    terms.store(pairs, i, matrix);
  }
};

/// n n^T of the face's normal, by how much the wall particle pushes: the mean normal is the main axis of the sum.
template <int D, class Mph>
struct NormalsOfWalls {
  Mph mph;
  SlipSide<D>* side;

  template <class T>
  TREACLE_HD T weight(const PairDistance<T>& r) const {
    return mph.gradientShape(r) * r.square * r.inverse;
  }
  TREACLE_HD SymmetricBlock<D> of(const MphPairs<D>& pairs, std::uint32_t, std::uint32_t j,
                                  const Vec<D>& toWall) const {
    SymmetricBlock<D> m{};
    const SeenFace<D> face = seenFace(pairs.wallSurface[j - pairs.fluidCount], toWall);
    if (face.exists()) m.addOuter(1 / (face.below * face.below), face.way);
    return m;
  }
  TREACLE_HD void store(const MphPairs<D>&, std::uint32_t i, const SymmetricBlock<D>& sum) const {
    side[i].axis = mainAxis(sum);
  }
};

/// otherNormal() times itself of the faces of walls within h_p, and of both faces of a wall particle at an edge:
/// the face behind the edge is not between the fluid particle and any other wall particle.
template <int D>
struct OtherNormalsOfWalls {
  static constexpr double atEdge = 1.25;  // farthest of both faces from the wall particle [l]

  SlipSide<D>* side;

  template <class T>
  TREACLE_HD T weight(const PairDistance<T>&) const {
    return T(1.0);
  }
  TREACLE_HD SymmetricBlock<D> of(const MphPairs<D>& pairs, std::uint32_t i, std::uint32_t j,
                                  const Vec<D>& toWall) const {
    SymmetricBlock<D> others{};
    const double h = pairs.terms.pressureRadius, most = atEdge * pairs.spacing;
    if (norm2(toWall) > h * h) return others;
    const WallSurface<D>& surface = pairs.wallSurface[j - pairs.fluidCount];
    const auto add = [&](const Vec<D>& way, double length) {
      others.addOuter(1, otherNormal((1 / length) * way, side[i].axis));
    };
    if (const SeenFace<D> face = seenFace(surface, toWall); face.exists()) add(face.way, face.below);
    const Vec<D> a = converted<double>(surface.face[0]), b = converted<double>(surface.face[1]);
    const double first = norm(a), second = norm(b);
    if (first > 0 && second > 0 && first < most && second < most) add(a, first), add(b, second);
    return others;
  }
  TREACLE_HD void store(const MphPairs<D>&, std::uint32_t i, const SymmetricBlock<D>& sum) const {
    side[i] = slipSideOf(side[i].axis, sum);
  }
};

/// g (d d^T - d' d'^T), d' being the part of d that acts. B is that of the moment of d', with the factor of the
/// whole moment: what is left out along walls is no lack of neighbours.
template <int D, class Mph>
struct SlipRenormalisation {
  Mph mph;
  SymmetricBlock<D>* b;  // the moments before

  template <class T>
  TREACLE_HD T weight(const PairDistance<T>& r) const {
    return mph.gradientShape(r);
  }
  TREACLE_HD SymmetricBlock<D> of(const MphPairs<D>& pairs, std::uint32_t i, std::uint32_t j,
                                  const Vec<D>& toWall) const {
    SymmetricBlock<D> m{};
    m.addOuter(1, toWall);
    m.addOuter(-1, toWall - pairs.alongWall(i, j, toWall, toWall));
    return m;
  }
  TREACLE_HD void store(const MphPairs<D>&, std::uint32_t i, const SymmetricBlock<D>& sum) const {
    const SymmetricBlock<D> whole = b[i], acting = whole + (-mph.gradientFactor) * sum;
    const double factor = trace(renormalisationOf(whole)) / trace(flooredInverse(whole, leastMoment, false));
    b[i] = factor * flooredInverse(acting, fmax(leastMoment, leastSlipMoment * factor), false);
  }
};

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

template <int D, class Backend, class Terms>
void sumOnWalls(Context<Backend>& context, const MphPairs<D>& pairs, const Terms& terms) {
  sumOnFluid(context, pairs, MatrixOfWalls<D, Terms>{terms});
}

template <int D, class Backend>
void slipSides(Context<Backend>& context, const MphPairs<D>& pairs, std::span<SlipSide<D>> side) {
  const auto mph = pairs.terms.with(AccurateScheme{});
  sumOnWalls(context, pairs, NormalsOfWalls<D, std::decay_t<decltype(mph)>>{mph, side.data()});
  sumOnWalls(context, pairs, OtherNormalsOfWalls<D>{side.data()});
}

template <int D, class Backend>
void renormaliseAlongWalls(Context<Backend>& context, const MphPairs<D>& pairs, std::span<SymmetricBlock<D>> b) {
  const auto mph = pairs.terms.with(AccurateScheme{});
  sumOnWalls(context, pairs, SlipRenormalisation<D, std::decay_t<decltype(mph)>>{mph, b.data()});
}

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
  template void slipSides(Context<Backend>&, const MphPairs<D>&, std::span<SlipSide<D>>);                    \
  template void renormaliseAlongWalls(Context<Backend>&, const MphPairs<D>&, std::span<SymmetricBlock<D>>);  \
  template void subtractGradientAlongWalls(Context<Backend>&, const MphPairs<D>&, std::span<const double>,   \
                                           double, std::span<Vec<D>>);                                       \
  template void subtractDivergenceAlongWalls(Context<Backend>&, const MphPairs<D>&, std::span<const Vec<D>>, \
                                             std::span<double>);                                             \
  template void subtractBulkStressAlongWalls(Context<Backend>&, const MphPairs<D>&, std::span<const Vec<D>>, \
                                             std::span<double>);

}  // namespace treacle
