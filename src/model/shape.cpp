#include "treacle/model/shape.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

namespace treacle {
namespace {

Extent cylinderBox(const Shape& s) {
  const Vec<3> axis = s.end - s.start;
  const double length = norm(axis);
  Extent box;
  for (int k = 0; k < 3; ++k) {
    // Half the width of a disc of this radius, normal to the axis, along axis k.
    const double cosine = axis[k] / length;
    const double half = s.radius * std::sqrt(std::max(0.0, 1 - cosine * cosine));
    box.min[k] = std::min(s.start[k], s.end[k]) - half;
    box.max[k] = std::max(s.start[k], s.end[k]) + half;
  }
  return box;
}

bool between(double r, const Shape& s, double slack) {
  return r <= s.radius + slack && (s.innerRadius == 0 || r > s.innerRadius + slack);
}

}  // namespace

Extent boundingBox(const Shape& s, int dimensions) {
  Extent box;
  switch (s.kind) {
    case ShapeKind::Box:
      box = {s.min, s.max};
      break;
    case ShapeKind::Sphere:
      box = {s.center - Vec<3>::filled(s.radius), s.center + Vec<3>::filled(s.radius)};
      break;
    case ShapeKind::Cylinder:
      box = cylinderBox(s);
      break;
  }
  for (int k = dimensions; k < 3; ++k) box.min[k] = box.max[k] = 0;
  return box;
}

template <int D>
bool contains(const Shape& s, const Vec<D>& x, double slack) {
  if (s.kind == ShapeKind::Sphere) return between(norm(x - resized<D>(s.center)), s, slack);
  const Vec<D> axis = resized<D>(s.end - s.start), offset = x - resized<D>(s.start);
  const double length = norm(axis);
  const double along = dot(offset, axis) / length;
  if (along < -slack || along > length + slack) return false;
  return between(norm(offset - axis * (along / length)), s, slack);
}

template bool contains<2>(const Shape&, const Vec<2>&, double);
template bool contains<3>(const Shape&, const Vec<3>&, double);

std::string lengthText(double length) {
  return std::abs(length) < 1 ? fmt::format("{:.6g} mm", 1e3 * length) : fmt::format("{:.6g} m", length);
}

std::string positionText(const Vec<3>& x, int dimensions) {
  double largest = 0;
  for (int k = 0; k < dimensions; ++k) largest = std::max(largest, std::abs(x[k]));
  const bool small = largest < 1;
  std::string text;
  for (int k = 0; k < dimensions; ++k) {
    if (k > 0) text += ", ";
    text += fmt::format("{:.6g}", small ? 1e3 * x[k] : x[k]);
  }
  return fmt::format("({}) {}", text, small ? "mm" : "m");
}

}  // namespace treacle
