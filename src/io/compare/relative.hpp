#pragma once

#include <cmath>
#include <limits>

namespace treacle {

/// |difference| / |scale|; 0 where nothing differs, infinite where something differs from zero.
inline double relativeTo(double scale, double difference) {
  if (difference == 0) return 0;
  return scale == 0 ? std::numeric_limits<double>::infinity() : std::abs(difference) / std::abs(scale);
}

}  // namespace treacle
