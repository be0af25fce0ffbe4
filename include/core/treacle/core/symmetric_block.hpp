#pragma once

#include "treacle/core/vec.hpp"

namespace treacle {

/// Symmetric D x D matrix: its upper triangle, row by row. An aggregate; `SymmetricBlock<2>{}` is zero. Six floats
/// are aligned as doubles are, which halves the loads of a device.
template <int D, class T = double>
struct alignas(sizeof(T) == 4 && D == 3 ? 8 : alignof(T)) SymmetricBlock {
  static constexpr int size = D * (D + 1) / 2;

  T a[size];

  /// Where the element (r, c) stands.
  TREACLE_HD static constexpr int place(int r, int c) {
    const int least = r < c ? r : c, most = r < c ? c : r;
    return least * D - least * (least + 1) / 2 + most;
  }
  TREACLE_HD constexpr T& operator()(int r, int c) { return a[place(r, c)]; }
  TREACLE_HD constexpr const T& operator()(int r, int c) const { return a[place(r, c)]; }

  TREACLE_HD static constexpr SymmetricBlock identity() {
    SymmetricBlock m{};
    for (int k = 0; k < D; ++k) m(k, k) = 1;
    return m;
  }
  TREACLE_HD constexpr SymmetricBlock& operator+=(const SymmetricBlock& o) {
    for (int k = 0; k < size; ++k) a[k] += o.a[k];
    return *this;
  }
  TREACLE_HD friend constexpr SymmetricBlock operator+(SymmetricBlock m, const SymmetricBlock& o) {
    return m += o;
  }
  TREACLE_HD friend constexpr SymmetricBlock operator*(T s, SymmetricBlock m) {
    for (T& x : m.a) x *= s;
    return m;
  }
  /// this += factor v v^T
  TREACLE_HD constexpr void addOuter(T factor, const Vec<D, T>& v) {
    for (int r = 0; r < D; ++r)
      for (int c = r; c < D; ++c) (*this)(r, c) += factor * v[r] * v[c];
  }
  TREACLE_HD friend constexpr T trace(const SymmetricBlock& m) {
    T sum = m(0, 0);
    for (int k = 1; k < D; ++k) sum += m(k, k);
    return sum;
  }
  /// The r-th component of the product with anything that has D components.
  template <class X>
  TREACLE_HD constexpr auto row(int r, const X& x) const {
    auto sum = (*this)(r, 0) * x[0];
    for (int c = 1; c < D; ++c) sum += (*this)(r, c) * x[c];
    return sum;
  }
  TREACLE_HD friend constexpr Vec<D, T> operator*(const SymmetricBlock& m, const Vec<D, T>& x) {
    Vec<D, T> y{};
    for (int r = 0; r < D; ++r) y[r] = m.row(r, x);
    return y;
  }
};

TREACLE_HD constexpr SymmetricBlock<3> inverse(const SymmetricBlock<3>& m) {
  const double* a = m.a;
  const SymmetricBlock<3> cofactor{{a[3] * a[5] - a[4] * a[4], a[2] * a[4] - a[1] * a[5],
                                    a[1] * a[4] - a[2] * a[3], a[0] * a[5] - a[2] * a[2],
                                    a[1] * a[2] - a[0] * a[4], a[0] * a[3] - a[1] * a[1]}};
  return 1 / (a[0] * cofactor.a[0] + a[1] * cofactor.a[1] + a[2] * cofactor.a[2]) * cofactor;
}

/// Whether all eigenvalues are above `least`.
TREACLE_HD constexpr bool isAbove(const SymmetricBlock<3>& m, double least) {
  const double a = m.a[0] - least, b = m.a[3] - least, c = m.a[5] - least, d = m.a[1], e = m.a[2], f = m.a[4];
  return a > 0 && a * b > d * d && a * (b * c - f * f) > d * (d * c - f * e) - e * (d * f - b * e);
}

template <class U, int D, class T>
TREACLE_HD constexpr SymmetricBlock<D, U> converted(const SymmetricBlock<D, T>& m) {
  SymmetricBlock<D, U> c{};
  for (int k = 0; k < m.size; ++k) c.a[k] = static_cast<U>(m.a[k]);
  return c;
}

}  // namespace treacle
