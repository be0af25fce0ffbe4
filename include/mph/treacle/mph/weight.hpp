#pragma once

#include "treacle/core/macros.hpp"
#include "treacle/core/vec.hpp"
#include "treacle/model/case/case.hpp"
#include "treacle/model/particles/lattice_sum.hpp"

#include <cmath>
#include <numbers>

namespace treacle {

/// s^2 (c0 + c1 s + ... + c6 s^6) with s = 1 - q^2, for weights whose transforms are next to nothing for waves as
/// short as the spacing. Sums over them know how much fluid there is and not how its particles stand
/// (docs/accurate.md). W has the coefficients.
template <class W>
struct WindowPolynomial {
  /// `s` not below zero.
  template <class Real>
  TREACLE_HD static Real at(const Real& s) {
    return s * s * (W::c0 + s * (W::c1 + s * (W::c2 + s * (W::c3 + s * (W::c4 + s * (W::c5 + s * W::c6))))));
  }
  /// Its derivative by s. T: the precision of the constants.
  template <class T, class Real>
  TREACLE_HD static Real slope(const Real& s) {
    return s * (T(2 * W::c0) +
                s * (T(3 * W::c1) +
                     s * (T(4 * W::c2) +
                          s * (T(5 * W::c3) + s * (T(6 * W::c4) + s * (T(7 * W::c5) + s * T(8 * W::c6)))))));
  }
  /// Its integral over all space, in units of h.
  template <int D>
  static double integral() {
    static const double whole = [] {
      constexpr double pi = std::numbers::pi;
      double sum = 0;
      constexpr int steps = 2000;
      for (int k = 0; k < steps; ++k) {
        const double q = (k + 0.5) / steps;
        sum += at(1 - q * q) * (D == 2 ? 2 * pi * q : 4 * pi * q * q) / steps;
      }
      return sum;
    }();
    return whole;
  }
};

/// For densities: the window of Kaiser and Bessel [R. M. Lewitt, J. Opt. Soc. Am. A 7, 1990] of order 2 with the
/// taper 10, s I_2(10 sqrt(s)) / I_2(10), to within 0.0005.
struct DensityWindow : WindowPolynomial<DensityWindow> {
  static constexpr double c0 = 0.00663, c1 = 0.02628, c2 = 0.26834, c3 = -0.17536, c4 = 0.99654, c5 = -0.56423,
                          c6 = 0.4418;
};

/// For gradients, whose radius is shorter: the window of Kaiser and Bessel of order 0 with the taper 5.25 and half
/// the radius, I_0(5.25 sqrt(1 - 4 q^2)) / I_0(5.25), folded with itself in three dimensions, to within 0.001.
/// The transform is a square, so that no wave of the particles gains by a uniform pressure.
struct GradientWindow : WindowPolynomial<GradientWindow> {
  static constexpr double c0 = 0.0432, c1 = -0.56093, c2 = 3.41387, c3 = -9.08117, c4 = 14.08256, c5 = -10.43717,
                          c6 = 3.5394;
};

/// f of a weight, q = r/h: (1-q)^2 of [K23 eq. (3)], Wendland's C2, (1-q)^4 (1+4q), or a window.
enum class WeightShape { Published, Wendland, DensityWindow, GradientWindow };

/// The weight whose slope divergences and pressure gradients have.
constexpr WeightShape gradientWeight(SchemeKind scheme) {
  return scheme == SchemeKind::Published ? WeightShape::Published : WeightShape::GradientWindow;
}

/// Weight function w(r) = l^d / (S h^d) f(r/h) with the particle volume l^d inside, so that the sum over a full
/// neighbourhood is about 1. S is the integral of f over all space in units of h.
template <int D>
struct Weight {
  double radius;  // h [m]
  double scale;   // l^d / (S h^d) [-]
  WeightShape shape;

  static Weight make(double radius, double spacing, WeightShape shape) {
    return {radius, std::pow(spacing / radius, D) / integral(shape), shape};
  }

  double value(double r) const {
    const double q = r / radius, p = 1 - q, s = 1 - q * q;
    if (p <= 0) return 0;
    switch (shape) {
      case WeightShape::Published:
        return scale * p * p;
      case WeightShape::Wendland:
        return scale * p * p * p * p * (1 + 4 * q);
      case WeightShape::DensityWindow:
        return scale * DensityWindow::at(s);
      case WeightShape::GradientWindow:
        return scale * GradientWindow::at(s);
    }
    return 0;
  }

 private:
  static double integral(WeightShape shape) {
    constexpr double pi = std::numbers::pi;
    switch (shape) {
      case WeightShape::Published:
        return D == 2 ? pi / 6 : 2 * pi / 15;
      case WeightShape::Wendland:
        return D == 2 ? pi / 7 : 2 * pi / 21;
      case WeightShape::DensityWindow:
        return DensityWindow::integral<D>();
      case WeightShape::GradientWindow:
        return GradientWindow::integral<D>();
    }
    return 0;
  }
};

/// From this part of the radius on, slopes are less than half a percent of the largest; 1 where they end abruptly.
inline double slopeReach(SchemeKind scheme) { return scheme == SchemeKind::Published ? 1 : 0.92; }

/// n_0 of [K23 eq. (7)]: the number density in a full cubic lattice of the given spacing.
template <int D>
double latticeNumberDensity(const Weight<D>& weight, double spacing) {
  return latticeSum<D>(weight.radius, spacing, [&](double r) { return weight.value(r); });
}

}  // namespace treacle
