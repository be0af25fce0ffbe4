#pragma once

#include "treacle/core/macros.hpp"

namespace treacle {

/// Step i = 1, 2, … of the fourth-kind Chebyshev smoother: z = previous z + gain / lambdaMax D^-1 residual, x +=
/// z, lambdaMax bounding the eigenvalues of D^-1 A.
template <class T>
struct ChebyshevStep {
  T previous, gain;

  TREACLE_HD static constexpr ChebyshevStep at(int i) {
    return {i == 1 ? T(0) : T(2 * i - 3) / T(2 * i + 1), T(8 * i - 4) / T(2 * i + 1)};
  }
};

}  // namespace treacle
