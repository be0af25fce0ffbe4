#pragma once

#include "treacle/model/case/case.hpp"

#include <string>

namespace treacle {

/// An axis-aligned box [m].
struct Extent {
  Vec<3> min{}, max{};
};

/// An axis-aligned box around a shape, in the first `dimensions` axes; the others are zero. The smallest one,
/// unless the shape is turned. What is on the outside of a polygon or mesh counts as far as its thickness is
/// given; without its file a shape has no extent.
Extent boundingBox(const Shape& shape, int dimensions);
/// The same before the shape's transform.
Extent untransformedBox(const Shape& shape, int dimensions);

/// That of a shape; the identity where it has none.
template <int D>
Similarity<D> similarityOf(const Shape& shape);

/// Whether a point belongs to a box, sphere, cylinder, cone or torus before its transform (polygons and meshes are
/// known by their boundary). The outer surface belongs to the shape, the inner
/// one does not: a fluid sphere and a wall shell around it with the same radius never share a point. `slack` [m]
/// absorbs rounding.
template <int D>
bool contains(const Shape& shape, const Vec<D>& x, double slack);

extern template Similarity<2> similarityOf<2>(const Shape&);
extern template Similarity<3> similarityOf<3>(const Shape&);
extern template bool contains<2>(const Shape&, const Vec<2>&, double);
extern template bool contains<3>(const Shape&, const Vec<3>&, double);

/// A length for messages: "20.4 mm", "1.5 m".
std::string lengthText(double length);

/// A position for messages: "(1, 2.5) mm".
std::string positionText(const Vec<3>& x, int dimensions);
/// Two of them in the same unit: "(1, 2.5) mm to (2, 1000) mm".
std::string rangeText(const Vec<3>& min, const Vec<3>& max, int dimensions);

}  // namespace treacle
