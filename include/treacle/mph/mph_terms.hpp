#pragma once

#include "treacle/core/arithmetic.hpp"
#include "treacle/core/macros.hpp"
#include "treacle/core/vec.hpp"
#include "treacle/mph/weight.hpp"

namespace treacle {

/// Distance of two particles as a loop has it at hand: Real is double, float or Lanes.
template <class Real>
struct PairDistance {
  Real square;   // r^2
  Real inverse;  // 1/r

  /// x / r^2
  TREACLE_HD Real overSquare(Real x) const { return x * inverse * inverse; }
};

/// The same in loops that are run once and need not be fast.
struct ExactDistance {
  double square, inverse;

  TREACLE_HD explicit ExactDistance(double r2) : square(r2), inverse(inverseSqrt(r2)) {}
  TREACLE_HD double overSquare(double x) const { return x / square; }
};

/// What a pair of particles does in MPH-I, d = x_j - x_i and r = |d|, e = d/r:
///   number density   n_i = sum of density                                      [K23 eq. (7)]
///   pressures        -e w'^p = gradient d: the elements of C                   [K23 eqs. (4), (14)]
///   viscosity        2 (D+2) mu e e^T (-w'^v) / r = mu viscous d d^T: a block of V   [K23 eqs. (4), (16)]
/// These formulas stand nowhere else; a loop calls them in its own arithmetic. A `...Shape` lacks the factor of
/// the same name, for loops that multiply their sums by it in the end. All are zero from their radius on. T is the
/// precision of the constants; lengths are in whatever unit they were made for.
template <int D, class T = double>
struct MphTerms {
  T pressureRadius, inversePressureRadius;    // h_p, 1/h_p
  T viscosityRadius, inverseViscosityRadius;  // h_v, 1/h_v
  T densityFactor, gradientFactor, viscousFactor;

  /// Weights of the radii h_p and h_v [m]; lengths in metres.
  static MphTerms make(const Weight<D>& pressure, const Weight<D>& viscosity) {
    return {static_cast<T>(pressure.radius),
            static_cast<T>(1 / pressure.radius),
            static_cast<T>(viscosity.radius),
            static_cast<T>(1 / viscosity.radius),
            static_cast<T>(pressure.scale),
            static_cast<T>(2 * pressure.scale / pressure.radius),
            static_cast<T>(4 * (D + 2) * viscosity.scale / viscosity.radius)};
  }
  /// The same for lengths in another unit [m]. Pair blocks d d^T and gradients d are still those per metre.
  template <class U>
  MphTerms<D, U> inUnitsOf(double unit) const {
    return {static_cast<U>(pressureRadius / unit),  static_cast<U>(inversePressureRadius * unit),
            static_cast<U>(viscosityRadius / unit), static_cast<U>(inverseViscosityRadius * unit),
            static_cast<U>(densityFactor),          static_cast<U>(gradientFactor),
            static_cast<U>(viscousFactor / unit)};
  }

  /// w = factor (1 - r/h_p)^2
  template <class Factor, class Distance>
  TREACLE_HD auto density(Factor factor, const Distance& r) const {
    const auto part = positivePart(T(1) - T(1) / (r.inverse * pressureRadius));
    return factor * part * part;
  }
  /// -w' / r = factor (1/r - 1/h_p)
  template <class Distance>
  TREACLE_HD auto gradientShape(const Distance& r) const {
    return positivePart(r.inverse - inversePressureRadius);
  }
  template <class Distance>
  TREACLE_HD auto gradient(const Distance& r) const {
    return gradientFactor * gradientShape(r);
  }
  /// What a pair resists along e, viscous r^2 = factor (1/r - 1/h_v)
  template <class Distance>
  TREACLE_HD auto resistanceShape(const Distance& r) const {
    return positivePart(r.inverse - inverseViscosityRadius);
  }
  /// The pair's coefficient of d d^T, with what is to be multiplied by it.
  template <class Factor, class Distance>
  TREACLE_HD auto viscous(Factor factor, const Distance& r) const {
    return r.overSquare(factor * resistanceShape(r));
  }
  template <class Distance>
  TREACLE_HD auto viscousShape(const Distance& r) const {
    return r.overSquare(resistanceShape(r));
  }
};

}  // namespace treacle
