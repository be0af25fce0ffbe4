#pragma once

#include "treacle/core/block.hpp"
#include "treacle/core/macros.hpp"
#include "treacle/core/vec.hpp"

namespace treacle {

/// Half the sum of c d d d d over the viscous pairs c d d^T of a fluid particle with others [Pa s], d = x_j - x_i:
/// from it follows the dissipation of any velocity field with a constant gradient G near the particle, c (d.G
/// d)^2. The tensor is symmetric: it is kept by how many of its four indices are y, and how many z.
template <int D>
inline constexpr int momentCount = D == 2 ? 5 : 15;

/// Place of the component with `y` indices 1 and `z` indices 2.
template <int D>
TREACLE_HD constexpr int momentPlace(int y, int z) {
  return D == 2 ? y : y + z * 5 - z * (z - 1) / 2;  // rows of 5, 4, 3, … for z = 0, 1, 2, …
}

template <int D, class T>
struct ViscousMoments {
  T m[momentCount<D>];

  TREACLE_HD constexpr T at(int a, int b, int c, int d) const {
    return m[momentPlace<D>((a == 1) + (b == 1) + (c == 1) + (d == 1), (a == 2) + (b == 2) + (c == 2) + (d == 2))];
  }

  /// What stands between the coefficients of two shape functions with the gradients p and q: the block
  /// sum_bc M_abcd p_b q_c.
  TREACLE_HD constexpr Block<D, T> between(const Vec<D, T>& p, const Vec<D, T>& q) const {
    Block<D, T> block{};
    for (int a = 0; a < D; ++a)
      for (int d = a; d < D; ++d) {
        T sum = 0;
        for (int b = 0; b < D; ++b) {
          sum += at(a, b, b, d) * p[b] * q[b];
          for (int c = b + 1; c < D; ++c) sum += at(a, b, c, d) * (p[b] * q[c] + p[c] * q[b]);
        }
        block(a, d) = block(d, a) = sum;
      }
    return block;
  }
};

/// Calls f(place, d_a d_b d_c d_d) for every component.
template <int D, class V, class F>
TREACLE_HD constexpr void forEachMoment(const V& d, F&& f) {
  const auto xx = d[0] * d[0], xy = d[0] * d[1], yy = d[1] * d[1];
  f(momentPlace<D>(0, 0), xx * xx);
  f(momentPlace<D>(1, 0), xx * xy);
  f(momentPlace<D>(2, 0), xx * yy);
  f(momentPlace<D>(3, 0), xy * yy);
  f(momentPlace<D>(4, 0), yy * yy);
  if constexpr (D == 3) {
    const auto xz = d[0] * d[2], yz = d[1] * d[2], zz = d[2] * d[2];
    f(momentPlace<D>(0, 1), xx * xz);
    f(momentPlace<D>(1, 1), xx * yz);
    f(momentPlace<D>(2, 1), xy * yz);
    f(momentPlace<D>(3, 1), yy * yz);
    f(momentPlace<D>(0, 2), xx * zz);
    f(momentPlace<D>(1, 2), xy * zz);
    f(momentPlace<D>(2, 2), yy * zz);
    f(momentPlace<D>(0, 3), xz * zz);
    f(momentPlace<D>(1, 3), yz * zz);
    f(momentPlace<D>(0, 4), zz * zz);
  }
}

}  // namespace treacle
