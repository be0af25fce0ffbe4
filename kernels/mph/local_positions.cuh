#pragma once

#include "treacle/mph/mph_pairs.hpp"

#include <cstdint>
#include <type_traits>

namespace treacle {

/// Squares of distances get this fraction of h_p^2 added: a particle meets itself in its cluster's list, and two
/// may coincide; their differences are then zero and so is every term, whatever 1/r.
template <class T>
inline constexpr double distanceFloor = std::is_same_v<T, double> ? 1e-24 : 1e-12;

/// Positions as a kernel's arithmetic takes them: local(of(j), of(first)) - local(of(i), of(first)) is x_j - x_i.
template <int D, class T>
struct LocalPositions;

template <int D>
struct LocalPositions<D, double> {
  using Stored = Vec<D>;
  double floor;

  static LocalPositions make(const MphPairs<D>& pairs) {
    const double h = pairs.terms.pressureRadius;
    return {distanceFloor<double> * h * h};
  }
  static double unit(const MphPairs<D>&) { return 1; }  // of length [m]

  __device__ Stored of(const MphPairs<D>& pairs, std::uint32_t i) const { return pairs.position[i]; }
  __device__ Vec<D> local(const Stored& x, const Stored&) const { return x; }
  /// Whether differences may be others than those between nearest images; `wraps`: of the cluster.
  __device__ static bool imagesMayDiffer(const Vec<D>&, bool wraps) { return wraps; }
  __device__ static Vec<D> nearest(const MphPairs<D>& pairs, const Vec<D>& d) { return pairs.grid.nearest(d); }
};

/// In single precision: differences of positions in units of 2^-32 of the domain's length are exact, and those
/// across periodic ends come out right by themselves; local positions count from the cluster's first particle, in
/// h_v. Beside a position stands the scale of the particle's viscosity.
template <int D>
struct LocalPositions<D, float> {
  using Stored = int4;
  float floor;
  const int4* fixed;
  Vec<D, float> scale;
  Vec<D, float> period;  // in h_v; infinite on open axes

  static LocalPositions make(const MphPairs<D>& pairs, const std::int32_t* fixed) {
    const double h = pairs.terms.pressureRadius / unit(pairs);
    LocalPositions p{
        static_cast<float>(distanceFloor<float> * h * h), reinterpret_cast<const int4*>(fixed), {}, {}};
    for (int k = 0; k < D; ++k) {
      const double length = pairs.grid.length[k] / unit(pairs);
      p.scale[k] = static_cast<float>(length / 4294967296.0);
      p.period[k] = static_cast<float>(pairs.grid.periodic[k] ? length : 1e30);
    }
    return p;
  }
  TREACLE_HD static double unit(const MphPairs<D>& pairs) { return pairs.terms.viscosityRadius; }

  __device__ Stored of(const MphPairs<D>&, std::uint32_t i) const { return fixed[i]; }
  __device__ static float viscosityScale(const Stored& x) { return __int_as_float(x.w); }
  __device__ Vec<D, float> local(const Stored& x, const Stored& origin) const {
    // Rounded here: fused into a later subtraction, a particle would not be at distance zero from itself.
    const auto axis = [this](int a, int b, int k) {
      const auto difference = static_cast<int>(static_cast<unsigned>(a) - static_cast<unsigned>(b));
      return __fmul_rn(static_cast<float>(difference), scale[k]);
    };
    Vec<D, float> d;
    d[0] = axis(x.x, origin.x, 0);
    d[1] = axis(x.y, origin.y, 1);
    if constexpr (D == 3) d[2] = axis(x.z, origin.z, 2);
    return d;
  }

  /// A particle this far from its cluster's first one may have neighbours that are nearer to the first one's other
  /// side.
  __device__ bool imagesMayDiffer(const Vec<D, float>& own, bool) const {
    bool torn = false;
    for (int k = 0; k < D; ++k) torn = torn || fabsf(own[k]) > 0.5f * period[k] - 1.01f;
    return torn;
  }
  __device__ Vec<D, float> nearest(const MphPairs<D>&, Vec<D, float> d) const {
    for (int k = 0; k < D; ++k) d[k] -= period[k] * rintf(d[k] / period[k]);
    return d;
  }
};

}  // namespace treacle
