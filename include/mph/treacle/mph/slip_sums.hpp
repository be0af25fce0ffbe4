#pragma once

#include "treacle/mph/mph_sums.hpp"
#include "treacle/mph/pair_sums.hpp"
#include "treacle/mph/renormalisation.hpp"

namespace treacle {

// The sums of mph_sums.hpp along walls at which fluid slips (MphPairs::alongWall), for the sources of both
// backends, which instantiate them.

/// Sum of n n^T per fluid particle over the normals of the faces of its walls, each by how much its wall particle
/// pushes, of which the mean normal is the main axis.
template <int D, class Mph>
struct NormalsOfWalls {
  static constexpr int values = SymmetricBlock<D>::size;
  static constexpr bool uses(ListSegment s) { return s == ListSegment::NearWall; }
  using StoresAll = void;

  Mph mph;
  SlipSide<D>* side;

  template <class At>
  TREACLE_HD At own(const MphPairs<D>&, const At& at) const {
    return at;
  }
  template <class T, class O>
  TREACLE_HD void add(const MphPairs<D>& pairs, T* sum, const Vec<D, T>& d, const PairDistance<T>& r, const O& own,
                      const OneParticle& other, ListSegment) const {
    const T push = mph.gradientShape(r) * r.square * r.inverse;
    int n = 0;
    for (int k = 0; k < D; ++k)
      for (int m = k; m < D; ++m, ++n)
        sum[n] += push * ofEachPair(own, d, [&](std::uint32_t, const Vec<D>& toWall) {
                    const SeenFace<D> face = seenFace(pairs.wallSurface[other.index - pairs.fluidCount], toWall);
                    return face.exists() ? face.way[k] * face.way[m] / (face.below * face.below) : 0.0;
                  });
  }
  TREACLE_HD void store(const MphPairs<D>&, std::uint32_t i, const double* sum) const {
    SymmetricBlock<D> normals;
    for (int n = 0; n < normals.size; ++n) normals.a[n] = sum[n];
    side[i].axis = mainAxis(normals);
  }
};

/// Sum of otherNormal() times itself over the faces of the walls within h_p, and both faces of a wall particle at
/// an edge: the face behind the edge is not between the fluid particle and any other wall particle.
template <int D>
struct OtherNormalsOfWalls {
  static constexpr int values = SymmetricBlock<D>::size;
  static constexpr bool uses(ListSegment s) { return s == ListSegment::NearWall; }
  using StoresAll = void;

  double radius;  // h_p [m]
  SlipSide<D>* side;

  template <class At>
  TREACLE_HD At own(const MphPairs<D>&, const At& at) const {
    return at;
  }
  template <class T, class O>
  TREACLE_HD void add(const MphPairs<D>& pairs, T* sum, const Vec<D, T>& d, const PairDistance<T>&, const O& own,
                      const OneParticle& other, ListSegment) const {
    const WallSurface<D>& surface = pairs.wallSurface[other.index - pairs.fluidCount];
    int n = 0;
    for (int k = 0; k < D; ++k)
      for (int m = k; m < D; ++m, ++n)
        sum[n] += ofEachPair(own, d, [&](std::uint32_t i, const Vec<D>& toWall) {
          if (norm2(toWall) > radius * radius) return 0.0;
          const SymmetricBlock<D> others = othersOf(surface, toWall, side[i].axis, pairs.spacing);
          return others(k, m);
        });
  }
  TREACLE_HD void store(const MphPairs<D>&, std::uint32_t i, const double* sum) const {
    SymmetricBlock<D> others;
    for (int n = 0; n < others.size; ++n) others.a[n] = sum[n];
    side[i] = slipSideOf(side[i].axis, others);
  }

 private:
  TREACLE_HD static SymmetricBlock<D> othersOf(const WallSurface<D>& surface, const Vec<D>& toWall,
                                               const Vec<D>& mean, double spacing) {
    constexpr double atEdge = 1.25;  // farthest of both faces from the wall particle [l]
    SymmetricBlock<D> others{};
    const auto add = [&](const Vec<D>& way, double length) {
      others.addOuter(1, otherNormal((1 / length) * way, mean));
    };
    if (const SeenFace<D> face = seenFace(surface, toWall); face.exists()) add(face.way, face.below);
    const Vec<D> a = converted<double>(surface.face[0]), b = converted<double>(surface.face[1]);
    const double first = norm(a), second = norm(b);
    if (first > 0 && second > 0 && first < atEdge * spacing && second < atEdge * spacing)
      add(a, first), add(b, second);
    return others;
  }
};

/// B from moments of all neighbours: that of the moment sum g d' d'^T, d' being the part of d that acts, with the
/// factor of the whole moment. What is left out along walls is no lack of neighbours.
template <int D, class Mph>
struct SlipRenormalisation {
  static constexpr int values = SymmetricBlock<D>::size;
  static constexpr bool uses(ListSegment s) { return s == ListSegment::NearWall; }
  using StoresAll = void;

  Mph mph;
  SymmetricBlock<D>* b;  // the moments before

  template <class At>
  TREACLE_HD At own(const MphPairs<D>&, const At& at) const {
    return at;
  }
  template <class T, class O>
  TREACLE_HD void add(const MphPairs<D>& pairs, T* sum, const Vec<D, T>& d, const PairDistance<T>& r, const O& own,
                      const OneParticle& other, ListSegment) const {
    const T g = mph.gradientShape(r);
    int n = 0;
    for (int k = 0; k < D; ++k)
      for (int m = k; m < D; ++m, ++n)
        sum[n] += g * ofEachPair(own, d, [&](std::uint32_t i, const Vec<D>& toWall) {
                    const Vec<D> acting = toWall - pairs.alongWall(i, other.index, toWall, toWall);
                    return toWall[k] * toWall[m] - acting[k] * acting[m];
                  });
  }
  TREACLE_HD void store(const MphPairs<D>&, std::uint32_t i, const double* sum) const {
    const SymmetricBlock<D> whole = b[i];
    SymmetricBlock<D> acting = whole;
    for (int n = 0; n < values; ++n) acting.a[n] -= mph.gradientFactor * sum[n];
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

template <int D, class Backend>
void slipSides(Context<Backend>& context, const MphPairs<D>& pairs, std::span<SlipSide<D>> side) {
  const auto mph = pairs.terms.with(AccurateScheme{});
  sumOnFluid(context, pairs, NormalsOfWalls<D, std::decay_t<decltype(mph)>>{mph, side.data()});
  sumOnFluid(context, pairs, OtherNormalsOfWalls<D>{pairs.terms.pressureRadius, side.data()});
}

template <int D, class Backend>
void renormaliseAlongWalls(Context<Backend>& context, const MphPairs<D>& pairs, std::span<SymmetricBlock<D>> b) {
  const auto mph = pairs.terms.with(AccurateScheme{});
  sumOnFluid(context, pairs, SlipRenormalisation<D, std::decay_t<decltype(mph)>>{mph, b.data()});
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
