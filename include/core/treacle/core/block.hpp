#pragma once

#include "treacle/core/macros.hpp"
#include "treacle/core/vec.hpp"

#include <cmath>

namespace treacle {

/// D x D matrix, row-major.
template <int D, class T = double>
struct Block {
  T a[D * D];

  TREACLE_HD constexpr T& operator()(int r, int c) { return a[r * D + c]; }
  TREACLE_HD constexpr const T& operator()(int r, int c) const { return a[r * D + c]; }

  TREACLE_HD static constexpr Block diagonal(T value) {
    Block m{};
    for (int k = 0; k < D; ++k) m(k, k) = value;
    return m;
  }
  TREACLE_HD constexpr Block& operator+=(const Block& o) {
    for (int k = 0; k < D * D; ++k) a[k] += o.a[k];
    return *this;
  }
  TREACLE_HD constexpr Block& operator-=(const Block& o) {
    for (int k = 0; k < D * D; ++k) a[k] -= o.a[k];
    return *this;
  }
  /// this += s x y^T
  TREACLE_HD constexpr void addOuter(T s, const Vec<D, T>& x, const Vec<D, T>& y) {
    for (int r = 0; r < D; ++r)
      for (int c = 0; c < D; ++c) (*this)(r, c) += s * x[r] * y[c];
  }
  TREACLE_HD friend constexpr Vec<D, T> operator*(const Block& m, const Vec<D, T>& x) {
    Vec<D, T> y{};
    for (int r = 0; r < D; ++r)
      for (int c = 0; c < D; ++c) y[r] += m(r, c) * x[c];
    return y;
  }
};

/// Inverse of a symmetric positive definite block by its adjugate.
template <int D, class T>
TREACLE_HD Block<D, T> inverse(const Block<D, T>& m) {
  Block<D, T> r{};
  if constexpr (D == 1) {
    r.a[0] = T(1) / m.a[0];
  } else if constexpr (D == 2) {
    const T det = multiplyAdd(m(0, 0), m(1, 1), -(m(0, 1) * m(1, 0)));
    r = {{m(1, 1) / det, -m(0, 1) / det, -m(1, 0) / det, m(0, 0) / det}};
  } else {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        const int a = (j + 1) % 3, b = (j + 2) % 3, c = (i + 1) % 3, d = (i + 2) % 3;
        r(i, j) = multiplyAdd(m(a, c), m(b, d), -(m(a, d) * m(b, c)));
      }
    const T det = fixedDot(Vec<3, T>{m(0, 0), m(0, 1), m(0, 2)}, Vec<3, T>{r(0, 0), r(1, 0), r(2, 0)});
    for (int k = 0; k < 9; ++k) r.a[k] /= det;
  }
  return r;
}

}  // namespace treacle
