#pragma once

#include "treacle/core/macros.hpp"
#ifndef __CUDACC__  // which knows no such vectors; its code has none of these loops
#include "treacle/core/lanes.hpp"
#endif

#include <cmath>

namespace treacle {

// Functions that formulas need in every arithmetic; Lanes have theirs in lanes.hpp.

/// 1 / sqrt(x), x > 0. A device starts from its estimate (2^-22) and takes one step of third order, to full double
/// precision.
TREACLE_HD inline double inverseSqrt(double x) {
#ifdef __CUDA_ARCH__
  double y;
  asm("rsqrt.approx.ftz.f64 %0, %1;" : "=d"(y) : "d"(x));
  const double e = fma(-x * y, y, 1.0);
  return fma(y * e, fma(e, 0.375, 0.5), y);
#else
  return 1 / std::sqrt(x);
#endif
}
TREACLE_HD inline float inverseSqrt(float x) {
#ifdef __CUDA_ARCH__
  // rsqrtf looks after numbers below 1e-38, in a tenth of a pair's instructions.
  float y;
  asm("rsqrt.approx.ftz.f32 %0, %1;" : "=f"(y) : "f"(x));
  return y;
#else
  return 1 / std::sqrt(x);
#endif
}

TREACLE_HD inline double squareRoot(double x) { return sqrt(x); }
TREACLE_HD inline double absoluteValue(double x) { return fabs(x); }

inline double sinc(double x) { return x == 0 ? 1 : std::sin(x) / x; }

/// x where it is positive, else zero; on a device without occupying the double-precision units.
TREACLE_HD inline double positivePart(double x) {
#ifdef __CUDA_ARCH__
  const int high = __double2hiint(x), keep = ~(high >> 31);
  return __hiloint2double(high & keep, __double2loint(x) & keep);
#else
  return x > 0 ? x : 0;
#endif
}
TREACLE_HD inline float positivePart(float x) {
#ifdef __CUDA_ARCH__
  return fmaxf(x, 0.f);
#else
  return x > 0 ? x : 0;
#endif
}

}  // namespace treacle
