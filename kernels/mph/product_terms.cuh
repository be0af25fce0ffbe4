#pragma once

#include "mph/cluster_sum.cuh"
#include "treacle/mph/mph_sums.hpp"
#include "treacle/mph/pair_sums.hpp"

namespace treacle {

/// One fetch where the type allows it.
template <int D, class T>
__device__ inline Vec<D, T> fetch(const Gathered<D, T>* from) {
  if constexpr (std::is_same_v<T, float> && D == 3) {
    const float4 v = *reinterpret_cast<const float4*>(from);
    return {v.x, v.y, v.z};
  } else if constexpr (std::is_same_v<T, float> && D == 2) {
    const float2 v = *reinterpret_cast<const float2*>(from);
    return {v.x, v.y};
  } else {
    return *from;
  }
}
template <int D, class T>
__device__ inline Vec<D, T> fetch(const Vec<D, T>* from) {
  return *from;
}

/// 16 bytes at a time, which a buffer's start allows where the size does.
template <int D>
__device__ inline SymmetricBlock<D> fetch(const SymmetricBlock<D>* from) {
  if constexpr (SymmetricBlock<D>::size % 2 != 0) {
    return *from;
  } else {
    SymmetricBlock<D> block;
    for (int k = 0; k < SymmetricBlock<D>::size; k += 2) {
      const double2 v = reinterpret_cast<const double2*>(from)[k / 2];
      block.a[k] = v.x;
      block.a[k + 1] = v.y;
    }
    return block;
  }
}

/// What a loop over fluid is to know of the viscosities of its pairs: all have one; one substance, of which each
/// particle has a scale; whatever MphPairs::viscosityOf says.
enum class PairViscosity { One, Scaled, Any };

/// f(kind), as a type, with what is true of the pairs.
template <int D, class F>
void withPairViscosity(const MphPairs<D>& pairs, F&& f) {
  if (pairs.hasOneViscosity())
    f(std::integral_constant<PairViscosity, PairViscosity::One>{});
  else if (pairs.isOneSubstance())
    f(std::integral_constant<PairViscosity, PairViscosity::Scaled>{});
  else
    f(std::integral_constant<PairViscosity, PairViscosity::Any>{});
}

/// What such a loop reads of a particle, and the factor of a pair's terms.
template <class T, PairViscosity Kind>
struct ViscosityOf;
template <class T>
struct ViscosityOf<T, PairViscosity::One> {
  template <int D>
  __device__ static ViscosityOf of(const MphPairs<D>&, std::uint32_t) {
    return {};
  }
};
template <class T>
struct ViscosityOf<T, PairViscosity::Scaled> {
  T scale;

  template <int D>
  __device__ static ViscosityOf of(const MphPairs<D>& pairs, std::uint32_t i) {
    return {static_cast<T>(pairs.viscosityScale[i])};
  }
  template <int D>
  __device__ static T ofPair(const MphPairs<D>& pairs, ViscosityOf a, ViscosityOf b) {
    return pairs.meanScale(a.scale, b.scale);
  }
};
template <class T>
struct ViscosityOf<T, PairViscosity::Any> {
  ViscousSide side;

  template <int D>
  __device__ static ViscosityOf of(const MphPairs<D>& pairs, std::uint32_t i) {
    return {pairs.viscousSide(i)};
  }
  template <int D>
  __device__ static T ofPair(const MphPairs<D>& pairs, ViscosityOf a, ViscosityOf b) {
    return pairs.template viscosityOf<T>(a.side, b.side);
  }
};

/// The factor of the sums of such terms.
template <PairViscosity Kind, class T, int D>
__device__ inline T viscosityOfSums(const MphPairs<D>& pairs) {
  if constexpr (Kind == PairViscosity::Any)
    return 1;
  else
    return static_cast<T>(pairs.onlyViscosity());
}

template <int D, class T, PairViscosity Kind>
struct VelocityOf {
  Vec<D, T> u;
  ViscosityOf<T, Kind> viscosity;
};

/// What a fluid particle's own velocity meets in A: the diagonal block of rho/dt I + V, and C_ii; walls included.
template <int D>
struct SelfTerms {
  std::span<const Block<D>> block;   // [kg/(m3 s)]
  std::span<const Vec<D>> gradient;  // [1/m]
};

/// y = (rho/dt I + V) u and q = lambda C^T u per fluid particle, walls at rest [K23 eq. (16)]: the first pass of a
/// product A u. The sums run over the neighbours' velocities alone, u_i meets the particle's self terms: three
/// subtractions and three registers per pair less than with u_j - u_i.
template <int D, class T, PairViscosity Kind, class Mph>
struct ViscosityAndDivergence {
  static constexpr int values = D + 1;
  static constexpr bool uses(ListSegment s) { return isFluid(s); }
  using Own = ViscosityOf<T, Kind>;
  using Other = VelocityOf<D, T, Kind>;

  Mph mph;
  SelfTerms<D> self;
  const Vec<D, T>* u;
  Vec<D, T>* y;
  T* q;

  __device__ Own loadOwn(const MphPairs<D>& pairs, std::uint32_t i) const { return Own::of(pairs, i); }
  __device__ Other loadOther(const MphPairs<D>& pairs, std::uint32_t j) const { return {u[j], Own::of(pairs, j)}; }

  __device__ void add(const MphPairs<D>& pairs, T* sum, const Vec<D, T>& d, const PairDistance<T>& r, Own own,
                      const Other& other, ListSegment segment) const {
    const T along = dot(d, other.u);
    T f = mph.viscousShape(r) * along;
    if constexpr (Kind != PairViscosity::One) f *= Own::ofPair(pairs, own, other.viscosity);
    addScaled(sum, f, d);
    if (isNear(segment)) sum[D] = fma(mph.gradientShape(r), along, sum[D]);
  }

  __device__ void store(const MphPairs<D>& pairs, std::uint32_t i, int n, T sum) const {
    const Vec<D, T> ui = u[i];
    if (n < D) {
      T own = 0;
      for (int c = 0; c < D; ++c) own += static_cast<T>(self.block[i](n, c)) * ui[c];
      y[i][n] = own - mph.viscousFactor * viscosityOfSums<Kind, T>(pairs) * sum;
    } else {
      T div = -mph.gradientFactor * sum;
      for (int c = 0; c < D; ++c) div += ui[c] * static_cast<T>(self.gradient[i][c]);
      q[i] = static_cast<T>(pairs.bulkViscosity(i)) * div;
    }
  }
};

/// What store(i, sum) or store.put(i, sum, own) needs besides the sum, fetched before the sum is there.
template <class Store>
__device__ inline auto ownOf(const Store& store, std::uint32_t i) {
  if constexpr (requires { store.own(i); })
    return store.own(i);
  else
    return 0;
}
template <class Store, class Sum, class Own>
__device__ inline void put(const Store& store, std::uint32_t i, const Sum& sum, const Own& own) {
  if constexpr (requires { store.own(i); })
    store.put(i, sum, own);
  else
    store(i, sum);
}

/// store(i, ((rho/dt I + V) u)_i) per fluid particle; as ViscosityAndDivergence without the divergence.
template <int D, class T, PairViscosity Kind, class Mph, class V, class Store>
struct Viscosity {
  using StoresVectors = void;
  static constexpr int values = D;
  static constexpr bool uses(ListSegment s) { return isFluid(s); }
  using Own = ViscosityOf<T, Kind>;
  using Other = VelocityOf<D, T, Kind>;

  Mph mph;
  const Block<D, T>* selfBlock;
  const V* u;
  Store result;

  __device__ Own loadOwn(const MphPairs<D>& pairs, std::uint32_t i) const { return Own::of(pairs, i); }
  template <class Stored>
  __device__ Other loadOther(const MphPairs<D>& pairs, std::uint32_t j, const Stored& stored) const {
    if constexpr (Kind == PairViscosity::Scaled && std::is_same_v<T, float>)
      return {fetch(&u[j]), {LocalPositions<D, T>::viscosityScale(stored)}};
    else
      return {fetch(&u[j]), Own::of(pairs, j)};
  }
  __device__ void add(const MphPairs<D>& pairs, T* sum, const Vec<D, T>& d, const PairDistance<T>& r, Own own,
                      const Other& other, ListSegment) const {
    T f = mph.viscousShape(r) * dot(d, other.u);
    if constexpr (Kind != PairViscosity::One) f *= Own::ofPair(pairs, own, other.viscosity);
    addScaled(sum, f, d);
  }
  __device__ void store(const MphPairs<D>& pairs, std::uint32_t i, const Vec<D, T>& sum) const {
    put(result, i, selfBlock[i] * fetch(&u[i]) - mph.viscousFactor * viscosityOfSums<Kind, T>(pairs) * sum,
        ownOf(result, i));
  }
};

/// div = C^T u per particle [1/s] [K23 eq. (14)], or, with Scaled, lambda C^T u. With WallsAtRest u has only fluid
/// particles, and unless WithWalls fluid meets no walls. Renormalised: whether the pairs may have B.
template <int D, class T, class Mph, bool Renormalised, bool WallsAtRest, bool Scaled,
          bool WithWalls = !WallsAtRest>
struct Divergence {
  static constexpr int values = 1;
  static constexpr bool uses(ListSegment s) {
    return s == ListSegment::NearFluid || (WithWalls && s == ListSegment::NearWall);
  }
  struct Own {
    std::uint32_t i;
    Vec<D, T> u;
  };
  using Other = Vec<D, T>;

  Mph mph;
  const Vec<D, T>* u;
  T* div;

  __device__ Own loadOwn(const MphPairs<D>& pairs, std::uint32_t i) const { return {i, velocity(pairs, i)}; }
  __device__ Other loadOther(const MphPairs<D>& pairs, std::uint32_t j) const {
    return WithWalls ? velocity(pairs, j) : u[j];
  }
  __device__ Vec<D, T> velocity(const MphPairs<D>& pairs, std::uint32_t i) const {
    return WallsAtRest && i >= pairs.fluidCount ? Vec<D, T>{} : u[i];
  }

  __device__ void add(const MphPairs<D>& pairs, T* sum, const Vec<D, T>& d, const PairDistance<T>& r,
                      const Own& own, const Other& other, ListSegment) const {
    const Vec<D, T> column = Renormalised ? pairs.corrected(own.i, d) : d;
    sum[0] = fma(mph.gradientShape(r), differenceAlong(other, own.u, column), sum[0]);
  }
  __device__ void store(const MphPairs<D>& pairs, std::uint32_t i, int, T sum) const {
    const double lambda = Scaled ? pairs.bulkViscosity(i) : 1.0;
    div[i] = -mph.gradientFactor * static_cast<T>(lambda) * sum;
  }
};

/// y = C q, or y += factor C q with Add, per fluid particle; q per particle. Renormalised: whether the pairs may
/// have B.
template <int D, class T, class Mph, bool Renormalised, bool Add>
struct PressureForce {
  static constexpr int values = D;
  static constexpr bool uses(ListSegment s) { return isNear(s); }
  struct Own {
    std::uint32_t i;
    T q;
  };
  using Other = Own;

  Mph mph;
  const T* q;
  Vec<D, T>* y;
  T factor = 1;

  __device__ Own loadOwn(const MphPairs<D>&, std::uint32_t i) const { return {i, q[i]}; }
  __device__ Other loadOther(const MphPairs<D>&, std::uint32_t j) const { return {j, q[j]}; }

  __device__ void add(const MphPairs<D>& pairs, T* sum, const Vec<D, T>& d, const PairDistance<T>& r,
                      const Own& own, const Other& other, ListSegment) const {
    const T g = mph.gradientShape(r);
    if constexpr (Renormalised)
      addScaled(sum, g, own.q * pairs.corrected(own.i, d) + other.q * pairs.corrected(other.i, d));
    else
      addScaled(sum, g * (own.q + other.q), d);
  }
  __device__ void store(const MphPairs<D>&, std::uint32_t i, int n, T sum) const {
    const T value = factor * mph.gradientFactor * sum;
    y[i][n] = Add ? y[i][n] + value : value;
  }
};

}  // namespace treacle
