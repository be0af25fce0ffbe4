#pragma once

#include "treacle/mph/pair_sums.hpp"
#include "treacle/mph/tension.hpp"

namespace treacle {

// The sums of tension.hpp, for the sources of both backends, which instantiate them.

/// The sum of w b q and w b of the fluid around each particle, and the mean that follows.
template <int D>
struct CoveredMean {
  static constexpr int values = 2;
  static constexpr bool uses(ListSegment s) { return isFluid(s); }
  using StoresAll = void;

  const Covered* q;
  double* mean;

  template <class At>
  TREACLE_HD At own(const MphPairs<D>&, const At& at) const {
    return at;
  }
  TREACLE_HD Covered other(const MphPairs<D>&, std::uint32_t j) const { return q[j]; }

  template <class T, class O>
  TREACLE_HD void add(const MphPairs<D>& pairs, T* sum, const Vec<D, T>&, const PairDistance<T>& r, const O&,
                      const Covered& other, ListSegment) const {
    addScaled(sum, pairs.terms.density(1.0, r), other);
  }
  TREACLE_HD void store(const MphPairs<D>& pairs, std::uint32_t i, const double* sum) const {
    mean[i] = coveredMeanOf(pairs, {sum[0], sum[1]});
  }
};

/// Of walls, whose lists have neighbours among walls, too: fluid alone.
template <int D, bool OfWalls>
struct TensionForce {
  static constexpr int values = D;
  static constexpr bool uses(ListSegment s) { return !OfWalls || isFluid(s); }
  template <class At>
  struct Own {
    NumberAt<At> tension;
    EachAt<Substance, At> substance;
  };

  const double* tension;
  Vec<D>* force;

  template <class At>
  TREACLE_HD Own<At> own(const MphPairs<D>& pairs, const At& at) const {
    return {at([&](std::uint32_t i) { return tension[i]; }),
            at([&](std::uint32_t i) { return pairs.substance(i); })};
  }
  template <class T, class O>
  TREACLE_HD void add(const MphPairs<D>& pairs, T* sum, const Vec<D, T>& d, const PairDistance<T>& r, const O& own,
                      const Own<OneParticle>& other, ListSegment) const {
    T share = 1;
    if (!pairs.isOneSubstance())
      share = ofEach(own.substance, [&](Substance s) { return tensionShare(pairs, s, other.substance); });
    addScaled(sum, pairs.terms.densityGradient(r) * pairTension(share, own.tension, other.tension), d);
  }
  TREACLE_HD void store(const MphPairs<D>&, std::uint32_t i, int n, double sum) const { force[i][n] = -sum; }
};

/// The sums of spreadVelocityOf().
template <int D>
struct Spreading {
  static constexpr int values = D + 1;
  static constexpr bool uses(ListSegment s) { return isNear(s); }
  using StoresAll = void;
  template <class At>
  struct Own {
    VecAt<D, At> u;
  };

  double dt;
  const Vec<D>* u;
  const double* tension;
  Vec<D>* transport;

  template <class At>
  TREACLE_HD Own<At> own(const MphPairs<D>&, const At& at) const {
    return {at([&](std::uint32_t i) { return u[i]; })};
  }
  template <class T, class O>
  TREACLE_HD void add(const MphPairs<D>& pairs, T* sum, const Vec<D, T>& d, const PairDistance<T>& r, const O& own,
                      const Own<OneParticle>& other, ListSegment) const {
    const T f = pairs.terms.gradient(r);
    addScaled(sum, f, d);
    sum[D] += f * absoluteValue(differenceAlong(other.u, own.u, d));
  }
  TREACLE_HD void store(const MphPairs<D>& pairs, std::uint32_t i, const double* sums) const {
    transport[i] = spreadVelocityOf(pairs, i, dt, tension[i], sums, u[i]);
  }
};

template <int D, class Backend>
void lackOfDensity(Context<Backend>& context, const MphPairs<D>& pairs, const Places& around,
                   std::span<Covered> lack) {
  forEachParticle(context, pairs, lack.size(),
                  [=] TREACLE_HD(const MphPairs<D>& of, std::uint32_t i) { lack[i] = lackOf(of, i, around); });
}

template <int D, class Backend>
void coveredMeans(Context<Backend>& context, const MphPairs<D>& pairs, const ClusterListView& list,
                  std::span<const Covered> q, std::span<double> mean) {
  sumOnList(context, pairs, list, CoveredMean<D>{q.data(), mean.data()});
}

template <int D, class Backend>
void coverTension(Context<Backend>& context, const MphPairs<D>& pairs, const Places& around,
                  std::span<const double> tension, std::span<Covered> covered) {
  forEachParticle(context, pairs, covered.size(), [=] TREACLE_HD(const MphPairs<D>& of, std::uint32_t i) {
    covered[i] = coveredTensionOf(of, i, around, tension[i]);
  });
}

template <int D, class Backend>
void followDensity(Context<Backend>& context, const MphPairs<D>& pairs, double dt, const Places& around,
                   std::span<const double> lack, std::span<double> tension) {
  forEachParticle(context, pairs, tension.size(), [=] TREACLE_HD(const MphPairs<D>& of, std::uint32_t i) {
    tension[i] = tensionOf(of, i, dt, around, lack[i], tension[i]);
  });
}

template <int D, class Backend>
void tensionForces(Context<Backend>& context, const MphPairs<D>& pairs, const ClusterListView& list,
                   std::span<const double> tension, std::span<Vec<D>> force) {
  if (list.first >= pairs.fluidCount)
    sumOnList(context, pairs, list, TensionForce<D, true>{tension.data(), force.data()});
  else
    sumOnList(context, pairs, list, TensionForce<D, false>{tension.data(), force.data()});
}

template <int D, class Backend>
void spreadVelocities(Context<Backend>& context, const MphPairs<D>& pairs, double dt, std::span<const Vec<D>> u,
                      std::span<const double> tension, std::span<Vec<D>> transport) {
  sumOnFluid(context, pairs, Spreading<D>{dt, u.data(), tension.data(), transport.data()});
}

template <int D, class Backend>
void letGapsClose(Context<Backend>& context, const MphPairs<D>& pairs, const Places& places,
                  std::span<SymmetricBlock<D>> b, std::span<Covered> logarithm) {
  const double rest = pairs.restDensity;
  forEach(context, b.size(), [=] TREACLE_HD(std::size_t i) {
    const double resists = places.resists(static_cast<std::uint32_t>(i), rest);
    b[i] = sqrt(resists) * b[i];
    logarithm[i] = logarithmOf(resists);
  });
}

template <class Backend>
void letWallsYield(Context<Backend>& context, std::span<double> mean) {
  forEach(context, mean.size(), [=] TREACLE_HD(std::size_t i) { mean[i] = wallShareOf(mean[i]); });
}

template <class Backend>
void shareTension(Context<Backend>& context, std::span<const double> share, std::span<double> tension) {
  forEach(context, tension.size(), [=] TREACLE_HD(std::size_t i) { tension[i] *= share[i]; });
}

template <int D, class Backend>
void actingPressures(Context<Backend>& context, const MphPairs<D>& pairs, const Places& around,
                     std::span<const double> tension, std::span<double> pressure) {
  forEachParticle(context, pairs, pressure.size(), [=] TREACLE_HD(const MphPairs<D>& of, std::uint32_t i) {
    pressure[i] = actingPressureOf(of, i, around, tension[i], pressure[i]);
  });
}

#define TREACLE_TENSION_SUMS(D, Backend)                                                                         \
  template void lackOfDensity(Context<Backend>&, const MphPairs<D>&, const Places&, std::span<Covered>);         \
  template void coveredMeans(Context<Backend>&, const MphPairs<D>&, const ClusterListView&,                      \
                             std::span<const Covered>, std::span<double>);                                       \
  template void letGapsClose(Context<Backend>&, const MphPairs<D>&, const Places&, std::span<SymmetricBlock<D>>, \
                             std::span<Covered>);                                                                \
  template void actingPressures(Context<Backend>&, const MphPairs<D>&, const Places&, std::span<const double>,   \
                                std::span<double>);                                                              \
  template void coverTension(Context<Backend>&, const MphPairs<D>&, const Places&, std::span<const double>,      \
                             std::span<Covered>);                                                                \
  template void followDensity(Context<Backend>&, const MphPairs<D>&, double, const Places&,                      \
                              std::span<const double>, std::span<double>);                                       \
  template void tensionForces(Context<Backend>&, const MphPairs<D>&, const ClusterListView&,                     \
                              std::span<const double>, std::span<Vec<D>>);                                       \
  template void spreadVelocities(Context<Backend>&, const MphPairs<D>&, double, std::span<const Vec<D>>,         \
                                 std::span<const double>, std::span<Vec<D>>);

}  // namespace treacle
