#pragma once

#include "treacle/model/case.hpp"

#include <string>

namespace treacle {

/// An axis-aligned box [m].
struct Extent {
  Vec<3> min{}, max{};
};

/// The smallest axis-aligned box around a shape, in the first `dimensions` axes; the others are zero.
Extent boundingBox(const Shape& shape, int dimensions);

/// Whether a point belongs to a sphere or cylinder (boxes are filled by count, see createParticles).
/// The outer surface belongs to the shape, the inner one does not: a fluid sphere and a wall shell around it
/// with the same radius never share a point. `slack` [m] absorbs rounding.
template <int D>
bool contains(const Shape& shape, const Vec<D>& x, double slack);

extern template bool contains<2>(const Shape&, const Vec<2>&, double);
extern template bool contains<3>(const Shape&, const Vec<3>&, double);

/// A length for messages: "20.4 mm", "1.5 m".
std::string lengthText(double length);

/// A position for messages: "(1, 2.5) mm".
std::string positionText(const Vec<3>& x, int dimensions);

}  // namespace treacle
