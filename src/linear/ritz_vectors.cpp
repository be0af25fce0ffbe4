#include "treacle/linear/deflation_scalars.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace treacle {
namespace {

constexpr int most = DeflationScalars::maxBasis;
using Square = std::array<std::array<double, most>, most>;

/// Makes element (p, q) of m zero by a rotation, which the rows of `u` take part in.
void rotate(Square& m, Square& u, int n, int p, int q) {
  if (m[p][q] == 0) return;
  const double cotangent = (m[q][q] - m[p][p]) / (2 * m[p][q]);  // of twice the angle
  const double t = (cotangent >= 0 ? 1 : -1) / (std::abs(cotangent) + std::sqrt(cotangent * cotangent + 1));
  const double c = 1 / std::sqrt(t * t + 1), s = t * c;
  const auto turn = [&](double& a, double& b) {
    const double old = a;
    a = c * a - s * b, b = s * old + c * b;
  };
  for (int i = 0; i < n; ++i) turn(m[i][p], m[i][q]);
  for (int i = 0; i < n; ++i) turn(m[p][i], m[q][i]), turn(u[p][i], u[q][i]);
}

/// Jacobi's method: eigenvalues on the diagonal of m, eigenvectors in the rows of u.
void diagonalise(Square& m, Square& u, int n) {
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) u[i][j] = i == j;
  for (int sweep = 0; sweep < 30; ++sweep) {
    double off = 0, diagonal = 0;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) (i == j ? diagonal : off) += m[i][j] * m[i][j];
    if (!(off > 1e-26 * diagonal)) return;
    for (int p = 0; p < n; ++p)
      for (int q = p + 1; q < n; ++q) rotate(m, u, n, p, q);
  }
}

}  // namespace

RitzVectors largestRitzVectors(const DeflationScalars& s, int iterations, int modes, double least) {
  RitzVectors ritz;
  // The step length of the last iteration is not recorded.
  const int n = std::clamp(iterations - 1, 0, most);
  ritz.rows = n;
  Square t{}, u{};
  for (int i = 0; i < n; ++i) {
    t[i][i] = 1 / s.alpha[i] + (i > 0 ? s.beta[i] / s.alpha[i - 1] : 0);
    if (i + 1 < n) t[i][i + 1] = t[i + 1][i] = std::sqrt(s.beta[i + 1]) / s.alpha[i];
  }
  diagonalise(t, u, n);

  std::array<int, most> order;
  for (int i = 0; i < n; ++i) order[i] = i;
  std::sort(order.begin(), order.begin() + n, [&](int i, int j) { return t[i][i] > t[j][j]; });
  double last = INFINITY;
  for (int k = 0; k < n && ritz.modes < modes; ++k) {
    const double value = t[order[k]][order[k]];
    if (!(value > least)) break;
    // Rounding makes copies of values that have converged: one of each.
    if (value > 0.999 * last) continue;
    last = value;
    std::copy_n(u[order[k]].begin(), n, ritz.coefficient[ritz.modes++]);
  }
  return ritz;
}

int invert(const ModeMatrix& e, int modes, ModeMatrix& inverse) {
  // Sweeps turn the rows and columns that take part into minus their inverse.
  ModeMatrix s{};
  for (int i = 0; i < modes; ++i)
    for (int j = 0; j < modes; ++j) {
      s(i, j) = 0.5 * (e(i, j) + e(j, i));
      if (!std::isfinite(s(i, j))) return 0;
    }
  bool in[ModeMatrix::maxModes] = {};
  int count = 0;
  for (int p = 0; p < modes; ++p) {
    const double pivot = s(p, p);
    in[p] = pivot > 1e-8 * e(p, p) && pivot > 0;
    if (!in[p]) continue;
    ++count;
    for (int i = 0; i < modes; ++i)
      for (int j = 0; j < modes; ++j)
        if (i != p && j != p) s(i, j) -= s(i, p) * s(p, j) / pivot;
    for (int i = 0; i < modes; ++i)
      if (i != p) s(i, p) /= pivot, s(p, i) /= pivot;
    s(p, p) = -1 / pivot;
  }
  inverse = {};
  for (int i = 0; i < modes; ++i)
    for (int j = 0; j < modes; ++j)
      if (in[i] && in[j]) inverse(i, j) = -s(i, j);
  return count;
}

}  // namespace treacle
