#pragma once

#include "treacle/core/backend.hpp"
#include "treacle/mph/mph_pairs.hpp"

#include <cstdint>
#include <type_traits>

namespace treacle {

// Sums over the neighbours of particles whose formulas are written once for both backends: a device's thread has a
// particle in double, a CPU's loop the eight particles of a cluster in Lanes. The terms of a sum are a structure
// with
//   values                             how many sums a particle has
//   uses(segment)                      which parts of the lists count
//   own(pairs, at)                     what they read of particles, an Own<At>; `at` is OneParticle or
//   ClusterLanes other(pairs, j)                    the same of a neighbour; without it own(pairs, OneParticle{j})
//   add(pairs, sums, d, distance, own, other, segment)
//   store(pairs, i, n, sum)            called once per particle and sum, or, with a type StoresAll,
//   store(pairs, i, sums)              once per particle
// sumOnFluid, sumOnList and sumOnAll run them: kernels/mph/step_sums.cuh, src/mph/lane_sums.hpp.

constexpr bool isFluid(ListSegment s) { return s == ListSegment::NearFluid || s == ListSegment::FarFluid; }
constexpr bool isNear(ListSegment s) { return s == ListSegment::NearFluid || s == ListSegment::NearWall; }
constexpr bool isWall(ListSegment s) { return !isFluid(s); }

/// One particle, as terms load values of it: at(f) is f(i).
struct OneParticle {
  using Number = double;
  template <class T>
  using Each = T;
  template <int D>
  using Viscosity = ViscousSide;  // what viscosityOf() reads of it

  std::uint32_t index;

  template <class F>
  TREACLE_HD auto operator()(F&& f) const {
    return f(index);
  }
  template <int D>
  TREACLE_HD ViscousSide viscosity(const MphPairs<D>& pairs) const {
    return pairs.viscousSide(index);
  }
};

/// What At(f) gives for f that gives a number, a vector, or something that is no number.
template <class At>
using NumberAt = typename At::Number;
template <int D, class At>
using VecAt = Vec<D, typename At::Number>;
template <class T, class At>
using EachAt = typename At::template Each<T>;

/// What terms read of a neighbour.
template <int D, class Terms>
TREACLE_HD auto otherOf(const MphPairs<D>& pairs, const Terms& terms, std::uint32_t j) {
  if constexpr (requires { terms.other(pairs, j); })
    return terms.other(pairs, j);
  else
    return terms.own(pairs, OneParticle{j});
}

/// f(value), where `value` is that of one particle; lane_sums.hpp has the same for a cluster.
template <class T, class F>
TREACLE_HD inline double ofEach(const T& value, F&& f) {
  return f(value);
}

/// 1, or 0 where a particle meets itself.
TREACLE_HD inline double isAnother(const OneParticle& own, std::uint32_t other) {
  return own.index != other ? 1 : 0;
}

/// mu_ij of MphPairs::viscosityOf [Pa s].
template <int D>
TREACLE_HD double viscosityOf(const MphPairs<D>& pairs, const ViscousSide& own, std::uint32_t other) {
  return pairs.viscosityOf(own, pairs.viscousSide(other));
}

/// f(i, d) of particles and their difference d to a neighbour [m].
template <int D, class F>
TREACLE_HD double ofEachPair(const OneParticle& own, const Vec<D>& d, F&& f) {
  return f(own.index, d);
}

/// MphPairs::wallFactor of a fluid and a wall particle, whichever `own` is, d = x_other - x_own [m]; 1 unless
/// Corrected.
template <bool Corrected, int D>
TREACLE_HD double wallFactorOf(const MphPairs<D>& pairs, const OneParticle& own, std::uint32_t other,
                               const Vec<D>& d) {
  if (!Corrected) return 1;
  return other >= pairs.fluidCount ? pairs.wallFactor(own.index, other, d)
                                   : pairs.wallFactor(other, own.index, -1.0 * d);
}

/// MphPairs::corrected.
template <int D>
TREACLE_HD Vec<D> corrected(const MphPairs<D>& pairs, std::uint32_t k, const Vec<D>& v) {
  return pairs.corrected(k, v);
}

/// f(terms, whether the pairs may have surfaces of walls or B): the published scheme has neither.
template <int D, class F>
void withStepTerms(const MphPairs<D>& pairs, F&& f) {
  if (pairs.terms.scheme.kind == SchemeKind::Published)
    f(pairs.terms.with(PublishedScheme{}), std::false_type{});
  else
    f(pairs.terms.with(AccurateScheme{}), std::true_type{});
}

/// a where the condition holds, else b; lanes.hpp has the same for Lanes.
TREACLE_HD inline double select(bool condition, double a, double b) { return condition ? a : b; }

/// a.b where the components of one may be Lanes.
template <int D, class A, class B>
TREACLE_HD inline auto along(const Vec<D, A>& a, const Vec<D, B>& b) {
  auto sum = a[0] * b[0];
  for (int k = 1; k < D; ++k) sum += a[k] * b[k];
  return sum;
}

/// (a - b).d
template <int D, class A, class T>
TREACLE_HD inline T differenceAlong(const Vec<D, A>& a, const Vec<D, T>& b, const Vec<D, T>& d) {
  T sum = (a[0] - b[0]) * d[0];
  for (int k = 1; k < D; ++k) sum += (a[k] - b[k]) * d[k];
  return sum;
}

/// sum[k] += factor v[k]
template <int D, class T, class Factor, class U>
TREACLE_HD inline void addScaled(T* sum, const Factor& factor, const Vec<D, U>& v) {
  for (int k = 0; k < D; ++k) sum[k] += factor * v[k];
}

}  // namespace treacle
