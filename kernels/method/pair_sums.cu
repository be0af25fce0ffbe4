#include "treacle/method/pair_sums.hpp"

#include "method/step_sums.cuh"

namespace treacle {
namespace {

/// n_i = sum_j w_ij^p per particle [K23 eq. (7)].
template <int D>
struct NumberDensity {
  static constexpr int values = 1;
  static constexpr bool uses(ListSegment s) { return isNear(s); }
  using Own = std::uint32_t;  // the index: a particle is not its own neighbour
  using Other = std::uint32_t;

  double inverseRadius, scale;
  double* n;

  __device__ Own loadOwn(const MphPairs<D>&, std::uint32_t i) const { return i; }
  __device__ Other loadOther(const MphPairs<D>&, std::uint32_t j) const { return j; }

  __device__ void add(const MphPairs<D>&, double* sum, const Vec<D>&, double inverseR, Own own, Other other,
                      ListSegment) const {
    const double part = positivePart(1 - inverseRadius / inverseR);
    if (own != other) sum[0] += part * part;
  }
  __device__ void store(const MphPairs<D>&, std::uint32_t i, int, double sum) const { n[i] = scale * sum; }
};

/// Viscous pair coefficient of a fluid particle and a wall, without the constant factor.
template <int D>
__device__ inline double wallViscosity(const MphPairs<D>& pairs, const PairConstants<D, double>& constants,
                                       double inverseR, std::uint8_t own, std::uint8_t other) {
  return pairs.materials.pairViscosity[own][other] * constants.viscosityReach(inverseR);
}

template <int D>
struct WallSums {
  static constexpr int values = D * D + D;
  static constexpr bool uses(ListSegment s) { return isWall(s); }
  using Own = std::uint8_t;  // material
  using Other = std::uint8_t;

  PairConstants<D, double> constants;
  WallTerms<D> terms;

  __device__ Own loadOwn(const MphPairs<D>& pairs, std::uint32_t i) const { return pairs.material[i]; }
  __device__ Other loadOther(const MphPairs<D>& pairs, std::uint32_t j) const { return pairs.material[j]; }

  __device__ void add(const MphPairs<D>& pairs, double* sum, const Vec<D>& d, double inverseR, Own own,
                      Other other, ListSegment) const {
    const double f = wallViscosity(pairs, constants, inverseR, own, other);
    for (int r = 0; r < D; ++r) addScaled(sum + r * D, f * d[r], d);
    addScaled(sum + D * D, constants.pressureReach(inverseR), d);
  }
  __device__ void store(const MphPairs<D>& pairs, std::uint32_t i, int n, double sum) const {
    if (n >= D * D) {
      terms.gradient[i][n - D * D] = constants.pressureFactor * sum;
    } else {
      const bool diagonal = n % (D + 1) == 0;
      terms.block[i].a[n] =
          constants.viscosityFactor * sum + (diagonal ? pairs.materials.inertia[pairs.material[i]] : 0.0);
    }
  }
};

template <int D>
struct WallDrag {
  static constexpr int values = D;
  static constexpr bool uses(ListSegment s) { return isWall(s); }
  using Own = VelocityOf<D, double>;
  using Other = VelocityOf<D, double>;

  PairConstants<D, double> constants;
  const Vec<D>* u;
  Vec<D>* y;

  __device__ Own loadOwn(const MphPairs<D>& pairs, std::uint32_t i) const { return {Vec<D>{}, pairs.material[i]}; }
  __device__ Other loadOther(const MphPairs<D>& pairs, std::uint32_t j) const { return {u[j], pairs.material[j]}; }

  __device__ void add(const MphPairs<D>& pairs, double* sum, const Vec<D>& d, double inverseR, const Own& own,
                      const Other& other, ListSegment) const {
    const double f = wallViscosity(pairs, constants, inverseR, own.material, other.material);
    addScaled(sum, f * dot(d, other.u), d);
  }
  __device__ void store(const MphPairs<D>&, std::uint32_t i, int n, double sum) const {
    y[i][n] += constants.viscosityFactor * sum;
  }
};

}  // namespace

template <int D>
void numberDensity(Context<Cuda>& context, const MphPairs<D>& pairs, std::span<double> n) {
  const Weight<D>& w = pairs.pressureWeight;
  sumOnAll(context, pairs, NumberDensity<D>{1 / w.radius, w.scale, n.data()});
}

template <int D>
void addPressureGradient(Context<Cuda>& context, const MphPairs<D>& pairs, std::span<const double> q,
                         double factor, std::span<Vec<D>> y) {
  const auto constants = PairConstants<D, double>::make(pairs, 1);
  sumOnFluid(context, pairs, PressureGradient<D, double, true>{constants, q.data(), y.data(), factor});
}

template <int D>
void divergence(Context<Cuda>& context, const MphPairs<D>& pairs, std::span<const Vec<D>> u,
                std::span<double> div) {
  const auto constants = PairConstants<D, double>::make(pairs, 1);
  sumOnAll(context, pairs, Divergence<D, double, false, false>{constants, u.data(), div.data()});
}

template <int D>
void wallTerms(Context<Cuda>& context, const MphPairs<D>& pairs, const WallTerms<D>& terms) {
  sumOnFluid(context, pairs, WallSums<D>{PairConstants<D, double>::make(pairs, 1), terms});
}

template <int D>
void addWallDrag(Context<Cuda>& context, const MphPairs<D>& pairs, std::span<const Vec<D>> u,
                 std::span<Vec<D>> y) {
  sumOnFluid(context, pairs, WallDrag<D>{PairConstants<D, double>::make(pairs, 1), u.data(), y.data()});
}

#define TREACLE_INSTANTIATE(D)                                                                                 \
  template void numberDensity<D>(Context<Cuda>&, const MphPairs<D>&, std::span<double>);                       \
  template void addPressureGradient<D>(Context<Cuda>&, const MphPairs<D>&, std::span<const double>, double,    \
                                       std::span<Vec<D>>);                                                     \
  template void divergence<D>(Context<Cuda>&, const MphPairs<D>&, std::span<const Vec<D>>, std::span<double>); \
  template void wallTerms<D>(Context<Cuda>&, const MphPairs<D>&, const WallTerms<D>&);                         \
  template void addWallDrag<D>(Context<Cuda>&, const MphPairs<D>&, std::span<const Vec<D>>, std::span<Vec<D>>);
TREACLE_INSTANTIATE(2)
TREACLE_INSTANTIATE(3)
#undef TREACLE_INSTANTIATE

}  // namespace treacle
