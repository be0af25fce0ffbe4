#pragma once

#include "treacle/core/macros.hpp"

#include <cmath>

namespace treacle {

/// a b + c, rounded once where the processor does so at no cost. A compiler fuses the product and the sum of its
/// own accord, but in a b + c d it may take either product, as it does differently from one piece of code to the
/// next: who writes which one keeps the last bit.
template <class T>
TREACLE_HD inline T multiplyAdd(T a, T b, T c) {
#if defined(__CUDA_ARCH__) || defined(__FMA__) || defined(__ARM_FEATURE_FMA)
  return std::fma(a, b, c);
#else
  return a * b + c;
#endif
}

}  // namespace treacle
