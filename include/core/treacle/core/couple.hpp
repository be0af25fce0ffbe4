#pragma once

#include "treacle/core/macros.hpp"
#include "treacle/core/vec.hpp"

namespace treacle {

/// In how many planes a body can turn.
template <int D>
inline constexpr int planesOf = D == 2 ? 1 : 3;

/// Adds share d x f, in two dimensions its component along z.
template <int D, class T>
TREACLE_HD void addCouple(const T& share, const Vec<D, T>& d, const Vec<D, T>& f, T* sum) {
  for (int k = 0; k < planesOf<D>; ++k) {
    const int a = D == 2 ? 0 : (k + 1) % 3, b = D == 2 ? 1 : (k + 2) % 3;
    sum[k] += share * (d[a] * f[b] - d[b] * f[a]);
  }
}

/// What such a sum is.
template <int D>
TREACLE_HD Vec<3> coupleOf(const double* sum) {
  if constexpr (D == 2)
    return {0, 0, sum[0]};
  else
    return {sum[0], sum[1], sum[2]};
}

}  // namespace treacle
