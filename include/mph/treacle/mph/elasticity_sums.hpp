#pragma once

#include "treacle/core/couple.hpp"
#include "treacle/core/floored_inverse.hpp"
#include "treacle/core/product.hpp"
#include "treacle/mph/elasticity.hpp"
#include "treacle/mph/gradient_moment.hpp"
#include "treacle/mph/pair_sums.hpp"

namespace treacle {

// The sums of elasticity.hpp, for the sources of both backends, which instantiate them.

/// g of the pairs of elastic fluid.
template <int D>
using ElasticPairTerms = MphTerms<D, double, AccurateScheme>;

template <int D>
ElasticPairTerms<D> elasticTerms(const MphPairs<D>& pairs) {
  const double radius = pairs.terms.viscosityRadius;
  return MphTerms<D>::make(SchemeKind::Accurate, radius, radius, pairs.spacing).with(AccurateScheme{});
}

/// sum of g (u_j - u_i) d^T.
template <int D>
struct VelocityMoment {
  static constexpr int values = D * D;
  static constexpr bool uses(ListSegment) { return true; }
  template <class At>
  struct Own {
    At at;
    VecAt<D, At> u;
  };

  ElasticPairTerms<D> mph;
  const Vec<D>* u;
  Block<D>* moment;

  template <class At>
  TREACLE_HD Own<At> own(const MphPairs<D>&, const At& at) const {
    return {at, at([&](std::uint32_t i) { return u[i]; })};
  }
  template <class T, class O>
  TREACLE_HD void add(const MphPairs<D>& pairs, T* sum, const Vec<D, T>& d, const PairDistance<T>& r, const O& own,
                      const Own<OneParticle>& other, ListSegment segment) const {
    T g = mph.gradient(r);
    if (isWall(segment)) g *= wallFactorOf<true>(pairs, own.at, other.at.index, d);
    for (int i = 0; i < D; ++i) addScaled(sum + i * D, g * (other.u[i] - own.u[i]), d);
    if (isWall(segment) && pairs.wallMotion && pairs.wallSurface)
      addTurning(pairs, sum, g, d, own, other.at.index);
  }
  TREACLE_HD void store(const MphPairs<D>&, std::uint32_t i, int n, double sum) const { moment[i].a[n] = sum; }

 private:
  /// What SortedParticles::velocityAtSurface() says of a wall that turns.
  template <class T, class O>
  TREACLE_HD static void addTurning(const MphPairs<D>& pairs, T* sum, T g, const Vec<D, T>& d, const O& own,
                                    std::uint32_t wall) {
    const T behind = ofEachPair(own.at, d, [&](std::uint32_t, const Vec<D>& toWall) {
      return seenFace(pairs.surfaceOf(wall), toWall).behind();
    });
    const Vec<D, T> swirl = WallMotion<D>::product(pairs.wallMotion[pairs.body[wall]].spin, d);
    for (int i = 0; i < D; ++i) addScaled(sum + i * D, -1.0 * g * behind * swirl[i], d);
  }
};

/// sum of g (tau_i B_i + tau_j B_j) d.
template <int D>
struct StressForce {
  static constexpr int values = 2 * D;  // of g d, which meets what the particle itself carries; of the others
  static constexpr bool uses(ListSegment) { return true; }
  using StoresAll = void;

  ElasticPairTerms<D> mph;
  const Block<D>* carried;
  Vec<D>* force;

  template <class At>
  TREACLE_HD At own(const MphPairs<D>&, const At& at) const {
    return at;
  }
  template <class T, class O>
  TREACLE_HD void add(const MphPairs<D>&, T* sum, const Vec<D, T>& d, const PairDistance<T>& r, const O&,
                      const OneParticle& other, ListSegment segment) const {
    const T g = mph.gradient(r);
    if (isWall(segment)) return addScaled(sum, 2.0 * g, d);
    addScaled(sum, g, d);
    const Block<D>& m = carried[other.index];
    for (int i = 0; i < D; ++i)
      for (int k = 0; k < D; ++k) sum[D + i] += g * m(i, k) * d[k];
  }
  TREACLE_HD void store(const MphPairs<D>&, std::uint32_t i, const double* sum) const {
    Vec<D> own{}, others{};
    for (int k = 0; k < D; ++k) own[k] = sum[k], others[k] = sum[D + k];
    force[i] = carried[i] * own + others;
  }
};

/// Of a wall particle: sum of 2 g tau_i B_i d over fluid, and its couple about the particle.
template <int D>
struct StressOnWalls {
  static constexpr int values = D + planesOf<D>;
  static constexpr bool uses(ListSegment s) { return isFluid(s); }

  ElasticPairTerms<D> mph;
  const Block<D>* carried;
  Vec<D>* force;   // of the first wall particle
  Vec<3>* couple;  // likewise

  template <class At>
  TREACLE_HD At own(const MphPairs<D>&, const At& at) const {
    return at;
  }
  template <class T, class O>
  TREACLE_HD void add(const MphPairs<D>& pairs, T* sum, const Vec<D, T>& d, const PairDistance<T>& r, const O& own,
                      const OneParticle& other, ListSegment) const {
    const T g = 2.0 * mph.gradient(r);
    const Block<D>& m = carried[other.index];
    Vec<D, T> f{};
    for (int i = 0; i < D; ++i)
      for (int k = 0; k < D; ++k) f[i] += g * m(i, k) * d[k];
    for (int i = 0; i < D; ++i) sum[i] += f[i];
    if (!pairs.wallSurface) return;
    const T behind = ofEachPair(own, d, [&](std::uint32_t j, const Vec<D>& toFluid) {
      return seenFace(pairs.surfaceOf(j), -1.0 * toFluid).behind();
    });
    addCouple(behind, d, f, sum + D);
  }
  TREACLE_HD void store(const MphPairs<D>& pairs, std::uint32_t j, int n, double sum) const {
    const std::uint32_t wall = j - pairs.fluidCount;
    if (n < D)
      force[wall][n] = sum;
    else
      couple[wall][D == 2 ? 2 : n - D] = sum;
  }
};

template <int D, class Backend>
void gradientCorrection(Context<Backend>& context, const MphPairs<D>& pairs, std::span<SymmetricBlock<D>> b,
                        bool atMostOne) {
  sumOnFluid(context, pairs, GradientMoment<D, ElasticPairTerms<D>, true>{elasticTerms(pairs), b.data()});
  forEach(context, b.size(),
          [=] TREACLE_HD(std::size_t i) { b[i] = flooredInverse(b[i], leastElasticMoment, atMostOne); });
}

template <int D, class Backend>
void velocityGradient(Context<Backend>& context, const MphPairs<D>& pairs, std::span<const SymmetricBlock<D>> b,
                      std::span<const Vec<D>> u, std::span<Block<D>> gradient) {
  sumOnFluid(context, pairs, VelocityMoment<D>{elasticTerms(pairs), u.data(), gradient.data()});
  forEach(context, gradient.size(),
          [=] TREACLE_HD(std::size_t i) { gradient[i] = product<D>(gradient[i], b[i]); });
}

template <int D, class Backend>
void stressForces(Context<Backend>& context, const MphPairs<D>& pairs, std::span<const Block<D>> carried,
                  std::span<Vec<D>> force) {
  sumOnFluid(context, pairs, StressForce<D>{elasticTerms(pairs), carried.data(), force.data()});
}

template <int D, class Backend>
void stressOnWalls(Context<Backend>& context, const MphPairs<D>& pairs, const ClusterListView& walls,
                   std::span<const Block<D>> carried, std::span<Vec<D>> force, std::span<Vec<3>> couple) {
  sumOnList(context, pairs, walls,
            StressOnWalls<D>{elasticTerms(pairs), carried.data(), force.data(), couple.data()});
}

#define TREACLE_ELASTICITY_SUMS(D, Backend)                                                                    \
  template void gradientCorrection(Context<Backend>&, const MphPairs<D>&, std::span<SymmetricBlock<D>>, bool); \
  template void velocityGradient(Context<Backend>&, const MphPairs<D>&, std::span<const SymmetricBlock<D>>,    \
                                 std::span<const Vec<D>>, std::span<Block<D>>);                                \
  template void stressForces(Context<Backend>&, const MphPairs<D>&, std::span<const Block<D>>,                 \
                             std::span<Vec<D>>);                                                               \
  template void stressOnWalls(Context<Backend>&, const MphPairs<D>&, const ClusterListView&,                   \
                              std::span<const Block<D>>, std::span<Vec<D>>, std::span<Vec<3>>);

}  // namespace treacle
