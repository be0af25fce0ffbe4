#pragma once

#include "treacle/mph/mph_pairs.hpp"

#include <cstdint>
#include <type_traits>

namespace treacle {

/// Squares of distances get this fraction of h_p^2 added: a particle meets itself in its cluster's list, and two
/// may coincide; their differences are then zero and so is every term, whatever 1/r.
template <class T>
inline constexpr double distanceFloor = std::is_same_v<T, double> ? 1e-24 : 1e-12;

/// Positions as a kernel's arithmetic takes them.
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

  /// Particle i of a cluster, at the image nearest to the cluster's first particle.
  __device__ Stored own(const MphPairs<D>& pairs, std::uint32_t i, std::uint32_t first, bool wraps) const {
    const Vec<D>& x = pairs.position[i];
    return wraps ? pairs.grid.beside(pairs.position[first], x) : x;
  }
  __device__ Stored neighbour(const MphPairs<D>& pairs, ListEntry e, bool wraps) const {
    Vec<D> x = pairs.position[e.index()];
    if (wraps && e.image() != 0) x += pairs.images.shift[e.image()];
    return x;
  }
  __device__ Vec<D> local(const Stored& x, const Stored&) const { return x; }

  /// Whether differences of local positions can mean another image than the list does: not here, images are added.
  static constexpr bool imagesCount = false;
  __device__ static bool imagesMayDiffer(const Vec<D>&) { return false; }
  __device__ static Vec<D> beside(const MphPairs<D>&, std::uint32_t, std::uint32_t) { return {}; }
  __device__ static Stored withEntry(ListEntry) { return {}; }
  __device__ static Vec<D> atImage(const Stored&, const Stored&) { return {}; }
  __device__ static void moveToListedImage(Vec<D>&, const Vec<D>&, const Stored&, std::uint32_t) {}
};

/// In single precision: differences of positions in units of 2^-32 of the domain's length are exact, and those
/// across periodic ends come out right by themselves; local positions count from the cluster's first particle, in
/// h_v.
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

  __device__ Stored own(const MphPairs<D>&, std::uint32_t i, std::uint32_t, bool) const { return fixed[i]; }
  __device__ Stored neighbour(const MphPairs<D>&, ListEntry e, bool) const { return fixed[e.index()]; }
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
  static constexpr bool imagesCount = true;

  /// A particle this far from its cluster's first one may have neighbours that are nearer to the first one's other
  /// side, and a neighbour may be in the list at two images, each for other particles: then images count.
  __device__ bool imagesMayDiffer(const Vec<D, float>& own) const {
    bool torn = false;
    for (int k = 0; k < D; ++k) torn = torn || fabsf(own[k]) > 0.5f * period[k] - 1.01f;
    return torn;
  }
  /// Particle i from the cluster's first one, beside it as the lists see it.
  __device__ static Vec<D, float> beside(const MphPairs<D>& pairs, std::uint32_t i, std::uint32_t first) {
    const Vec<D> x = pairs.position[first], d = pairs.grid.beside(x, pairs.position[i]) - x;
    Vec<D, float> single;
    for (int k = 0; k < D; ++k) single[k] = static_cast<float>(d[k] / unit(pairs));
    return single;
  }
  /// A neighbour's position together with its entry.
  __device__ Stored withEntry(ListEntry e) const {
    int4 x = fixed[e.index()];
    x.w = static_cast<int>(e.bits);
    return x;
  }
  /// A withEntry neighbour from the cluster's first particle, at its image; only so exact as to tell images apart.
  __device__ Vec<D, float> atImage(const Stored& x, const Stored& origin) const {
    const auto axis = [this](int a, int b, int k) {
      return (static_cast<float>(static_cast<unsigned>(a)) - static_cast<float>(static_cast<unsigned>(b))) *
             scale[k];
    };
    Vec<D, float> d;
    d[0] = axis(x.x, origin.x, 0);
    d[1] = axis(x.y, origin.y, 1);
    if constexpr (D == 3) d[2] = axis(x.z, origin.z, 2);
    std::uint32_t code = ListEntry{static_cast<std::uint32_t>(x.w)}.image();
    for (int k = 0; k < D; ++k, code /= 3) d[k] += code % 3 == 0 ? 0.f : code % 3 == 1 ? period[k] : -period[k];
    return d;
  }
  /// The difference d from particle i to a withEntry neighbour brought to the nearest image, if that is the one in
  /// the list, which is `listed` away; else, and from i to itself, one that is out of reach.
  __device__ void moveToListedImage(Vec<D, float>& d, const Vec<D, float>& listed, const Stored& neighbour,
                                    std::uint32_t i) const {
    bool other = ListEntry{static_cast<std::uint32_t>(neighbour.w)}.index() == i;
    for (int k = 0; k < D; ++k) {
      d[k] -= period[k] * rintf(d[k] / period[k]);
      other = other || fabsf(listed[k] - d[k]) > 0.5f * period[k];
    }
    if (other) d[0] = 1e10f;
  }
};

}  // namespace treacle
