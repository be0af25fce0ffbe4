#pragma once

#include "treacle/model/case/body.hpp"

#include <cmath>

namespace treacle {

/// The coefficient of Coulomb friction of two bodies that touch: the geometric mean, so that two of the same
/// coefficient have this one, and a smooth body is smooth wherever it touches. Nozzles are smooth.
inline double frictionBetween(const Body& a, const Body& b) {
  return a.isWall() && b.isWall() ? std::sqrt(a.friction * b.friction) : 0;
}

/// The coefficient of restitution of two bodies that touch: the geometric mean, as for friction.
inline double restitutionBetween(const Body& a, const Body& b) {
  return a.isWall() && b.isWall() ? std::sqrt(a.restitution * b.restitution) : 0;
}

}  // namespace treacle
