#pragma once

#include "treacle/core/cuda.hpp"
#include "treacle/core/symmetric_block.hpp"

#include <cmath>

namespace treacle {

namespace detail {

/// One Jacobi rotation: m(p, q) becomes zero; v's columns p and q turn along. `o` is the third axis.
template <int p, int q, int o>
TREACLE_HD inline void rotate(double (&m)[3][3], double (&v)[3][3]) {
  const double off = m[p][q], apart = m[q][q] - m[p][p];
  const double length = std::fabs(apart) + std::sqrt(apart * apart + 4 * off * off);
  // tan of the lesser angle of the two that do
  const double t = length > 0 ? (apart < 0 ? -2 : 2) * off / length : 0.0;
  const double c = 1 / std::sqrt(t * t + 1), s = t * c;
  m[p][p] -= t * off;
  m[q][q] += t * off;
  m[p][q] = m[q][p] = 0;
  const double mp = m[o][p], mq = m[o][q];
  m[o][p] = m[p][o] = c * mp - s * mq;
  m[o][q] = m[q][o] = s * mp + c * mq;
  for (int k = 0; k < 3; ++k) {
    const double vp = v[k][p], vq = v[k][q];
    v[k][p] = c * vp - s * vq;
    v[k][q] = s * vp + c * vq;
  }
}

}  // namespace detail

/// The inverse of a symmetric matrix whose eigenvalues m_k count as at least `floor`: sum_k v_k v_k^T / a_k with
/// a_k = max(m_k, floor). `atMostOne` multiplies it with the least a_k where that is below 1, so that none of its
/// own eigenvalues is above 1.
TREACLE_HD inline SymmetricBlock<2> flooredInverse(const SymmetricBlock<2>& matrix, double floor, bool atMostOne) {
  const double mean = 0.5 * (matrix.a[0] + matrix.a[2]), half = 0.5 * (matrix.a[0] - matrix.a[2]);
  const double off = matrix.a[1], radius = std::sqrt(half * half + off * off);  // eigenvalues: mean +- radius
  const double more = std::fmax(mean + radius, floor), less = std::fmax(mean - radius, floor);
  const double scale = atMostOne ? std::fmin(1.0, less) : 1.0, byLess = scale / less, byMore = scale / more;
  // The mean of both plus half their difference times (M - mean) / radius, whose eigenvalues are +-1.
  const double middle = 0.5 * (byMore + byLess), part = radius > 0 ? 0.5 * (byMore - byLess) / radius : 0.0;
  return {{middle + part * half, part * off, middle - part * half}};
}
TREACLE_HD inline SymmetricBlock<3> flooredInverse(const SymmetricBlock<3>& matrix, double floor, bool atMostOne) {
  if (!atMostOne && isAbove(matrix, floor)) return inverse(matrix);
  // Jacobi's method doubles the valid digits with every sweep; after five, nothing is left to do.
  constexpr int sweeps = 5;
  const double* a = matrix.a;
  double m[3][3] = {{a[0], a[1], a[2]}, {a[1], a[3], a[4]}, {a[2], a[4], a[5]}};
  double v[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    detail::rotate<0, 1, 2>(m, v);
    detail::rotate<0, 2, 1>(m, v);
    detail::rotate<1, 2, 0>(m, v);
  }
  const double value[3] = {std::fmax(m[0][0], floor), std::fmax(m[1][1], floor), std::fmax(m[2][2], floor)};
  const double least = std::fmin(value[0], std::fmin(value[1], value[2]));
  const double scale = atMostOne ? std::fmin(1.0, least) : 1.0;
  SymmetricBlock<3> b{};
  for (int k = 0; k < 3; ++k) b.addOuter(scale / value[k], {v[0][k], v[1][k], v[2][k]});
  return b;
}

}  // namespace treacle
