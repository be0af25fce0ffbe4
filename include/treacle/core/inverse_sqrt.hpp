#pragma once

#include "treacle/core/macros.hpp"

#include <cmath>

namespace treacle {

/// 1 / sqrt(x), infinite for 0: devices have it as one operation.
TREACLE_HD inline double inverseSqrt(double x) {
#ifdef __CUDA_ARCH__
  return rsqrt(x);
#else
  return 1 / std::sqrt(x);
#endif
}

}  // namespace treacle
