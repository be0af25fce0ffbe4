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
/// Of the box around a shape before its transform, which turns with it.
Heights heightsOf(const Case& c, const Shape& shape);

/// Extent of all fluid bodies along gravity [m].
double fluidHeight(const Case& c);

/// Centrifugal forces on the fluid bodies where they start, while the frame turns fastest: the largest one, and
/// how much work they do across the fluid. Zero without a frame that turns.
struct CentrifugalScale {
  double acceleration = 0;  // [m/s2]
  double potential = 0;     // [m2/s2]
};

CentrifugalScale centrifugalScale(const Case& c);

/// Largest speed of a fluid body at the start, of a wall or nozzle at any time [m/s].
double largestSpeedOf(const Case& c, const Body& body);

/// Largest of the initial speeds and those of the walls [m/s].
double givenSpeed(const Case& c);

}  // namespace treacle
