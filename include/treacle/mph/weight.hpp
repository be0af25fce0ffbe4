#pragma once

#include "treacle/core/macros.hpp"
#include "treacle/core/vec.hpp"
#include "treacle/model/lattice_sum.hpp"

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

/// n_0 of [K23 eq. (7)]: the number density in a full cubic lattice of the given spacing.
template <int D>
double latticeNumberDensity(const Weight<D>& weight, double spacing) {
  return latticeSum<D>(weight.radius, spacing, [&](double r) { return weight.value(r); });
}

}  // namespace treacle
