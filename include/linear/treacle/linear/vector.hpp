#pragma once

#include "treacle/core/backend.hpp"
#include "treacle/linear/krylov_scalars.hpp"

#include <functional>
#include <span>

namespace treacle {

/// y = A x, or z = K r, for vectors in the backend's memory.
using Product = std::function<void(std::span<const double>, std::span<double>)>;

/// The vector operations that a Krylov loop consists of. All spans have the same length; `scalars` and the spans
/// are in the backend's memory. Sums have a fixed order: they do not depend on the number of threads.

void copy(Context<Cpu>&, std::span<const double> from, std::span<double> to);
void copy(Context<Cuda>&, std::span<const double> from, std::span<double> to);

/// r = b - r, and scalars.start(b.b, r.r)
void residual(Context<Cpu>&, std::span<const double> b, std::span<double> r, KrylovScalars* scalars);
void residual(Context<Cuda>&, std::span<const double> b, std::span<double> r, KrylovScalars* scalars);

/// scalars.setDirection(x.y): beta
void directionDot(Context<Cpu>&, std::span<const double> x, std::span<const double> y, KrylovScalars* scalars);
void directionDot(Context<Cuda>&, std::span<const double> x, std::span<const double> y, KrylovScalars* scalars);

/// scalars.setStep(x.y): alpha
void stepDot(Context<Cpu>&, std::span<const double> x, std::span<const double> y, KrylovScalars* scalars);
void stepDot(Context<Cuda>&, std::span<const double> x, std::span<const double> y, KrylovScalars* scalars);

/// p = z + beta p, in the first iteration p = z; where `single`, rounded to numbers in single precision; 3 vectors
/// of traffic
void direction(Context<Cpu>&, std::span<const double> z, std::span<double> p, const KrylovScalars* scalars,
               bool single = false);
void direction(Context<Cuda>&, std::span<const double> z, std::span<double> p, const KrylovScalars* scalars,
               bool single = false);

/// p = s + beta p, q = y + beta q, likewise; 6 vectors of traffic
struct CrDirections {
  std::span<const double> s, y;
  std::span<double> p, q;
};
void directionsCr(Context<Cpu>&, const CrDirections& v, const KrylovScalars* scalars);
void directionsCr(Context<Cuda>&, const CrDirections& v, const KrylovScalars* scalars);

/// x += alpha p, r -= alpha q, and scalars.endIteration(r.r); 6 vectors of traffic
struct CgVectors {
  std::span<const double> p, q;
  std::span<double> x, r;
};
void updateCg(Context<Cpu>&, const CgVectors& v, KrylovScalars* scalars);
void updateCg(Context<Cuda>&, const CgVectors& v, KrylovScalars* scalars);

/// x += alpha p, r -= alpha q, s -= alpha u, and scalars.endIteration(r.r); 9 vectors of traffic
struct CrVectors {
  std::span<const double> p, q, u;
  std::span<double> x, r, s;
};
void updateCr(Context<Cpu>&, const CrVectors& v, KrylovScalars* scalars);
void updateCr(Context<Cuda>&, const CrVectors& v, KrylovScalars* scalars);

}  // namespace treacle
