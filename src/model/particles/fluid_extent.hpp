#pragma once

#include "treacle/model/case/case.hpp"
#include "treacle/model/geometry/shape.hpp"

#include <algorithm>
#include <limits>

namespace treacle {

/// Where something is, measured against gravity, which is not zero [m].
struct Heights {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  double extent() const { return std::max(0.0, high - low); }
};

Heights heightsOf(const Case& c, const Extent& box);

/// Extent of all fluid bodies along gravity [m].
double fluidHeight(const Case& c);

/// Largest of the initial speeds and those of the walls [m/s].
double givenSpeed(const Case& c);

}  // namespace treacle
