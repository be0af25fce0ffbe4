#include "treacle/mph/surface_tension.hpp"

#include "mph/step_sums.cuh"

namespace treacle {
namespace {

/// Sums over all neighbours that read the materials of both.
template <int D>
struct OfMaterials {
  static constexpr bool uses(ListSegment) { return true; }
  struct Own {
    int material;
  };
  using Other = Own;

  SurfaceTerms<D> terms;

  __device__ Own loadOwn(const MphPairs<D>& pairs, std::uint32_t i) const { return {pairs.material[i]}; }
  __device__ Other loadOther(const MphPairs<D>& pairs, std::uint32_t j) const { return {pairs.material[j]}; }
};

/// What fluid and walls are around each fluid particle.
template <int D>
struct SumSurface : OfMaterials<D> {
  static constexpr int values = 2 * D + 5;
  using typename OfMaterials<D>::Own, typename OfMaterials<D>::Other;
  using OfMaterials<D>::terms;

  SurfaceSums<D>* sums;

  __device__ void add(const MphPairs<D>&, double* sum, const Vec<D>& d, const PairDistance<double>& r, Own own,
                      const Other& other, ListSegment segment) const {
    const double g = terms.gradient(r.square), share = terms.share(g, r.square), w = terms.weight(r.square);
    if (isFluid(segment)) {
      addScaled(sum, g, d);
      sum[2 * D] += share;
      sum[2 * D + 2] += w;
      return;
    }
    addScaled(sum + D, g, d);
    sum[2 * D + 1] += share;
    sum[2 * D + 3] += w;
    sum[2 * D + 4] = fma(share, terms.dryPull(own.material, other.material), sum[2 * D + 4]);
  }
  __device__ void store(const MphPairs<D>&, std::uint32_t i, int n, double sum) const {
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
struct SumAtWalls : OfMaterials<D> {
  static constexpr int values = D + 4;
  using typename OfMaterials<D>::Own, typename OfMaterials<D>::Other;
  using OfMaterials<D>::terms;

  WallSums<D>* sums;
  std::uint32_t first;

  __device__ void add(const MphPairs<D>&, double* sum, const Vec<D>& d, const PairDistance<double>& r, Own own,
                      const Other& other, ListSegment segment) const {
    const double v = terms.wetting(r.square);
    sum[D + 2] += terms.weight(r.square);
    if (isFluid(segment)) {
      sum[D + 1] += v;
      sum[D + 3] = fma(v, terms.dryPull(other.material, own.material), sum[D + 3]);
      return;
    }
    addScaled(sum, terms.wettingGradient(r.square), d);
    sum[D] += v;
  }
  __device__ void store(const MphPairs<D>&, std::uint32_t j, int n, double sum) const {
    WallSums<D>& s = sums[j - first];
    (n < D ? s.wall[n] : n == D ? s.walls : n == D + 1 ? s.filled : n == D + 2 ? s.colour : s.repels) = sum;
  }
};

/// Per fluid particle: the force of the stress, what keeps it apart and walls pull along themselves, and S.
template <int D>
struct SurfaceForce {
  static constexpr int values = 3 * D;
  static constexpr bool uses(ListSegment) { return true; }
  struct Own : SurfaceSlope<D> {  // of a wall m is what it pulls with, Adhesion::along
    int material;
  };
  using Other = Own;

  SurfaceTerms<D> terms;
  const SurfaceSlope<D>* slope;
  const Adhesion<D>* adhesion;
  Vec<D>*force, *apart, *press;

  __device__ Own loadOwn(const MphPairs<D>& pairs, std::uint32_t i) const { return {slope[i], pairs.material[i]}; }
  __device__ Other loadOther(const MphPairs<D>& pairs, std::uint32_t j) const {
    if (j < pairs.fluidCount) return loadOwn(pairs, j);
    return {{adhesion[j].along}, pairs.material[j]};
  }

  __device__ void add(const MphPairs<D>&, double* sum, const Vec<D>& d, const PairDistance<double>& r,
                      const Own& own, const Other& other, ListSegment segment) const {
    if (!isFluid(segment)) {
      if (norm2(other.m) > 0)
        addScaled(sum + D, terms.wetPull(own.material, other.material), terms.alongWall(d, r.square, other.m));
      return;
    }
    const double g = terms.gradient(r.square), other2 = norm2(other.m), both = norm2(own.m) + other2;
    addScaled(sum, g * both, d);
    addScaled(sum, -g * own.tie * dot(own.m, d), own.m);
    addScaled(sum, -g * other.tie * dot(other.m, d), other.m);
    if constexpr (D == 3) {
      addScaled(sum, g * dot(own.line, d), own.line);
      addScaled(sum, g * dot(other.line, d), other.line);
    }
    addScaled(sum + D, -terms.core(r.inverse) * both, d);
    addScaled(sum + 2 * D, terms.weight(r.square) * sqrt(other2), other.m);
  }
  __device__ void store(const MphPairs<D>&, std::uint32_t i, int n, double sum) const {
    (n < D ? force[i][n] : n < 2 * D ? apart[i][n - D] : press[i][n - 2 * D]) = sum;
  }
};

/// force += what makes up for the depth of the tension, per fluid particle, and the sums of the fits around it.
template <int D>
struct SurfaceBend {
  static constexpr int values = D + 2;
  static constexpr bool uses(ListSegment s) { return isFluid(s); }
  using Own = Vec<D>;
  struct Other {
    Vec<D> m;
    SurfaceFit fit;
  };

  SurfaceTerms<D> terms;
  const Vec<D>* normal;
  const SurfaceFit* fit;
  Vec<D>* force;
  SurfaceFit* fitted;

  __device__ Own loadOwn(const MphPairs<D>&, std::uint32_t i) const { return normal[i]; }
  __device__ Other loadOther(const MphPairs<D>&, std::uint32_t j) const { return {normal[j], fit[j]}; }

  __device__ void add(const MphPairs<D>&, double* sum, const Vec<D>& d, const PairDistance<double>& r,
                      const Own& own, const Other& other, ListSegment) const {
    const double closing = dot(other.m, d) * norm(own) - dot(own, d) * norm(other.m);
    addScaled(sum, terms.bending(r.square, r.inverse) * closing, d);
    const double near = terms.nearness(r.square);
    sum[D] = fma(near, other.fit.force, sum[D]);
    sum[D + 1] = fma(near, other.fit.press, sum[D + 1]);
  }
  __device__ void store(const MphPairs<D>&, std::uint32_t i, int n, double sum) const {
    if (n < D)
      force[i][n] += sum;
    else
      (n == D ? fitted[i].force : fitted[i].press) = sum;
  }
};

/// y = the force per fluid particle, what it shares of it along the surface with its neighbours, and `apart`.
template <int D>
struct EvenForce {
  static constexpr int values = D;
  static constexpr bool uses(ListSegment s) { return isFluid(s); }
  struct Own {
    Vec<D> m, f;
    bool shares;
  };
  using Other = Own;

  SurfaceTerms<D> terms;
  const Vec<D>* normal;
  const SurfaceFit* fit;
  const Vec<D>*f, *apart;  // the last may be null
  Vec<D>* y;

  __device__ Own loadOwn(const MphPairs<D>&, std::uint32_t i) const { return {normal[i], f[i], fit[i].press > 0}; }
  __device__ Other loadOther(const MphPairs<D>& pairs, std::uint32_t j) const { return loadOwn(pairs, j); }

  __device__ void add(const MphPairs<D>&, double* sum, const Vec<D>& d, const PairDistance<double>& r,
                      const Own& own, const Other& other, ListSegment) const {
    if (!(own.shares && other.shares)) return;
    const Vec<D> n = own.m + other.m;
    const double unit2 = r.inverse * r.inverse, across = dot(n, d);
    const double along = 1 - across * across * unit2 / (norm2(n) + terms.evenNoise);
    const double k = terms.evenFactor * terms.nearness(r.square) * along;
    addScaled(sum, k * unit2 * dot(d, other.f - own.f), d);
  }
  __device__ void store(const MphPairs<D>&, std::uint32_t i, int n, double sum) const {
    y[i][n] = f[i][n] + sum + (apart ? apart[i][n] : 0.0);
  }
};

/// The reaction per wall particle of the list.
template <int D>
struct SurfaceReaction {
  static constexpr int values = D;
  static constexpr bool uses(ListSegment s) { return isFluid(s); }
  struct Own {
    Vec<D> along;  // Adhesion
    int material;
  };
  struct Other {
    Vec<D> ofWalls;
    int material;
  };

  SurfaceTerms<D> terms;
  const Vec<D>* ofWalls;
  const Adhesion<D>* adhesion;
  Vec<D>*y, *load;
  std::uint32_t first;

  __device__ Own loadOwn(const MphPairs<D>& pairs, std::uint32_t j) const {
    return {adhesion[j].along, pairs.material[j]};
  }
  __device__ Other loadOther(const MphPairs<D>& pairs, std::uint32_t i) const {
    return {ofWalls[i], pairs.material[i]};
  }

  __device__ void add(const MphPairs<D>&, double* sum, const Vec<D>& d, const PairDistance<double>& r,
                      const Own& own, const Other& other, ListSegment) const {
    addScaled(sum, -terms.share(terms.gradient(r.square), r.square), other.ofWalls);
    if (norm2(own.along) > 0)
      addScaled(sum, terms.wetPull(other.material, own.material), terms.alongWall(d, r.square, own.along));
  }
  __device__ void store(const MphPairs<D>&, std::uint32_t j, int n, double sum) const {
    y[j - first][n] = sum;
    load[j - first][n] += sum;
  }
};

}  // namespace

template <int D>
void surfaceSlope(Context<Cuda>& context, const MphPairs<D>& pairs, const SurfaceTerms<D>& terms,
                  std::span<SurfaceSums<D>> sums, std::span<SurfaceSlope<D>> slope,
                  std::span<Adhesion<D>> adhesion) {
  sumOnFluid(context, pairs, SumSurface<D>{{terms}, sums.data()});
  forEach(context, pairs.ownFluid(),
          [terms, material = pairs.material.data(), from = sums.data(), to = slope.data(),
           adheres = adhesion.data()] __device__(std::size_t i) {
            to[i] = terms.slope(material[i], from[i]);
            adheres[i] = terms.adhesion(from[i]);
          });
}

template <int D>
void wallAdhesion(Context<Cuda>& context, const MphPairs<D>& pairs, const SurfaceTerms<D>& terms,
                  const ClusterListView& walls, std::span<WallSums<D>> sums, std::span<Adhesion<D>> adhesion) {
  // Without lists, sums over walls count where fluid is within the radius of densities; these look as far as lists
  // do.
  MphPairs<D> far = pairs;
  far.terms.densityRadius = fmax(pairs.terms.densityRadius, pairs.terms.viscosityRadius);
  sumOnList(context, far, walls, SumAtWalls<D>{{terms}, sums.data(), pairs.fluidCount});
  forEach(context, pairs.ownEnd() - pairs.fluidCount,
          [terms, from = sums.data(), to = adhesion.data()] __device__(std::size_t j) {
            to[j] = terms.adhesion(from[j]);
          });
}

template <int D>
void surfaceForces(Context<Cuda>& context, const MphPairs<D>& pairs, const SurfaceTerms<D>& terms,
                   std::span<const SurfaceSums<D>> sums, std::span<const SurfaceSlope<D>> slope,
                   std::span<const Adhesion<D>> adhesion, const SurfaceForces<D>& of) {
  sumOnFluid(
      context, pairs,
      SurfaceForce<D>{terms, slope.data(), adhesion.data(), of.force.data(), of.apart.data(), of.press.data()});
  forEach(context, pairs.ownFluid(),
          [terms, material = pairs.material.data(), from = sums.data(), slopes = slope.data(),
           of] __device__(std::size_t i) { terms.finish(material[i], i, from[i], slopes[i].m, of.force[i], of); });
}

template <int D>
void bendSurface(Context<Cuda>& context, const MphPairs<D>& pairs, const SurfaceTerms<D>& terms,
                 const SurfaceForces<D>& of, std::span<SurfaceFit> fitted) {
  sumOnFluid(context, pairs,
             SurfaceBend<D>{terms, of.normal.data(), of.fit.data(), of.force.data(), fitted.data()});
  forEach(context, pairs.ownFluid(),
          [terms, sums = fitted.data(), of] __device__(std::size_t i) { terms.split(i, sums[i], of); });
}

template <int D>
void evenAlongSurface(Context<Cuda>& context, const MphPairs<D>& pairs, const SurfaceTerms<D>& terms,
                      std::span<const Vec<D>> normal, std::span<const SurfaceFit> fit, std::span<const Vec<D>> f,
                      std::span<Vec<D>> y, std::span<const Vec<D>> apart) {
  sumOnFluid(context, pairs, EvenForce<D>{terms, normal.data(), fit.data(), f.data(), apart.data(), y.data()});
}

template <int D>
void addSurfaceForces(Context<Cuda>& context, std::span<const Vec<D>> f, std::span<Vec<D>> y) {
  forEach(context, f.size(), [from = f.data(), to = y.data()] __device__(std::size_t i) { to[i] += from[i]; });
}

template <int D>
void surfaceOnWalls(Context<Cuda>& context, const MphPairs<D>& pairs, const SurfaceTerms<D>& terms,
                    const ClusterListView& walls, std::span<const Vec<D>> ofWalls,
                    std::span<const Adhesion<D>> adhesion, std::span<Vec<D>> y, std::span<Vec<D>> load) {
  sumOnList(context, pairs, walls,
            SurfaceReaction<D>{terms, ofWalls.data(), adhesion.data(), y.data(), load.data(), pairs.fluidCount});
}

#define TREACLE_INSTANTIATE(D)                                                                                   \
  template void surfaceSlope<D>(Context<Cuda>&, const MphPairs<D>&, const SurfaceTerms<D>&,                      \
                                std::span<SurfaceSums<D>>, std::span<SurfaceSlope<D>>, std::span<Adhesion<D>>);  \
  template void wallAdhesion<D>(Context<Cuda>&, const MphPairs<D>&, const SurfaceTerms<D>&,                      \
                                const ClusterListView&, std::span<WallSums<D>>, std::span<Adhesion<D>>);         \
  template void surfaceForces<D>(Context<Cuda>&, const MphPairs<D>&, const SurfaceTerms<D>&,                     \
                                 std::span<const SurfaceSums<D>>, std::span<const SurfaceSlope<D>>,              \
                                 std::span<const Adhesion<D>>, const SurfaceForces<D>&);                         \
  template void bendSurface<D>(Context<Cuda>&, const MphPairs<D>&, const SurfaceTerms<D>&,                       \
                               const SurfaceForces<D>&, std::span<SurfaceFit>);                                  \
  template void evenAlongSurface<D>(Context<Cuda>&, const MphPairs<D>&, const SurfaceTerms<D>&,                  \
                                    std::span<const Vec<D>>, std::span<const SurfaceFit>,                        \
                                    std::span<const Vec<D>>, std::span<Vec<D>>, std::span<const Vec<D>>);        \
  template void addSurfaceForces<D>(Context<Cuda>&, std::span<const Vec<D>>, std::span<Vec<D>>);                 \
  template void surfaceOnWalls<D>(Context<Cuda>&, const MphPairs<D>&, const SurfaceTerms<D>&,                    \
                                  const ClusterListView&, std::span<const Vec<D>>, std::span<const Adhesion<D>>, \
                                  std::span<Vec<D>>, std::span<Vec<D>>);
TREACLE_INSTANTIATE(2)
TREACLE_INSTANTIATE(3)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
