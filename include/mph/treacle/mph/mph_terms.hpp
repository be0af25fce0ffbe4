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

/// The scheme of a case, chosen while the program runs.
struct CaseScheme {
  SchemeKind kind;
};
/// A scheme that the compiler knows, for loops that a choice pair by pair would slow down, and whose roundings
/// depend on what else they could compute.
template <SchemeKind Kind>
struct KnownScheme {
  static constexpr SchemeKind kind = Kind;
};
using PublishedScheme = KnownScheme<SchemeKind::Published>;
using AccurateScheme = KnownScheme<SchemeKind::Accurate>;

/// What a pair of particles does in MPH-I, d = x_j - x_i and r = |d|, e = d/r:
///   number density   n_i = sum of density, whose radius may be larger           [K23 eq. (7)]
///   pressures        -e w'^p = gradient d: the elements of C                   [K23 eqs. (4), (14)]
///   viscosity        2 (D+2) mu e e^T (-w'^v) / r = mu viscous d d^T: a block of V   [K23 eqs. (4), (16)]
///   repulsion        -mu viscous d d^T v, v = [r_0 - r]_+ e / dt: not of [K23], see docs/solver.md
/// with the weights of the scheme in place of w^p and -w'^v. These formulas stand nowhere else; a loop calls them
/// in its own arithmetic. A `...Shape` lacks the factor of the same name, for loops that multiply their sums by it
/// in the end. All are zero from their radius on. T is the precision of the constants; lengths are in whatever
/// unit they were made for. Scheme: CaseScheme, or a known one.
template <int D, class T = double, class Scheme = CaseScheme>
struct MphTerms {
  T pressureRadius, inversePressureRadius;    // h_p, 1/h_p
  T viscosityRadius, inverseViscosityRadius;  // h_v, 1/h_v
  T densityRadius;                            // h_n
  T densityFactor, gradientFactor, viscousFactor;
  Scheme scheme;
  T repulsionRadius = 0;  // r_0; 0: no repulsion
  WeightShape densityShape = WeightShape::Published;

  /// For the radii h_p, h_v and the spacing l [m]; lengths in metres. Densities have the weight of [K23], or
  /// another one by setDensityWeight().
  static MphTerms make(SchemeKind scheme, double pressureRadius, double viscosityRadius, double spacing) {
    const double hp = pressureRadius, hv = viscosityRadius;
    const auto pressure = Weight<D>::make(hp, spacing, gradientWeight(scheme));
    const auto density = Weight<D>::make(hp, spacing, WeightShape::Published);
    const auto viscosity = Weight<D>::make(hv, spacing, WeightShape::Published);
    return {static_cast<T>(hp),
            static_cast<T>(1 / hp),
            static_cast<T>(hv),
            static_cast<T>(1 / hv),
            static_cast<T>(hp),
            static_cast<T>(density.scale),
            static_cast<T>(2 * pressure.scale / hp),
            static_cast<T>(viscosityFactor(scheme) * 4 * (D + 2) * viscosity.scale / hv),
            {scheme}};
  }
  /// The same for lengths in another unit [m]. Pair blocks d d^T and gradients d are still those per metre.
  template <class U>
  MphTerms<D, U, Scheme> inUnitsOf(double unit) const {
    return {static_cast<U>(pressureRadius / unit),
            static_cast<U>(inversePressureRadius * unit),
            static_cast<U>(viscosityRadius / unit),
            static_cast<U>(inverseViscosityRadius * unit),
            static_cast<U>(densityRadius / unit),
            static_cast<U>(densityFactor),
            static_cast<U>(gradientFactor),
            static_cast<U>(viscousFactor / unit),
            scheme,
            static_cast<U>(repulsionRadius / unit),
            densityShape};
  }
  /// The same with their scheme known.
  template <class Known>
  MphTerms<D, T, Known> with(Known known) const {
    return {pressureRadius, inversePressureRadius, viscosityRadius, inverseViscosityRadius,
            densityRadius,  densityFactor,         gradientFactor,  viscousFactor,
            known,          repulsionRadius,       densityShape};
  }
  /// Another weight of densities; lengths in metres.
  void setDensityWeight(const Weight<D>& density) {
    densityRadius = static_cast<T>(density.radius);
    densityFactor = static_cast<T>(density.scale);
    densityShape = density.shape;
  }

  /// w
  template <class Factor, class Distance>
  TREACLE_HD auto density(Factor factor, const Distance& r) const {
    if (densityShape == WeightShape::DensityWindow)
      return factor * DensityWindow::at(positivePart(T(1) - r.square / (densityRadius * densityRadius)));
    const auto part = positivePart(T(1) - T(1) / (r.inverse * densityRadius));
    if (densityShape == WeightShape::Published) return factor * part * part;
    const auto q = T(1) - part, square = part * part;
    return factor * square * square * (T(1) + T(4) * q);
  }
  /// What is to be multiplied by d, and by densityFactor, to give the openness of a place: [1-q^2]_+^3 / l.
  template <class Distance>
  TREACLE_HD auto openness(const Distance& r) const {
    const auto part = positivePart(T(1) - r.square * (T(1) / (densityRadius * densityRadius)));
    return part * part * part;
  }
  /// -w' / r of the window.
  template <class Distance>
  TREACLE_HD auto densityGradient(const Distance& r) const {
    const T square = densityRadius * densityRadius;
    return (2 * densityFactor / square) * DensityWindow::slope<T>(positivePart(T(1) - r.square * (T(1) / square)));
  }
  /// -w' / r: factor times (1/r - 1/h_p), or 1/h_p times the slope of the window.
  template <class Distance>
  TREACLE_HD auto gradientShape(const Distance& r) const {
    if (scheme.kind == SchemeKind::Published) return positivePart(r.inverse - inversePressureRadius);
    const T inverseSquare = inversePressureRadius * inversePressureRadius;
    return inversePressureRadius * GradientWindow::slope<T>(positivePart(T(1) - r.square * inverseSquare));
  }
  template <class Distance>
  TREACLE_HD auto gradient(const Distance& r) const {
    return gradientFactor * gradientShape(r);
  }
  /// What a pair resists along e, viscous r^2: factor times (1/r - 1/h_v) or q (1-q)^2/h_v
  template <class Distance>
  TREACLE_HD auto resistanceShape(const Distance& r) const {
    if (scheme.kind == SchemeKind::Published) return positivePart(r.inverse - inverseViscosityRadius);
    const auto q = r.square * r.inverse * inverseViscosityRadius, s = positivePart(T(1) - q);
    return inverseViscosityRadius * q * s * s;
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
  /// What keeps close particles apart: times viscousFactor, mu, d and a rate 1/t the viscous force of a pair that
  /// parts to r_0 within t, (r_0 - r) / t being the velocity along e.
  template <class Distance>
  TREACLE_HD auto repulsionShape(const Distance& r) const {
    return resistanceShape(r) * positivePart(repulsionRadius * r.inverse - T(1));
  }

 private:
  /// So that sums over a full neighbourhood give the same viscosity as with the weight of [K23].
  static double viscosityFactor(SchemeKind scheme) {
    return scheme == SchemeKind::Published ? 1 : D == 2 ? 35.0 / 4 : 42.0 / 5;
  }
};

/// f(terms), whose scheme the compiler knows.
template <int D, class F>
void withScheme(const MphTerms<D>& terms, F&& f) {
  terms.scheme.kind == SchemeKind::Published ? f(terms.with(PublishedScheme{})) : f(terms.with(AccurateScheme{}));
}

}  // namespace treacle
