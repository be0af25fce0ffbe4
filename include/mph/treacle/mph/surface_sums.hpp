#pragma once

#include "treacle/mph/pair_sums.hpp"
#include "treacle/mph/surface_tension.hpp"

namespace treacle {

// The sums of surface_tension.hpp, for the sources of both backends, which instantiate them.

/// What fluid and walls are around each fluid particle.
template <int D>
struct SumSurface {
  static constexpr int values = 2 * D + 5;
  static constexpr bool uses(ListSegment) { return true; }
  template <class At>
  struct Own {
    EachAt<int, At> material;
  };

  SurfaceTerms<D> terms;
  SurfaceSums<D>* sums;

  template <class At>
  TREACLE_HD Own<At> own(const MphPairs<D>& pairs, const At& at) const {
    return {at([&](std::uint32_t i) { return int{pairs.material[i]}; })};
  }
  template <class T, class At>
  TREACLE_HD void add(const MphPairs<D>&, T* sum, const Vec<D, T>& d, const PairDistance<T>& r, const Own<At>& own,
                      const Own<OneParticle>& other, ListSegment segment) const {
    const T g = terms.gradient(r.square), share = terms.share(g, r.square), w = terms.weight(r.square);
    if (isFluid(segment)) {
      addScaled(sum, g, d);
      sum[2 * D] += share;
      sum[2 * D + 2] += w;
      return;
    }
    addScaled(sum + D, g, d);
    sum[2 * D + 1] += share;
    sum[2 * D + 3] += w;
    sum[2 * D + 4] += share * ofEach(own.material, [&](int m) { return terms.dryPull(m, other.material); });
  }
  TREACLE_HD void store(const MphPairs<D>&, std::uint32_t i, int n, double sum) const {
    SurfaceSums<D>& s = sums[i];
    double& value = n < D            ? s.fluid[n]
                    : n < 2 * D      ? s.wall[n - D]
                    : n == 2 * D     ? s.filled
                    : n == 2 * D + 1 ? s.walls
                    : n == 2 * D + 2 ? s.colour
                    : n == 2 * D + 3 ? s.wallColour
                                     : s.repelled;
    value = sum;
  }
};

/// What walls and fluid are around each wall particle of the list.
template <int D>
struct SumAtWalls {
  static constexpr int values = D + 4;
  static constexpr bool uses(ListSegment) { return true; }
  template <class At>
  using Own = typename SumSurface<D>::template Own<At>;

  SurfaceTerms<D> terms;
  WallSums<D>* sums;

  template <class At>
  TREACLE_HD Own<At> own(const MphPairs<D>& pairs, const At& at) const {
    return {at([&](std::uint32_t i) { return int{pairs.material[i]}; })};
  }
  template <class T, class O>
  TREACLE_HD void add(const MphPairs<D>&, T* sum, const Vec<D, T>& d, const PairDistance<T>& r, const O& own,
                      const Own<OneParticle>& other, ListSegment segment) const {
    const T v = terms.wetting(r.square);
    sum[D + 2] += terms.weight(r.square);
    if (isFluid(segment)) {
      sum[D + 1] += v;
      sum[D + 3] += v * ofEach(own.material, [&](int m) { return terms.dryPull(other.material, m); });
      return;
    }
    addScaled(sum, terms.wettingGradient(r.square), d);
    sum[D] += v;
  }
  TREACLE_HD void store(const MphPairs<D>& pairs, std::uint32_t j, int n, double sum) const {
    WallSums<D>& s = sums[j - pairs.fluidCount];
    (n < D ? s.wall[n] : n == D ? s.walls : n == D + 1 ? s.filled : n == D + 2 ? s.colour : s.repels) = sum;
  }
};

/// Per fluid particle: the force of the stress, what keeps it apart and walls pull along themselves, and S.
template <int D>
struct SurfaceForce {
  static constexpr int values = 3 * D;
  static constexpr bool uses(ListSegment) { return true; }
  template <class At>
  struct Own {
    VecAt<D, At> m;  // of a wall what it pulls with, Adhesion::along
    NumberAt<At> tie;
    VecAt<D, At> line;  // in 3D
    EachAt<int, At> material;
  };

  SurfaceTerms<D> terms;
  const SurfaceSlope<D>* slope;
  const Adhesion<D>* adhesion;
  Vec<D>*force, *unshared, *smoothed;

  template <class At>
  TREACLE_HD Own<At> own(const MphPairs<D>& pairs, const At& at) const {
    Own<At> of{at([&](std::uint32_t i) { return slope[i].m; }),
               at([&](std::uint32_t i) { return slope[i].tie; }),
               {},
               at([&](std::uint32_t i) { return int{pairs.material[i]}; })};
    if constexpr (D == 3) of.line = at([&](std::uint32_t i) { return slope[i].line; });
    return of;
  }
  TREACLE_HD Own<OneParticle> other(const MphPairs<D>& pairs, std::uint32_t j) const {
    if (j < pairs.fluidCount) return own(pairs, OneParticle{j});
    return {adhesion[j].along, 0, {}, pairs.material[j]};
  }

  template <class T, class O>
  TREACLE_HD void add(const MphPairs<D>&, T* sum, const Vec<D, T>& d, const PairDistance<T>& r, const O& own,
                      const Own<OneParticle>& other, ListSegment segment) const {
    const double other2 = norm2(other.m);
    if (!isFluid(segment)) {
      if (other2 > 0)
        addScaled(sum + D, ofEach(own.material, [&](int m) { return terms.wetPull(m, other.material); }),
                  terms.alongWall(d, r.square, other.m));
      return;
    }
    const T g = terms.gradient(r.square), both = norm2(own.m) + other2;
    addScaled(sum, g * both, d);
    addScaled(sum, -g * own.tie * along(own.m, d), own.m);
    addScaled(sum, -g * other.tie * along(other.m, d), other.m);
    if constexpr (D == 3) {
      addScaled(sum, g * along(own.line, d), own.line);
      addScaled(sum, g * along(other.line, d), other.line);
    }
    addScaled(sum + D, -terms.core(r.inverse) * both, d);
    addScaled(sum + 2 * D, terms.weight(r.square) * sqrt(other2), other.m);
  }
  TREACLE_HD void store(const MphPairs<D>&, std::uint32_t i, int n, double sum) const {
    (n < D ? force[i][n] : n < 2 * D ? unshared[i][n - D] : smoothed[i][n - 2 * D]) = sum;
  }
};

/// force += what makes up for the depth of the tension, per fluid particle, and the sums of the fits around it.
template <int D>
struct SurfaceBend {
  static constexpr int values = D + 2;
  static constexpr bool uses(ListSegment s) { return isFluid(s); }
  template <class At>
  struct Own {
    VecAt<D, At> m;
    SurfaceFit fit{};  // of the other alone
  };

  SurfaceTerms<D> terms;
  SurfaceForces<D> of;
  SurfaceFit* fitted;

  template <class At>
  TREACLE_HD Own<At> own(const MphPairs<D>&, const At& at) const {
    return {at([&](std::uint32_t i) { return of.normal[i]; })};
  }
  TREACLE_HD Own<OneParticle> other(const MphPairs<D>&, std::uint32_t j) const {
    return {of.normal[j], of.fit[j]};
  }

  template <class T, class O>
  TREACLE_HD void add(const MphPairs<D>&, T* sum, const Vec<D, T>& d, const PairDistance<T>& r, const O& own,
                      const Own<OneParticle>& other, ListSegment) const {
    const T closing = along(other.m, d) * squareRoot(norm2(own.m)) - along(own.m, d) * norm(other.m);
    addScaled(sum, terms.bending(r.square, r.inverse) * closing, d);
    const T near = terms.nearness(r.square);
    sum[D] += near * other.fit.along;
    sum[D + 1] += near * other.fit.square;
  }
  TREACLE_HD void store(const MphPairs<D>&, std::uint32_t i, int n, double sum) const {
    if (n < D)
      of.force[i][n] += sum;
    else
      (n == D ? fitted[i].along : fitted[i].square) = sum;
  }
};

/// The sum of evenAlongSurface().
template <int D>
struct EvenForce {
  static constexpr int values = D;
  static constexpr bool uses(ListSegment s) { return isFluid(s); }
  template <class At>
  struct Own {
    VecAt<D, At> m, f;
    NumberAt<At> shares;  // 1 or 0
  };

  SurfaceTerms<D> terms;
  SharedForces<D> of;

  template <class At>
  TREACLE_HD Own<At> own(const MphPairs<D>&, const At& at) const {
    return {at([&](std::uint32_t i) { return of.normal[i]; }), at([&](std::uint32_t i) { return of.f[i]; }),
            at([&](std::uint32_t i) { return of.fit[i].square > 0 ? 1.0 : 0.0; })};
  }

  template <class T, class O>
  TREACLE_HD void add(const MphPairs<D>&, T* sum, const Vec<D, T>& d, const PairDistance<T>& r, const O& own,
                      const Own<OneParticle>& other, ListSegment) const {
    if (other.shares == 0) return;
    Vec<D, T> n;
    for (int k = 0; k < D; ++k) n[k] = own.m[k] + other.m[k];
    const T unit2 = r.inverse * r.inverse, across = along(n, d);
    const T part = 1.0 - across * across * unit2 / (norm2(n) + terms.evenNoise);
    const T k = own.shares * (terms.evenFactor * terms.nearness(r.square) * part);
    addScaled(sum, k * unit2 * differenceAlong(other.f, own.f, d), d);
  }
  TREACLE_HD void store(const MphPairs<D>&, std::uint32_t i, int n, double sum) const {
    of.y[i][n] = of.f[i][n] + sum + (of.unshared.empty() ? 0.0 : of.unshared[i][n]);
  }
};

/// The sum of surfaceOnWalls().
template <int D>
struct SurfaceReaction {
  static constexpr int values = D;
  static constexpr bool uses(ListSegment s) { return isFluid(s); }
  template <class At>
  struct Own {
    VecAt<D, At> along;  // Adhesion
    EachAt<int, At> material;
    Vec<D> ofWalls{};  // of the other alone
  };

  SurfaceTerms<D> terms;
  WallReactions<D> of;

  template <class At>
  TREACLE_HD Own<At> own(const MphPairs<D>& pairs, const At& at) const {
    return {at([&](std::uint32_t j) { return of.adhesion[j].along; }),
            at([&](std::uint32_t j) { return int{pairs.material[j]}; })};
  }
  TREACLE_HD Own<OneParticle> other(const MphPairs<D>& pairs, std::uint32_t i) const {
    return {{}, pairs.material[i], of.ofWalls[i]};
  }

  template <class T, class O>
  TREACLE_HD void add(const MphPairs<D>&, T* sum, const Vec<D, T>& d, const PairDistance<T>& r, const O& own,
                      const Own<OneParticle>& other, ListSegment) const {
    addScaled(sum, -terms.share(terms.gradient(r.square), r.square), other.ofWalls);
    addScaled(sum, ofEach(own.material, [&](int wall) { return terms.wetPull(other.material, wall); }),
              terms.alongWall(d, r.square, own.along));
  }
  TREACLE_HD void store(const MphPairs<D>& pairs, std::uint32_t j, int n, double sum) const {
    of.y[j - pairs.fluidCount][n] = sum;
    of.load[j - pairs.fluidCount][n] += sum;
  }
};

template <int D, class Backend>
void surfaceSlope(Context<Backend>& context, const MphPairs<D>& pairs, const SurfaceTerms<D>& terms,
                  std::span<SurfaceSums<D>> sums, std::span<SurfaceSlope<D>> slope,
                  std::span<Adhesion<D>> adhesion) {
  sumOnFluid(context, pairs, SumSurface<D>{terms, sums.data()});
  const std::span<const std::uint8_t> material = pairs.material;
  forEach(context, pairs.ownFluid(), [=] TREACLE_HD(std::size_t i) {
    slope[i] = terms.slope(material[i], sums[i]);
    adhesion[i] = terms.adhesion(sums[i]);
  });
}

template <int D, class Backend>
void wallAdhesion(Context<Backend>& context, const MphPairs<D>& pairs, const SurfaceTerms<D>& terms,
                  const ClusterListView& walls, std::span<WallSums<D>> sums, std::span<Adhesion<D>> adhesion) {
  // Without lists, sums over walls count where fluid is within the radius of densities; these look as far as lists
  // do.
  MphPairs<D> far = pairs;
  far.terms.densityRadius = std::max(pairs.terms.densityRadius, pairs.terms.viscosityRadius);
  sumOnList(context, far, walls, SumAtWalls<D>{terms, sums.data()});
  forEach(context, pairs.ownEnd() - pairs.fluidCount,
          [=] TREACLE_HD(std::size_t j) { adhesion[j] = terms.adhesion(sums[j]); });
}

template <int D, class Backend>
void surfaceForces(Context<Backend>& context, const MphPairs<D>& pairs, const SurfaceTerms<D>& terms,
                   std::span<const SurfaceSums<D>> sums, std::span<const SurfaceSlope<D>> slope,
                   std::span<const Adhesion<D>> adhesion, const SurfaceForces<D>& of) {
  sumOnFluid(context, pairs,
             SurfaceForce<D>{terms, slope.data(), adhesion.data(), of.force.data(), of.unshared.data(),
                             of.smoothed.data()});
  const std::span<const std::uint8_t> material = pairs.material;
  forEach(context, pairs.ownFluid(), [=] TREACLE_HD(std::size_t i) {
    terms.finish(material[i], static_cast<std::uint32_t>(i), sums[i], slope[i].m, of.force[i], of);
  });
}

template <int D, class Backend>
void bendSurface(Context<Backend>& context, const MphPairs<D>& pairs, const SurfaceTerms<D>& terms,
                 const SurfaceForces<D>& of, std::span<SurfaceFit> fitted) {
  sumOnFluid(context, pairs, SurfaceBend<D>{terms, of, fitted.data()});
  forEach(context, pairs.ownFluid(),
          [=] TREACLE_HD(std::size_t i) { terms.split(static_cast<std::uint32_t>(i), fitted[i], of); });
}

template <int D, class Backend>
void evenAlongSurface(Context<Backend>& context, const MphPairs<D>& pairs, const SurfaceTerms<D>& terms,
                      const SharedForces<D>& of) {
  sumOnFluid(context, pairs, EvenForce<D>{terms, of});
}

template <int D, class Backend>
void addSurfaceForces(Context<Backend>& context, std::span<const Vec<D>> f, std::span<Vec<D>> y) {
  forEach(context, f.size(), [=] TREACLE_HD(std::size_t i) { y[i] += f[i]; });
}

template <int D, class Backend>
void surfaceOnWalls(Context<Backend>& context, const MphPairs<D>& pairs, const SurfaceTerms<D>& terms,
                    const ClusterListView& walls, const WallReactions<D>& of) {
  sumOnList(context, pairs, walls, SurfaceReaction<D>{terms, of});
}

#define TREACLE_SURFACE_SUMS(D, Backend)                                                                     \
  template void surfaceSlope(Context<Backend>&, const MphPairs<D>&, const SurfaceTerms<D>&,                  \
                             std::span<SurfaceSums<D>>, std::span<SurfaceSlope<D>>, std::span<Adhesion<D>>); \
  template void wallAdhesion(Context<Backend>&, const MphPairs<D>&, const SurfaceTerms<D>&,                  \
                             const ClusterListView&, std::span<WallSums<D>>, std::span<Adhesion<D>>);        \
  template void surfaceForces(Context<Backend>&, const MphPairs<D>&, const SurfaceTerms<D>&,                 \
                              std::span<const SurfaceSums<D>>, std::span<const SurfaceSlope<D>>,             \
                              std::span<const Adhesion<D>>, const SurfaceForces<D>&);                        \
  template void bendSurface(Context<Backend>&, const MphPairs<D>&, const SurfaceTerms<D>&,                   \
                            const SurfaceForces<D>&, std::span<SurfaceFit>);                                 \
  template void evenAlongSurface(Context<Backend>&, const MphPairs<D>&, const SurfaceTerms<D>&,              \
                                 const SharedForces<D>&);                                                    \
  template void addSurfaceForces(Context<Backend>&, std::span<const Vec<D>>, std::span<Vec<D>>);             \
  template void surfaceOnWalls(Context<Backend>&, const MphPairs<D>&, const SurfaceTerms<D>&,                \
                               const ClusterListView&, const WallReactions<D>&);

}  // namespace treacle
