#include "treacle/mph/tension.hpp"

#include "mph/fill.cuh"
#include "mph/step_sums.cuh"

namespace treacle {
namespace {

template <int D>
struct CoveredMean {
  static constexpr int values = 2;
  static constexpr bool uses(ListSegment s) { return isFluid(s); }
  using StoresVectors = void;
  struct Own {};
  using Other = Covered;

  MphTerms<D> mph;
  const Covered* q;
  double* mean;

  __device__ Own loadOwn(const MphPairs<D>&, std::uint32_t) const { return {}; }
  __device__ Other loadOther(const MphPairs<D>&, std::uint32_t j) const { return q[j]; }

  __device__ void add(const MphPairs<D>&, double* sum, const Vec<D>&, const PairDistance<double>& r, Own,
                      const Other& other, ListSegment) const {
    addScaled(sum, mph.density(1.0, r), other);
  }
  __device__ void store(const MphPairs<D>& pairs, std::uint32_t i, const Vec<2>& sum) const {
    mean[i] = coveredMeanOf(pairs, sum);
  }
};

/// Of walls, whose lists have neighbours among walls, too: fluid alone.
template <int D, bool OfWalls>
struct TensionForce {
  static constexpr int values = D;
  static constexpr bool uses(ListSegment s) { return !OfWalls || isFluid(s); }
  struct Own {
    double tension;
    Substance substance;
  };
  using Other = Own;

  MphTerms<D> mph;
  const double* tension;
  Vec<D>* force;

  __device__ Own loadOwn(const MphPairs<D>& pairs, std::uint32_t i) const {
    return {tension[i], pairs.substance(i)};
  }
  __device__ Other loadOther(const MphPairs<D>& pairs, std::uint32_t j) const { return loadOwn(pairs, j); }

  __device__ void add(const MphPairs<D>& pairs, double* sum, const Vec<D>& d, const PairDistance<double>& r,
                      const Own& own, const Other& other, ListSegment) const {
    const double share = tensionShare(pairs, own.substance, other.substance);
    addScaled(sum, mph.densityGradient(r) * pairTension(share, own.tension, other.tension), d);
  }
  __device__ void store(const MphPairs<D>&, std::uint32_t i, int n, double sum) const { force[i][n] = -sum; }
};

template <int D>
struct Spreading {
  static constexpr int values = D + 1;
  static constexpr bool uses(ListSegment s) { return isNear(s); }
  using StoresAll = void;
  using Own = Vec<D>;
  using Other = Vec<D>;

  MphTerms<D> mph;
  double dt;
  const Vec<D>* u;
  const double* tension;
  Vec<D>* transport;

  __device__ Own loadOwn(const MphPairs<D>&, std::uint32_t i) const { return u[i]; }
  __device__ Other loadOther(const MphPairs<D>&, std::uint32_t j) const { return u[j]; }

  __device__ void add(const MphPairs<D>&, double* sum, const Vec<D>& d, const PairDistance<double>& r,
                      const Own& own, const Other& other, ListSegment) const {
    const double f = mph.gradient(r);
    for (int k = 0; k < D; ++k) sum[k] = fma(f, d[k], sum[k]);
    sum[D] = fma(f, fabs(differenceAlong(other, own, d)), sum[D]);
  }
  __device__ void store(const MphPairs<D>& pairs, std::uint32_t i, const double* sums) const {
    transport[i] = spreadVelocityOf(pairs, i, dt, tension[i], sums, u[i]);
  }
};

}  // namespace

template <int D>
void lackOfDensity(Context<Cuda>& context, const MphPairs<D>& pairs, const Places& around,
                   std::span<Covered> lack) {
  fill(context, pairs, lack,
       [around] __device__(const MphPairs<D>& pairs, std::uint32_t i) { return lackOf(pairs, i, around); });
}

template <int D>
void coveredMeans(Context<Cuda>& context, const MphPairs<D>& pairs, const ClusterListView& list,
                  std::span<const Covered> q, std::span<double> mean) {
  sumOnList(context, pairs, list, CoveredMean<D>{pairs.terms, q.data(), mean.data()});
}

template <int D>
void coverTension(Context<Cuda>& context, const MphPairs<D>& pairs, const Places& around,
                  std::span<const double> tension, std::span<Covered> covered) {
  fill(context, pairs, covered, [around, tension] __device__(const MphPairs<D>& pairs, std::uint32_t i) {
    return coveredTensionOf(pairs, i, around, tension[i]);
  });
}

template <int D>
void followDensity(Context<Cuda>& context, const MphPairs<D>& pairs, double dt, const Places& around,
                   std::span<const double> lack, std::span<double> tension) {
  fill(context, pairs, tension, [dt, around, lack, tension] __device__(const MphPairs<D>& pairs, std::uint32_t i) {
    return tensionOf(pairs, i, dt, around, lack[i], tension[i]);
  });
}

template <int D>
void tensionForces(Context<Cuda>& context, const MphPairs<D>& pairs, const ClusterListView& list,
                   std::span<const double> tension, std::span<Vec<D>> force) {
  if (list.first >= pairs.fluidCount)
    sumOnList(context, pairs, list, TensionForce<D, true>{pairs.terms, tension.data(), force.data()});
  else
    sumOnList(context, pairs, list, TensionForce<D, false>{pairs.terms, tension.data(), force.data()});
}

template <int D>
void spreadVelocities(Context<Cuda>& context, const MphPairs<D>& pairs, double dt, std::span<const Vec<D>> u,
                      std::span<const double> tension, std::span<Vec<D>> transport) {
  sumOnFluid(context, pairs, Spreading<D>{pairs.terms, dt, u.data(), tension.data(), transport.data()});
}

template <int D>
void letGapsClose(Context<Cuda>& context, const MphPairs<D>& pairs, const Places& places,
                  std::span<SymmetricBlock<D>> b, std::span<Covered> logarithm) {
  forEach(context, b.size(), [places, rest = pairs.restDensity, b, logarithm] __device__(std::size_t i) {
    const double resists = places.resists(static_cast<std::uint32_t>(i), rest);
    b[i] = std::sqrt(resists) * b[i];
    logarithm[i] = logarithmOf(resists);
  });
}

void letWallsYield(Context<Cuda>& context, std::span<double> mean) {
  forEach(context, mean.size(), [mean] __device__(std::size_t i) { mean[i] = wallShareOf(mean[i]); });
}

void shareTension(Context<Cuda>& context, std::span<const double> share, std::span<double> tension) {
  forEach(context, tension.size(), [share, tension] __device__(std::size_t i) { tension[i] *= share[i]; });
}

template <int D>
void actingPressures(Context<Cuda>& context, const MphPairs<D>& pairs, const Places& around,
                     std::span<const double> tension, std::span<double> pressure) {
  fill(context, pairs, pressure,
       [around, tension, pressure] __device__(const MphPairs<D>& pairs, std::uint32_t i) {
         return actingPressureOf(pairs, i, around, tension[i], pressure[i]);
       });
}

#define TREACLE_INSTANTIATE(D)                                                                                   \
  template void lackOfDensity<D>(Context<Cuda>&, const MphPairs<D>&, const Places&, std::span<Covered>);         \
  template void coveredMeans<D>(Context<Cuda>&, const MphPairs<D>&, const ClusterListView&,                      \
                                std::span<const Covered>, std::span<double>);                                    \
  template void letGapsClose<D>(Context<Cuda>&, const MphPairs<D>&, const Places&, std::span<SymmetricBlock<D>>, \
                                std::span<Covered>);                                                             \
  template void actingPressures<D>(Context<Cuda>&, const MphPairs<D>&, const Places&, std::span<const double>,   \
                                   std::span<double>);                                                           \
  template void coverTension<D>(Context<Cuda>&, const MphPairs<D>&, const Places&, std::span<const double>,      \
                                std::span<Covered>);                                                             \
  template void followDensity<D>(Context<Cuda>&, const MphPairs<D>&, double, const Places&,                      \
                                 std::span<const double>, std::span<double>);                                    \
  template void tensionForces<D>(Context<Cuda>&, const MphPairs<D>&, const ClusterListView&,                     \
                                 std::span<const double>, std::span<Vec<D>>);                                    \
  template void spreadVelocities<D>(Context<Cuda>&, const MphPairs<D>&, double, std::span<const Vec<D>>,         \
                                    std::span<const double>, std::span<Vec<D>>);
TREACLE_INSTANTIATE(2)
TREACLE_INSTANTIATE(3)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
