#pragma once

#include "treacle/core/macros.hpp"
#include "treacle/core/vec.hpp"

namespace treacle {

/// Shifting to where neighbours lack: displacement -coefficient l^2 crowding, at most longestShift l. It is one
/// for ISPH and for fluid under tension of MPH-I.
struct Shifting {
  double coefficient;  // [-]
  double spacing;      // l [m]
  double timeStep;     // [s]
};

/// No particle moves farther from where its velocity takes it in a step [spacings].
inline constexpr double longestShift = 0.1;

/// A displacement [m], cut to longestShift.
template <int D>
TREACLE_HD Vec<D> limitedShift(Vec<D> displacement, double spacing) {
  const double length = norm(displacement), most = longestShift * spacing;
  if (length > most) displacement *= most / length;
  return displacement;
}

/// What a particle moves with: velocity + displacement / dt. `crowding`: sum V grad W, or C 1 of MPH-I, which
/// points to where neighbours crowd [1/m].
template <int D>
TREACLE_HD Vec<D> shiftedVelocity(const Shifting& s, const Vec<D>& crowding, const Vec<D>& velocity) {
  const Vec<D> displacement = (-s.coefficient * s.spacing * s.spacing) * crowding;
  return velocity + (1 / s.timeStep) * limitedShift(displacement, s.spacing);
}

}  // namespace treacle
