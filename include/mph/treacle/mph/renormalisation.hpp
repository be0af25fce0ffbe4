#pragma once

#include "treacle/core/cuda.hpp"
#include "treacle/core/symmetric_block.hpp"
#include "treacle/mph/mph_pairs.hpp"

#include <cmath>
#include <span>

namespace treacle {

/// Eigenvalues of M below this one count as this one: a particle that has neighbours on a line or none at all
/// knows nothing of the divergence across, and the fewer neighbours tell of a direction, the more the matrix that
/// made that exact would weigh each of them.
inline constexpr double leastMoment = 0.3;

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

/// B of a moment M = sum g d d^T = sum_k m_k v_k v_k^T [-], of neighbours at d with -e w' = g d:
/// B = min(1, a_min) sum_k v_k v_k^T / a_k with a_k = max(m_k, leastMoment), a_min the least of them. It has M's
/// eigenvectors, so that B M is symmetric; where no eigenvalue is below leastMoment, B M is the unit matrix but
/// for the factor, which is 1 or the least eigenvalue: none of B's own is above 1.
TREACLE_HD inline SymmetricBlock<2> renormalisationOf(const SymmetricBlock<2>& moment) {
  const double mean = 0.5 * (moment.a[0] + moment.a[2]), half = 0.5 * (moment.a[0] - moment.a[2]);
  const double off = moment.a[1], radius = std::sqrt(half * half + off * off);  // eigenvalues: mean +- radius
  const double more = std::fmax(mean + radius, leastMoment), less = std::fmax(mean - radius, leastMoment);
  const double scale = std::fmin(1.0, less), byLess = scale / less, byMore = scale / more;
  // The mean of both plus half their difference times (M - mean) / radius, whose eigenvalues are +-1.
  const double middle = 0.5 * (byMore + byLess), part = radius > 0 ? 0.5 * (byMore - byLess) / radius : 0.0;
  return {{middle + part * half, part * off, middle - part * half}};
}
TREACLE_HD inline SymmetricBlock<3> renormalisationOf(const SymmetricBlock<3>& moment) {
  // Jacobi's method doubles the valid digits with every sweep; after five, nothing is left to do.
  constexpr int sweeps = 5;
  const double* a = moment.a;
  double m[3][3] = {{a[0], a[1], a[2]}, {a[1], a[3], a[4]}, {a[2], a[4], a[5]}};
  double v[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    detail::rotate<0, 1, 2>(m, v);
    detail::rotate<0, 2, 1>(m, v);
    detail::rotate<1, 2, 0>(m, v);
  }
  const double value[3] = {std::fmax(m[0][0], leastMoment), std::fmax(m[1][1], leastMoment),
                           std::fmax(m[2][2], leastMoment)};
  const double scale = std::fmin(1.0, std::fmin(value[0], std::fmin(value[1], value[2])));
  SymmetricBlock<3> b{};
  for (int k = 0; k < 3; ++k) b.addOuter(scale / value[k], {v[0][k], v[1][k], v[2][k]});
  return b;
}

/// B of every fluid particle from its neighbours within h_p, walls among them. It makes C^T u, minus the
/// divergence, exact for velocities that are linear in space, whatever stands around a particle (Randles, Libersky
/// 1996; Bonet, Lok 1999), but for a factor, which is as if the particle's bulk viscosity were less.
template <int D, class Backend>
void renormalisation(Context<Backend>&, const MphPairs<D>&, std::span<SymmetricBlock<D>> b);

}  // namespace treacle
