#pragma once

#include "treacle/core/macros.hpp"
#include "treacle/core/vec.hpp"
#include "treacle/model/case/case.hpp"
#include "treacle/model/particles/lattice_sum.hpp"

#include <cmath>
#include <numbers>

namespace treacle {

/// Weight function w(r) = l^d / (S h^d) f(r/h) with the particle volume l^d inside, so that the sum over a full
/// neighbourhood is about 1: f = (1-q)^2 of [K23 eq. (3)], or Wendland's C2, (1-q)^4 (1+4q). S is the
/// integral of f over all space in units of h.
template <int D>
struct Weight {
  double radius;  // h [m]
  double scale;   // l^d / (S h^d) [-]
  SchemeKind scheme = SchemeKind::Published;

  static Weight make(double radius, double spacing, SchemeKind scheme = SchemeKind::Published) {
    return {radius, std::pow(spacing / radius, D) / integral(scheme), scheme};
  }

  TREACLE_HD double value(double r) const {
    const double q = r / radius, s = 1 - q;
    if (s <= 0) return 0;
    return scheme == SchemeKind::Published ? scale * s * s : scale * s * s * s * s * (1 + 4 * q);
  }
  /// k of -w'(r) = k scale/h g(q), g being 1-q or q (1-q)^3   [K23 eq. (5)]
  double slopeFactor() const { return scheme == SchemeKind::Published ? 2 : 20; }

 private:
  static double integral(SchemeKind scheme) {
    constexpr double pi = std::numbers::pi;
    if (scheme == SchemeKind::Published) return D == 2 ? pi / 6 : 2 * pi / 15;
    return D == 2 ? pi / 7 : 2 * pi / 21;
  }
};

/// From this part of the radius on, slopes are less than half a percent of the largest; 1 where they end abruptly.
inline double slopeReach(SchemeKind scheme) { return scheme == SchemeKind::Published ? 1 : 0.92; }

/// Weight of densities of fluid that keeps its volume: a window, whose transform is next to nothing for waves as
/// short as the spacing. Sums over it know how much fluid there is and not how its particles stand
/// (docs/accurate.md). It is that of Kaiser and Bessel [R. M. Lewitt, J. Opt. Soc. Am. A 7, 1990] of order 2 with
/// the taper 10, s I_2(10 sqrt(s)) / I_2(10), s = 1 - q^2, by a polynomial that is off by less than 0.0005.
struct DensityWindow {
  /// `s` not below zero.
  template <class Real>
  TREACLE_HD static Real at(const Real& s) {
    return s * s *
           (0.00663 +
            s * (0.02628 + s * (0.26834 + s * (-0.17536 + s * (0.99654 + s * (-0.56423 + s * 0.4418))))));
  }
  /// Its derivative by s.
  template <class Real>
  TREACLE_HD static Real slope(const Real& s) {
    return s *
           (2 * 0.00663 +
            s * (3 * 0.02628 + s * (4 * 0.26834 + s * (5 * -0.17536 +
                                                       s * (6 * 0.99654 + s * (7 * -0.56423 + s * 8 * 0.4418))))));
  }
  /// Its integral over all space, in units of h.
  template <int D>
  static double integral() {
    constexpr double pi = std::numbers::pi;
    double sum = 0;
    constexpr int steps = 2000;
    for (int k = 0; k < steps; ++k) {
      const double q = (k + 0.5) / steps;
      sum += at(1 - q * q) * (D == 2 ? 2 * pi * q : 4 * pi * q * q) / steps;
    }
    return sum;
  }
};

/// Weight of densities, with the particle volume inside: that of pressures with another radius, or the window.
template <int D>
struct DensityWeight : Weight<D> {
  bool isWindow = false;

  static DensityWeight make(double radius, double spacing, SchemeKind scheme) {
    return {Weight<D>::make(radius, spacing, scheme), false};
  }
  static DensityWeight window(double radius, double spacing) {
    return {{radius, std::pow(spacing / radius, D) / DensityWindow::integral<D>()}, true};
  }
  double value(double r) const {
    if (!isWindow) return Weight<D>::value(r);
    const double q = r / this->radius;
    return q < 1 ? this->scale * DensityWindow::at(1 - q * q) : 0;
  }
};

/// n_0 of [K23 eq. (7)]: the number density in a full cubic lattice of the given spacing.
template <int D>
double latticeNumberDensity(const DensityWeight<D>& weight, double spacing) {
  return latticeSum<D>(weight.radius, spacing, [&](double r) { return weight.value(r); });
}

}  // namespace treacle
