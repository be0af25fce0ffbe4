#pragma once

#include "treacle/core/backend.hpp"

#include <span>

namespace treacle {

/// The vector operations that a Krylov loop consists of. All spans have the same length. Sums have a fixed order:
/// they do not depend on the number of threads.

double dot(Context<Cpu>&, std::span<const double> x, std::span<const double> y);
void copy(Context<Cpu>&, std::span<const double> from, std::span<double> to);
/// r = b - r; returns r.r
double residual(Context<Cpu>&, std::span<const double> b, std::span<double> r);
/// p = z + beta p
void direction(Context<Cpu>&, std::span<const double> z, double beta, std::span<double> p);

/// One conjugate-gradient update; 6 vectors of traffic: x += alpha p, r -= alpha q; returns r.r
struct CgVectors {
  std::span<const double> p, q;
  std::span<double> x, r;
};
double updateCg(Context<Cpu>&, double alpha, const CgVectors& v);

/// One conjugate-residual update; 9 vectors of traffic: x += alpha p, r -= alpha q, s -= alpha u; returns r.r
struct CrVectors {
  std::span<const double> p, q, u;
  std::span<double> x, r, s;
};
double updateCr(Context<Cpu>&, double alpha, const CrVectors& v);

/// p = s + beta p, q = y + beta q; 6 vectors of traffic
struct CrDirections {
  std::span<const double> s, y;
  std::span<double> p, q;
};
void directionsCr(Context<Cpu>&, double beta, const CrDirections& v);

}  // namespace treacle
