#include "treacle/mph/surface_tension.hpp"

#include "mph/step_sums.cuh"

namespace treacle {
namespace {

/// What fluid and walls are around each fluid particle.
template <int D>
struct SumSurface {
  static constexpr int values = 2 * D + 3;
  static constexpr bool uses(ListSegment) { return true; }
  struct Own {};
  struct Other {
    double pull;
  };

  SurfaceTerms<D> terms;
  SurfaceSums<D>* sums;

  __device__ Own loadOwn(const MphPairs<D>&, std::uint32_t) const { return {}; }
  __device__ Other loadOther(const MphPairs<D>& pairs, std::uint32_t j) const {
    return {terms.pull[pairs.material[j]]};
  }

  __device__ void add(const MphPairs<D>&, double* sum, const Vec<D>& d, const PairDistance<double>& r, Own,
                      const Other& other, ListSegment segment) const {
    const double g = terms.gradient(r.square), share = terms.share(g, r.square);
    if (isFluid(segment)) {
      addScaled(sum, g, d);
      sum[2 * D] += share;
      return;
    }
    addScaled(sum + D, g, d);
    sum[2 * D + 1] += share;
    sum[2 * D + 2] = fma(share, other.pull, sum[2 * D + 2]);
  }
  __device__ void store(const MphPairs<D>&, std::uint32_t i, int n, double sum) const {
    SurfaceSums<D>& s = sums[i];
    double& value = n < D            ? s.fluid[n]
                    : n < 2 * D      ? s.wall[n - D]
                    : n == 2 * D     ? s.filled
                    : n == 2 * D + 1 ? s.walls
                                     : s.pull;
    value = sum;
  }
};

/// The force of the stress per fluid particle, from the fluid around it, and what keeps it apart.
template <int D>
struct SurfaceForce {
  static constexpr int values = 2 * D;
  static constexpr bool uses(ListSegment s) { return isFluid(s); }
  using Own = Vec<D>;
  using Other = Vec<D>;

  SurfaceTerms<D> terms;
  const Vec<D>* m;
  Vec<D>*force, *apart;

  __device__ Own loadOwn(const MphPairs<D>&, std::uint32_t i) const { return m[i]; }
  __device__ Other loadOther(const MphPairs<D>&, std::uint32_t j) const { return m[j]; }

  __device__ void add(const MphPairs<D>&, double* sum, const Vec<D>& d, const PairDistance<double>& r,
                      const Own& own, const Other& other, ListSegment) const {
    const double g = terms.gradient(r.square), both = norm2(own) + norm2(other);
    addScaled(sum, g * both, d);
    addScaled(sum, -g * dot(own, d), own);
    addScaled(sum, -g * dot(other, d), other);
    addScaled(sum + D, -terms.core(r.inverse) * both, d);
  }
  __device__ void store(const MphPairs<D>&, std::uint32_t i, int n, double sum) const {
    (n < D ? force[i][n] : apart[i][n - D]) = sum;
  }
};

/// y += the force per fluid particle, what it shares of those along the surface with its neighbours, and `apart`.
template <int D>
struct EvenForce {
  static constexpr int values = D;
  static constexpr bool uses(ListSegment s) { return isFluid(s); }
  struct Own {
    Vec<D> m, f;
  };
  using Other = Own;

  SurfaceTerms<D> terms;
  const Vec<D>*free, *f, *apart;  // the last may be null
  Vec<D>* y;

  __device__ Own loadOwn(const MphPairs<D>&, std::uint32_t i) const { return {free[i], f[i]}; }
  __device__ Other loadOther(const MphPairs<D>&, std::uint32_t j) const { return {free[j], f[j]}; }

  __device__ void add(const MphPairs<D>&, double* sum, const Vec<D>& d, const PairDistance<double>& r,
                      const Own& own, const Other& other, ListSegment) const {
    const Vec<D> normal = own.m + other.m;
    if (!(norm2(own.m) > 0 && norm2(other.m) > 0)) return;
    const double unit2 = r.inverse * r.inverse, across = dot(normal, d);
    const double k = terms.evening(r.square) * (1 - across * across * unit2 / (norm2(normal) + terms.evenNoise));
    addScaled(sum, k * unit2 * dot(d, other.f - own.f), d);
  }
  __device__ void store(const MphPairs<D>&, std::uint32_t i, int n, double sum) const {
    y[i][n] += f[i][n] + sum + (apart ? apart[i][n] : 0.0);
  }
};

/// The reaction per wall particle of the list.
template <int D>
struct SurfaceReaction {
  static constexpr int values = D;
  static constexpr bool uses(ListSegment s) { return isFluid(s); }
  struct Own {};
  using Other = Vec<D>;

  SurfaceTerms<D> terms;
  const Vec<D>* ofWalls;
  Vec<D>*y, *load;
  std::uint32_t first;

  __device__ Own loadOwn(const MphPairs<D>&, std::uint32_t) const { return {}; }
  __device__ Other loadOther(const MphPairs<D>&, std::uint32_t i) const { return ofWalls[i]; }

  __device__ void add(const MphPairs<D>&, double* sum, const Vec<D>&, const PairDistance<double>& r, Own,
                      const Other& other, ListSegment) const {
    addScaled(sum, -terms.share(terms.gradient(r.square), r.square), other);
  }
  __device__ void store(const MphPairs<D>&, std::uint32_t j, int n, double sum) const {
    y[j - first][n] = sum;
    load[j - first][n] += sum;
  }
};

}  // namespace

template <int D>
void surfaceSlope(Context<Cuda>& context, const MphPairs<D>& pairs, const SurfaceTerms<D>& terms,
                  std::span<SurfaceSums<D>> sums, std::span<Vec<D>> m, std::span<Vec<D>> free) {
  sumOnFluid(context, pairs, SumSurface<D>{terms, sums.data()});
  forEach(context, pairs.ownFluid(),
          [terms, material = pairs.material.data(), from = sums.data(), to = m.data(),
           alone = free.data()] __device__(std::size_t i) {
            to[i] = terms.slope(material[i], from[i]);
            alone[i] = terms.sharing(material[i], from[i], to[i]);
          });
}

template <int D>
void surfaceForces(Context<Cuda>& context, const MphPairs<D>& pairs, const SurfaceTerms<D>& terms,
                   std::span<const SurfaceSums<D>> sums, std::span<const Vec<D>> m, std::span<Vec<D>> force,
                   std::span<Vec<D>> apart, std::span<Vec<D>> ofWalls) {
  sumOnFluid(context, pairs, SurfaceForce<D>{terms, m.data(), force.data(), apart.data()});
  forEach(context, pairs.ownFluid(),
          [terms, from = sums.data(), slope = m.data(), to = force.data(),
           alone = ofWalls.data()] __device__(std::size_t i) {
            const SurfaceSums<D> s = from[i];
            const Vec<D> wall = terms.ofWalls(s, slope[i], to[i]);
            to[i] += wall;
            if (alone) alone[i] = s.walls > 0 ? wall * (1 / s.walls) : Vec<D>{};
          });
}

template <int D>
void evenAlongSurface(Context<Cuda>& context, const MphPairs<D>& pairs, const SurfaceTerms<D>& terms,
                      std::span<const Vec<D>> free, std::span<const Vec<D>> f, std::span<Vec<D>> y,
                      std::span<const Vec<D>> apart) {
  sumOnFluid(context, pairs, EvenForce<D>{terms, free.data(), f.data(), apart.data(), y.data()});
}

template <int D>
void surfaceOnWalls(Context<Cuda>& context, const MphPairs<D>& pairs, const SurfaceTerms<D>& terms,
                    const ClusterListView& walls, std::span<const Vec<D>> ofWalls, std::span<Vec<D>> y,
                    std::span<Vec<D>> load) {
  sumOnList(context, pairs, walls,
            SurfaceReaction<D>{terms, ofWalls.data(), y.data(), load.data(), pairs.fluidCount});
}

#define TREACLE_INSTANTIATE(D)                                                                                \
  template void surfaceSlope<D>(Context<Cuda>&, const MphPairs<D>&, const SurfaceTerms<D>&,                   \
                                std::span<SurfaceSums<D>>, std::span<Vec<D>>, std::span<Vec<D>>);             \
  template void surfaceForces<D>(Context<Cuda>&, const MphPairs<D>&, const SurfaceTerms<D>&,                  \
                                 std::span<const SurfaceSums<D>>, std::span<const Vec<D>>, std::span<Vec<D>>, \
                                 std::span<Vec<D>>, std::span<Vec<D>>);                                       \
  template void evenAlongSurface<D>(Context<Cuda>&, const MphPairs<D>&, const SurfaceTerms<D>&,               \
                                    std::span<const Vec<D>>, std::span<const Vec<D>>, std::span<Vec<D>>,      \
                                    std::span<const Vec<D>>);                                                 \
  template void surfaceOnWalls<D>(Context<Cuda>&, const MphPairs<D>&, const SurfaceTerms<D>&,                 \
                                  const ClusterListView&, std::span<const Vec<D>>, std::span<Vec<D>>,         \
                                  std::span<Vec<D>>);
TREACLE_INSTANTIATE(2)
TREACLE_INSTANTIATE(3)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
