#pragma once

#include "treacle/core/halo.hpp"
#include "treacle/core/macros.hpp"
#include "treacle/linear/deflation.hpp"
#include "treacle/linear/spectral_estimate.hpp"
#include "treacle/linear/vector.hpp"

#include <cmath>
#include <limits>
#include <type_traits>

namespace treacle {

// What a Krylov method does with each number of its vectors, and sums over them, for the sources of both backends,
// which instantiate it. The scalars are in the backend's memory. A thread of a device has one number; there are no
// atomics but those of the reductions. Each backend has, beside forEach,
//
//   forEachNumber(context, n, scalars, body): body(i, *scalars) for i in [0, n)
//   reduceNumbers(context, n, scalars, body, finish): finish(sum of body(i, *scalars), *scalars), once
//   reduceInOrder: the same, with sums that no lanes of vector registers share

template <class Backend>
void residual(Context<Backend>& context, std::span<const double> b, std::span<double> r, KrylovScalars* scalars) {
  reduceNumbers(
      context, b.size(), scalars, [=] TREACLE_HD(std::size_t i, const KrylovScalars&) { return b[i] * b[i]; },
      [] TREACLE_HD(double bb, KrylovScalars& s) { s.bb = bb; });
  reduceNumbers(
      context, b.size(), scalars,
      [=] TREACLE_HD(std::size_t i, const KrylovScalars&) {
        const double ri = b[i] - r[i];
        r[i] = ri;
        return ri * ri;
      },
      [] TREACLE_HD(double rr, KrylovScalars& s) { s.start(s.bb, rr); });
}

/// finish(x.y, *scalars)
template <class Backend, class Finish>
void dotProduct(Context<Backend>& context, std::span<const double> x, std::span<const double> y,
                KrylovScalars* scalars, Finish finish) {
  reduceNumbers(
      context, x.size(), scalars, [=] TREACLE_HD(std::size_t i, const KrylovScalars&) { return x[i] * y[i]; },
      finish);
}

template <class Backend>
void directionDot(Context<Backend>& context, std::span<const double> x, std::span<const double> y,
                  KrylovScalars* scalars) {
  dotProduct(context, x, y, scalars, [] TREACLE_HD(double sum, KrylovScalars& s) { s.setDirection(sum); });
}

template <class Backend>
void stepDot(Context<Backend>& context, std::span<const double> x, std::span<const double> y,
             KrylovScalars* scalars) {
  dotProduct(context, x, y, scalars, [] TREACLE_HD(double sum, KrylovScalars& s) { s.setStep(sum); });
}

/// One number of z + beta p.
TREACLE_HD inline double nextDirection(double z, double p, const KrylovScalars& s) {
  return s.iteration == 0 ? z : z + s.beta * p;
}

template <class Backend>
void direction(Context<Backend>& context, std::span<const double> z, std::span<double> p,
               const KrylovScalars* scalars, bool single) {
  if (single)
    return forEachNumber(context, z.size(), scalars, [=] TREACLE_HD(std::size_t i, const KrylovScalars& s) {
      p[i] = static_cast<float>(nextDirection(z[i], p[i], s));
    });
  forEachNumber(context, z.size(), scalars,
                [=] TREACLE_HD(std::size_t i, const KrylovScalars& s) { p[i] = nextDirection(z[i], p[i], s); });
}

template <class Backend>
void directionsCr(Context<Backend>& context, const CrDirections& v, const KrylovScalars* scalars) {
  forEachNumber(context, v.s.size(), scalars, [=] TREACLE_HD(std::size_t i, const KrylovScalars& s) {
    v.p[i] = nextDirection(v.s[i], v.p[i], s);
    v.q[i] = nextDirection(v.y[i], v.q[i], s);
  });
}

template <class Backend>
void updateSolution(Context<Backend>& context, const KrylovVectors& v, KrylovScalars* scalars) {
  reduceNumbers(
      context, v.x.size(), scalars,
      [=] TREACLE_HD(std::size_t i, const KrylovScalars& s) {
        v.x[i] += s.alpha * v.p[i];
        if (!v.s.empty()) v.s[i] -= s.alpha * v.u[i];
        const double ri = v.r[i] - s.alpha * v.q[i];
        v.r[i] = ri;
        return ri * ri;
      },
      [] TREACLE_HD(double rr, KrylovScalars& s) { s.endIteration(rr); });
}

template <class Backend>
void widen(Context<Backend>& context, std::span<const float> from, std::span<double> to) {
  forEach(context, from.size(), [=] TREACLE_HD(std::size_t i) { to[i] = from[i]; });
}

/// The matrix travels as an argument of the kernel: nobody waits.
template <class Backend>
void setInverse(Context<Backend>& context, const ModeMatrix& inverse, DeflationScalars* to) {
  forEach(context, 1, [=] TREACLE_HD(std::size_t) { to->inverse = inverse; });
}

template <class Backend>
void recordedDirection(Context<Backend>& context, std::span<const double> r, std::span<const double> z,
                       std::span<double> p, KrylovScalars* krylov, DeflationScalars* scalars,
                       std::span<float> basis) {
  dotProduct(context, r, z, krylov, [=] TREACLE_HD(double sum, KrylovScalars& s) {
    s.setDirection(sum);
    scalars->record(s);
  });
  forEachNumber(context, z.size(), krylov, [=] TREACLE_HD(std::size_t i, const KrylovScalars& s) {
    const int k = s.iteration;
    p[i] = nextDirection(z[i], p[i], s);
    if (!basis.empty() && k < DeflationScalars::maxBasis)
      basis[k * z.size() + i] = static_cast<float>((k % 2 ? -1 : 1) / std::sqrt(s.rho) * z[i]);
  });
}

template <class T, class Backend>
void lanczosStart(Context<Backend>& context, const LanczosVectors<T>& v) {
  // Alone, all particles are the own ones.
  const HaloCounts counts =
      context.halo ? *context.halo : HaloCounts{.fluid = static_cast<std::uint32_t>(v.r.size())};
  // Products on the CPU do not set that of ghosts.
  if (std::is_same_v<Backend, Cpu> && context.halo) clearValues(context, v.q);
  reduceInOrder(
      context, v.r.size(), v.scalars,
      [=] TREACLE_HD(std::size_t i, const LanczosScalars&) {
        const T inverse = v.inverseDiagonal[i];
        const auto seed = static_cast<std::uint32_t>(counts.indexOfAll(static_cast<std::uint32_t>(i)));
        const T ri = inverse > 0 ? pseudoRandom(seed) * std::sqrt(1 / inverse) : T(0), pi = inverse * ri;
        v.r[i] = ri;
        v.p[i] = pi;
        return double(ri) * double(pi);
      },
      [] TREACLE_HD(double rho, LanczosScalars& s) {
        constexpr double epsilon = std::numeric_limits<T>::epsilon();
        s.start(rho, epsilon);
      });
}

template <class T, class Backend>
void lanczosStep(Context<Backend>& context, const LanczosVectors<T>& v) {
  reduceInOrder(
      context, v.p.size(), v.scalars,
      [=] TREACLE_HD(std::size_t i, const LanczosScalars&) { return double(v.p[i]) * double(v.q[i]); },
      [] TREACLE_HD(double sigma, LanczosScalars& s) { s.setStep(sigma); });
}

template <class T, class Backend>
void lanczosDirection(Context<Backend>& context, const LanczosVectors<T>& v) {
  reduceInOrder(
      context, v.r.size(), v.scalars,
      [=] TREACLE_HD(std::size_t i, const LanczosScalars& s) {
        const T ri = v.r[i] - static_cast<T>(s.alpha) * v.q[i];
        v.r[i] = ri;
        return double(ri) * double(ri) * double(v.inverseDiagonal[i]);
      },
      [] TREACLE_HD(double rho, LanczosScalars& s) { s.setDirection(rho); });
  forEachNumber(context, v.p.size(), v.scalars, [=] TREACLE_HD(std::size_t i, const LanczosScalars& s) {
    v.p[i] = v.inverseDiagonal[i] * v.r[i] + static_cast<T>(s.beta) * v.p[i];
  });
}

template <class T, class Backend>
void setNumber(Context<Backend>& context, T value, T* to) {
  forEach(context, 1, [=] TREACLE_HD(std::size_t) { *to = value; });
}

#define TREACLE_EACH_NUMBER(Backend)                                                                           \
  template void residual(Context<Backend>&, std::span<const double>, std::span<double>, KrylovScalars*);       \
  template void directionDot(Context<Backend>&, std::span<const double>, std::span<const double>,              \
                             KrylovScalars*);                                                                  \
  template void stepDot(Context<Backend>&, std::span<const double>, std::span<const double>, KrylovScalars*);  \
  template void direction(Context<Backend>&, std::span<const double>, std::span<double>, const KrylovScalars*, \
                          bool);                                                                               \
  template void directionsCr(Context<Backend>&, const CrDirections&, const KrylovScalars*);                    \
  template void updateSolution(Context<Backend>&, const KrylovVectors&, KrylovScalars*);                       \
  template void widen(Context<Backend>&, std::span<const float>, std::span<double>);                           \
  template void setInverse(Context<Backend>&, const ModeMatrix&, DeflationScalars*);                           \
  template void recordedDirection(Context<Backend>&, std::span<const double>, std::span<const double>,         \
                                  std::span<double>, KrylovScalars*, DeflationScalars*, std::span<float>);     \
  TREACLE_EACH_OF(double, Backend)                                                                             \
  TREACLE_EACH_OF(float, Backend)
#define TREACLE_EACH_OF(T, Backend)                                                  \
  template void lanczosStart(Context<Backend>&, const LanczosVectors<T>&);           \
  template void lanczosStep(Context<Backend>&, const LanczosVectors<T>&);            \
  template void lanczosDirection(Context<Backend>&, const LanczosVectors<T>&);       \
  template void lanczosFinish(Context<Backend>&, const LanczosScalars*, double, T*); \
  template void setNumber(Context<Backend>&, T, T*);

}  // namespace treacle
