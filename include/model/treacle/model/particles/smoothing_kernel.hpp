#pragma once

#include "treacle/core/arithmetic.hpp"
#include "treacle/core/macros.hpp"
#include "treacle/core/vec.hpp"
#include "treacle/model/case/case.hpp"

#include <cmath>
#include <numbers>

namespace treacle {

/// A distance and its inverse [m, 1/m]; of a particle to itself both are zero.
struct Distance {
  double r, inverse;

  TREACLE_HD Distance(double distance) : r(distance), inverse(distance > 0 ? 1 / distance : 0) {}
  template <int D>
  TREACLE_HD explicit Distance(const Vec<D>& d) {
    const double r2 = norm2(d);
    inverse = r2 > 0 ? inverseSqrt(r2) : 0;
    r = r2 * inverse;
  }
};

/// Smoothing function W(r, h) of SPH, zero from r = 2 h on [O23 eq. (3)].
template <int D>
struct SmoothingKernel {
  KernelKind kind;
  double inverseLength;  // 1/h [1/m]
  double scale;          // [1/m^D]

  static SmoothingKernel make(KernelKind kind, double h) {
    constexpr double pi = std::numbers::pi;
    const double unit = kind == KernelKind::CubicSpline ? (D == 2 ? 10 / (7 * pi) : 1 / pi)
                                                        : (D == 2 ? 7 / (4 * pi) : 21 / (16 * pi));
    return {kind, 1 / h, unit / std::pow(h, D)};
  }

  TREACLE_HD double radius() const { return 2 / inverseLength; }  // [m]

  TREACLE_HD double value(double r) const {
    const double q = r * inverseLength, rest = q < 2 ? 2 - q : 0;
    if (kind == KernelKind::WendlandC2) {
      const double s = rest / 2;
      return scale * s * s * s * s * (2 * q + 1);
    }
    const double inner = q < 1 ? 1 - q : 0;
    return scale * (0.25 * rest * rest * rest - inner * inner * inner);
  }

  /// -W'(r) / r [1/m^(D+2)], >= 0: grad_i W = slope (x_j - x_i).
  TREACLE_HD double slope(const Distance& d) const {
    const double q = d.r * inverseLength, rest = q < 2 ? 2 - q : 0;
    const double perLength2 = scale * inverseLength * inverseLength;
    if (kind == KernelKind::WendlandC2) return perLength2 * 0.625 * rest * rest * rest;
    if (q < 1) return perLength2 * (3 - 2.25 * q);
    return scale * inverseLength * 0.75 * rest * rest * d.inverse;
  }
};

}  // namespace treacle
