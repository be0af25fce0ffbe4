#pragma once

#include "treacle/core/copy_values.hpp"
#include "treacle/linear/krylov_scalars.hpp"

#include <functional>
#include <span>

namespace treacle {

/// y = A x, or z = K r, for vectors in the backend's memory.
using Product = std::function<void(std::span<const double>, std::span<double>)>;

/// The vector operations that a Krylov loop consists of. All spans have the same length; `scalars` and the spans
/// are in the backend's memory. Sums have a fixed order: they do not depend on the number of threads.

template <class Backend>
void copy(Context<Backend>& context, std::span<const double> from, std::span<double> to) {
  copyValues(context, from, to.data());
}

/// r = b - r, and scalars.start(b.b, r.r)
template <class Backend>
void residual(Context<Backend>&, std::span<const double> b, std::span<double> r, KrylovScalars* scalars);

/// scalars.setDirection(x.y): beta
template <class Backend>
void directionDot(Context<Backend>&, std::span<const double> x, std::span<const double> y, KrylovScalars* scalars);

/// scalars.setStep(x.y): alpha
template <class Backend>
void stepDot(Context<Backend>&, std::span<const double> x, std::span<const double> y, KrylovScalars* scalars);

/// p = z + beta p, in the first iteration p = z; where `single`, rounded to numbers in single precision; 3 vectors
/// of traffic
template <class Backend>
void direction(Context<Backend>&, std::span<const double> z, std::span<double> p, const KrylovScalars* scalars,
               bool single = false);

/// p = s + beta p, q = y + beta q, likewise; 6 vectors of traffic
struct CrDirections {
  std::span<const double> s, y;
  std::span<double> p, q;
};
template <class Backend>
void directionsCr(Context<Backend>&, const CrDirections& v, const KrylovScalars* scalars);

/// x += alpha p, r -= alpha q, where they are given s -= alpha u, and scalars.endIteration(r.r); 6 vectors of
/// traffic, with s and u 9
struct KrylovVectors {
  std::span<const double> p, q;
  std::span<double> x, r;
  std::span<const double> u{};
  std::span<double> s{};
};
template <class Backend>
void updateSolution(Context<Backend>&, const KrylovVectors& v, KrylovScalars* scalars);

}  // namespace treacle
