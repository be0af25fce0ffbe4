#pragma once

#include <experimental/simd>

namespace treacle {

/// N numbers in as many vector registers as they need, whatever width the processor's registers have. Host only.
template <class T, int N>
using Simd = std::experimental::simd<T, std::experimental::simd_abi::deduce_t<T, N>>;

/// A number for each of the eight particles of a cluster.
inline constexpr int laneCount = 8;
template <class T>
using LanesOf = Simd<T, laneCount>;
using Lanes = LanesOf<double>;

/// The vector with the elements of(0), of(1), … The index is a constant, which the compiler makes shuffles of.
template <class Vector, class F>
[[gnu::always_inline]] inline Vector generate(F&& of) {
  return Vector([&](auto k) { return static_cast<typename Vector::value_type>(of(k)); });
}
template <class Vector>
[[gnu::always_inline]] inline Vector load(const typename Vector::value_type* from) {
  return Vector(from, std::experimental::element_aligned);
}
template <class T, class Abi>
[[gnu::always_inline]] inline void store(const std::experimental::simd<T, Abi>& vector, T* to) {
  vector.copy_to(to, std::experimental::element_aligned);
}
template <class Vector, class T, class Abi>
[[gnu::always_inline]] inline Vector convert(const std::experimental::simd<T, Abi>& vector) {
  return std::experimental::static_simd_cast<Vector>(vector);
}

/// a where the mask is set, else b.
template <class T, class Abi>
[[gnu::always_inline]] inline std::experimental::simd<T, Abi> select(
    const typename std::experimental::simd<T, Abi>::mask_type& mask, const std::experimental::simd<T, Abi>& a,
    std::experimental::simd<T, Abi> b) {
  where(mask, b) = a;
  return b;
}

[[gnu::always_inline]] inline Lanes positivePart(const Lanes& a) { return max(a, Lanes(0.0)); }

/// 1 / sqrt(x) to full double precision, 1e-36 < x < 1e38: single precision and one step of third order, which
/// take half as long as a division and a square root in double precision.
[[gnu::always_inline]] inline Lanes inverseSqrt(const Lanes& x) {
  const Lanes y = convert<Lanes>(1.0f / sqrt(convert<LanesOf<float>>(x)));
  const Lanes e = 1.0 - x * y * y;
  return y + y * e * (0.5 + e * 0.375);
}

[[gnu::always_inline]] inline Lanes squareRoot(const Lanes& x) { return sqrt(x); }
[[gnu::always_inline]] inline Lanes absoluteValue(const Lanes& x) { return max(x, -x); }

}  // namespace treacle
