#pragma once

#include "treacle/core/multiply_add.hpp"

#include <cmath>

namespace treacle {

/// Small fixed-size vector of D components. An aggregate: `Vec<2>{1.0, 2.0}`; `Vec<2>{}` is zero.
template <int D, class T = double>
struct Vec {
  static_assert(D >= 1 && D <= 3);
  static constexpr int dimensions = D;

  T v[D];

  TREACLE_HD constexpr T& operator[](int k) { return v[k]; }
  TREACLE_HD constexpr const T& operator[](int k) const { return v[k]; }

  TREACLE_HD static constexpr Vec filled(T value) {
    Vec r{};
    for (int k = 0; k < D; ++k) r.v[k] = value;
    return r;
  }

  TREACLE_HD constexpr Vec& operator+=(const Vec& o) {
    for (int k = 0; k < D; ++k) v[k] += o.v[k];
    return *this;
  }
  TREACLE_HD constexpr Vec& operator-=(const Vec& o) {
    for (int k = 0; k < D; ++k) v[k] -= o.v[k];
    return *this;
  }
  TREACLE_HD constexpr Vec& operator*=(T s) {
    for (int k = 0; k < D; ++k) v[k] *= s;
    return *this;
  }
  TREACLE_HD friend constexpr Vec operator+(Vec a, const Vec& b) { return a += b; }
  TREACLE_HD friend constexpr Vec operator-(Vec a, const Vec& b) { return a -= b; }
  TREACLE_HD friend constexpr Vec operator*(Vec a, T s) { return a *= s; }
  TREACLE_HD friend constexpr Vec operator*(T s, Vec a) { return a *= s; }
  TREACLE_HD friend constexpr Vec operator-(Vec a) { return a *= T(-1); }
  TREACLE_HD friend constexpr bool operator==(const Vec& a, const Vec& b) {
    for (int k = 0; k < D; ++k)
      if (a.v[k] != b.v[k]) return false;
    return true;
  }
};

/// A vector quantity that neighbours gather: three components are padded to four, so that a device fetches them at
/// once.
template <int D, class T>
struct alignas((D == 3 ? 4 : D) * sizeof(T)) Gathered : Vec<D, T> {
  Gathered() = default;
  TREACLE_HD constexpr Gathered(const Vec<D, T>& vec) : Vec<D, T>(vec) {}
};

template <int D, class T>
TREACLE_HD constexpr T dot(const Vec<D, T>& a, const Vec<D, T>& b) {
  T sum = a[0] * b[0];
  for (int k = 1; k < D; ++k) sum += a[k] * b[k];
  return sum;
}

/// The same to the last bit wherever it is formed (multiplyAdd).
template <int D, class T>
TREACLE_HD T fixedDot(const Vec<D, T>& a, const Vec<D, T>& b) {
  T sum = multiplyAdd(a[0], b[0], a[1] * b[1]);
  for (int k = 2; k < D; ++k) sum = multiplyAdd(a[k], b[k], sum);
  return sum;
}

template <class T>
TREACLE_HD constexpr Vec<3, T> cross(const Vec<3, T>& a, const Vec<3, T>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

template <int D, class T>
TREACLE_HD constexpr T norm2(const Vec<D, T>& a) {
  return dot(a, a);
}

template <int D, class T>
TREACLE_HD T norm(const Vec<D, T>& a) {
  return std::sqrt(norm2(a));
}

/// The same with components of another type.
template <class U, int D, class T>
TREACLE_HD constexpr Vec<D, U> converted(const Vec<D, T>& a) {
  Vec<D, U> r{};
  for (int k = 0; k < D; ++k) r[k] = static_cast<U>(a[k]);
  return r;
}

/// Conversion between dimensions: missing components become zero, surplus ones are dropped.
template <int E, int D, class T>
TREACLE_HD constexpr Vec<E, T> resized(const Vec<D, T>& a) {
  Vec<E, T> r{};
  for (int k = 0; k < (D < E ? D : E); ++k) r[k] = a[k];
  return r;
}

}  // namespace treacle
