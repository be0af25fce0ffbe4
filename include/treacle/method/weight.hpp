#pragma once

#include "treacle/core/macros.hpp"
#include "treacle/core/vec.hpp"

#include <cmath>
#include <numbers>

namespace treacle {

/// Weight function w(r) = l^d / (S h^d) (1 - r/h)^2 of [K23 eq. (3)], with the particle volume l^d inside, so that
/// the sum over a full neighbourhood is about 1.
template <int D>
struct Weight {
  double radius;  // h [m]
  double scale;   // l^d / (S h^d) [-]

  static Weight make(double radius, double spacing) {
    const double integral = D == 2 ? std::numbers::pi / 6 : 2 * std::numbers::pi / 15;  // S
    return {radius, std::pow(spacing / radius, D) / integral};
  }

  TREACLE_HD double value(double r) const {
    const double s = 1 - r / radius;
    return s > 0 ? scale * s * s : 0;
  }
  /// dw/dr [1/m], <= 0 [K23 eq. (5)]
  TREACLE_HD double derivative(double r) const {
    const double s = 1 - r / radius;
    return s > 0 ? -2 * scale / radius * s : 0;
  }
};

/// Sum of f(r) over the other points of a full cubic lattice within `radius`, r their distance [m].
template <int D, class F>
double latticeSum(double radius, double spacing, F&& f) {
  const int reach = static_cast<int>(std::ceil(radius / spacing));
  double sum = 0;
  for (int z = D == 3 ? -reach : 0; z <= (D == 3 ? reach : 0); ++z)
    for (int y = -reach; y <= reach; ++y)
      for (int x = -reach; x <= reach; ++x)
        if (x != 0 || y != 0 || z != 0) sum += f(spacing * std::sqrt(double(x * x + y * y + z * z)));
  return sum;
}

/// n_0 of [K23 eq. (7)]: the number density in a full cubic lattice of the given spacing.
template <int D>
double latticeNumberDensity(const Weight<D>& weight, double spacing) {
  return latticeSum<D>(weight.radius, spacing, [&](double r) { return weight.value(r); });
}

/// Pair terms of the momentum equation [K23 eq. (4)] for d = x_j - x_i, in the form the sums need: functions of
/// 1/r times d, since e w'(r) = -2 scale/h (1/r - 1/h) d needs no unit vector.
struct PairTerm {
  double inverseRadius;  // 1/h [1/m]
  double factor;

  /// -e w' = pressure.factor (1/r - 1/h) d for r < h [1/m].
  template <int D>
  static PairTerm pressure(const Weight<D>& w) {
    return {1 / w.radius, 2 * w.scale / w.radius};
  }
  /// Viscous block of a pair: mu_ij viscosity.factor (1/r - 1/h) / r^2 d d^T, from 2 (d+2) mu e e^T (-w')/r.
  template <int D>
  static PairTerm viscosity(const Weight<D>& w) {
    return {1 / w.radius, 4 * (D + 2) * w.scale / w.radius};
  }
};

}  // namespace treacle
