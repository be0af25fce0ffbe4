#pragma once

#include "treacle/core/cuda.hpp"
#include "treacle/mph/mph_pairs.hpp"

#include <cmath>
#include <span>

namespace treacle {

/// A particle's viscosity is its share of sum_j c_ij (d . E d)^2, with its pairs' coefficients c_ij of d d^T over
/// mu. In a full neighbourhood the sum of c_ij r^4 is 2 D (D + 2); where neighbours are missing it is less.
/// Values above the most count as it: a particle next to few others is not to weigh each of them without bound.
inline constexpr double mostViscosityScale = 4;

/// What a particle's viscosity is multiplied by whose sum of c_ij r^4 over its neighbours is `moment`: 1 where
/// `correction` is 0, what makes up for the neighbours that are missing where it is 1.
template <int D>
TREACLE_HD double viscosityScaleOf(double moment, double correction) {
  const double exact = 2 * D * (D + 2);
  return 1 + correction * (exact / std::fmax(moment, exact / mostViscosityScale) - 1);
}

/// The scale of every fluid particle from its neighbours within h_v, walls among them. The viscosity of a pair is
/// multiplied by the mean of both scales, that of a pair with a wall by the fluid's. Ignores what scales the pairs
/// have.
template <int D, class Backend>
void viscosityScale(Context<Backend>&, const MphPairs<D>&, double correction, std::span<double> scale);

}  // namespace treacle
