#pragma once

#include <cmath>

// Masked intrinsics with all lanes on are the plain instructions, without g++'s warning about an undefined
// operand.
#ifdef __AVX512F__
#include <immintrin.h>
#endif

namespace treacle {

/// Eight doubles that the compiler keeps in vector registers of whatever width the processor has. Host only.
inline constexpr int laneCount = 8;
using Lanes = double __attribute__((vector_size(laneCount * sizeof(double))));

inline Lanes broadcast(double a) { return Lanes{a, a, a, a, a, a, a, a}; }

inline Lanes max(Lanes a, Lanes b) {
#ifdef __AVX512F__
  return (Lanes)_mm512_maskz_max_pd(0xff, (__m512d)a, (__m512d)b);
#else
  return a > b ? a : b;
#endif
}

inline Lanes positivePart(Lanes a) { return max(a, Lanes{}); }

/// Whether a <= bound in some lane.
inline bool anyAtMost(Lanes a, double bound) {
#ifdef __AVX512F__
  return _mm512_cmp_pd_mask((__m512d)a, _mm512_set1_pd(bound), _CMP_LE_OQ) != 0;
#else
  bool any = false;
  for (int k = 0; k < laneCount; ++k) any |= a[k] <= bound;
  return any;
#endif
}

/// 1 / sqrt(x) to full double precision, x > 0.
/// AVX-512: the 14-bit estimate and one step of fourth order (error e^4, e = 2^-13) instead of a division and a
/// square root, which would take longer than the rest of a pair's work.
inline Lanes inverseSqrt(Lanes x) {
#ifdef __AVX512F__
  const Lanes y = (Lanes)_mm512_maskz_rsqrt14_pd(0xff, (__m512d)x);
  const Lanes e = 1.0 - x * y * y;
  return y + y * e * (0.5 + e * (0.375 + e * 0.3125));
#else
  Lanes y;
  for (int k = 0; k < laneCount; ++k) y[k] = 1.0 / std::sqrt(x[k]);
  return y;
#endif
}

inline Lanes squareRoot(Lanes x) {
#ifdef __AVX512F__
  return (Lanes)_mm512_maskz_sqrt_pd(0xff, (__m512d)x);
#else
  for (int k = 0; k < laneCount; ++k) x[k] = std::sqrt(x[k]);
  return x;
#endif
}

}  // namespace treacle
