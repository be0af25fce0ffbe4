#include "treacle/model/geometry/shape.hpp"

#include "treacle/model/geometry/mesh.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <vector>

namespace treacle {
namespace {

/// Half the width of a disc, normal to a direction, along axis k.
double halfWidth(const Vec<3>& direction, double radius, int k) {
  const double cosine = direction[k] / norm(direction);
  return radius * std::sqrt(std::max(0.0, 1 - cosine * cosine));
}

/// Around two discs at the ends of an axis.
Extent roundBox(const Shape& s, double startRadius, double endRadius) {
  const Vec<3> axis = s.end - s.start;
  Extent box;
  for (int k = 0; k < 3; ++k) {
    const double start = halfWidth(axis, startRadius, k), end = halfWidth(axis, endRadius, k);
    box.min[k] = std::min(s.start[k] - start, s.end[k] - end);
    box.max[k] = std::max(s.start[k] + start, s.end[k] + end);
  }
  return box;
}

Extent torusBox(const Shape& s) {
  Extent box{s.center, s.center};
  for (int k = 0; k < 3; ++k) {
    const double half = halfWidth(s.axis, s.radius, k) + s.tubeRadius;
    box.min[k] -= half, box.max[k] += half;
  }
  return box;
}

template <class Points>
Extent pointsBox(const Points& points) {
  if (points.empty()) return {};
  Extent box{resized<3>(points.front()), resized<3>(points.front())};
  for (const auto& x : points)
    for (int k = 0; k < x.dimensions; ++k)
      box.min[k] = std::min(box.min[k], x[k]), box.max[k] = std::max(box.max[k], x[k]);
  return box;
}

Extent polygonBox(const Shape& s) {
  Extent box = pointsBox(s.points);
  box.min[2] = s.bottom, box.max[2] = s.top;
  return box;
}

/// What a layer on the outside of a boundary adds, before a transform.
double beyond(const Shape& s) {
  const double thickness = s.thickness / (s.transform ? s.transform->scale : 1);
  if (s.fill == FillKind::Outside) return thickness;
  return s.fill == FillKind::Sheet ? thickness / 2 : 0;
}

template <int D>
Extent transformed(const Extent& box, const Shape& s) {
  const Similarity<D> similarity = similarityOf<D>(s);
  std::vector<Vec<D>> corners;
  for (int c = 0; c < 1 << D; ++c) {
    Vec<D> x{};
    for (int k = 0; k < D; ++k) x[k] = c >> k & 1 ? box.max[k] : box.min[k];
    corners.push_back(similarity.point(x));
  }
  return pointsBox(corners);
}

bool between(double r, double radius, double innerRadius, double slack) {
  return r <= radius + slack && (innerRadius == 0 || r > innerRadius + slack);
}

template <int D>
bool torusContains(const Shape& s, const Vec<D>& x, double slack) {
  const Vec<3> offset = resized<3>(x) - s.center, axis = s.axis * (1 / norm(s.axis));
  const double along = dot(offset, axis), across = norm(offset - axis * along) - s.radius;
  return between(std::sqrt(along * along + across * across), s.tubeRadius, s.innerRadius, slack);
}

}  // namespace

Extent untransformedBox(const Shape& s, int dimensions) {
  Extent box;
  switch (s.kind) {
    case ShapeKind::Box:
      box = {s.min, s.max};
      break;
    case ShapeKind::Sphere:
      box = {s.center - Vec<3>::filled(s.radius), s.center + Vec<3>::filled(s.radius)};
      break;
    case ShapeKind::Cylinder:
      box = roundBox(s, s.radius, s.radius);
      break;
    case ShapeKind::Cone:
      box = roundBox(s, s.startRadius, s.endRadius);
      break;
    case ShapeKind::Torus:
      box = torusBox(s);
      break;
    case ShapeKind::Polygon:
    case ShapeKind::Polyline:
      box = polygonBox(s);
      break;
    case ShapeKind::Mesh:
      if (s.file.mesh.value) box = {s.file.mesh.value->facts().min, s.file.mesh.value->facts().max};
      break;
    case ShapeKind::Particles:
      if (s.file.particles.value) box = pointsBox(s.file.particles.value->position);
      break;
  }
  if (s.kind == ShapeKind::Polygon || s.kind == ShapeKind::Mesh)
    box.min -= Vec<3>::filled(beyond(s)), box.max += Vec<3>::filled(beyond(s));
  for (int k = dimensions; k < 3; ++k) box.min[k] = box.max[k] = 0;
  return box;
}

Extent boundingBox(const Shape& s, int dimensions) {
  const Extent box = untransformedBox(s, dimensions);
  if (!s.transform) return box;
  return dimensions == 2 ? transformed<2>(box, s) : transformed<3>(box, s);
}

template <int D>
Similarity<D> similarityOf(const Shape& s) {
  return s.transform ? Similarity<D>(*s.transform) : Similarity<D>();
}

template <int D>
bool contains(const Shape& s, const Vec<D>& x, double slack) {
  if (s.kind == ShapeKind::Box) {
    for (int k = 0; k < D; ++k)
      if (x[k] < s.min[k] - slack || x[k] > s.max[k] + slack) return false;
    return true;
  }
  if (s.kind == ShapeKind::Torus) return torusContains<D>(s, x, slack);
  if (s.kind == ShapeKind::Sphere) return between(norm(x - resized<D>(s.center)), s.radius, s.innerRadius, slack);
  const Vec<D> axis = resized<D>(s.end - s.start), offset = x - resized<D>(s.start);
  const double length = norm(axis);
  const double along = dot(offset, axis) / length;
  if (along < -slack || along > length + slack) return false;
  const double r = norm(offset - axis * (along / length));
  if (s.kind == ShapeKind::Cylinder) return between(r, s.radius, s.innerRadius, slack);
  const double share = std::clamp(along / length, 0.0, 1.0);
  const auto at = [&](double start, double end) { return start + share * (end - start); };
  const bool hollow = s.innerStartRadius > 0 || s.innerEndRadius > 0;
  return r <= at(s.startRadius, s.endRadius) + slack &&
         !(hollow && r <= at(s.innerStartRadius, s.innerEndRadius) + slack);
}

template Similarity<2> similarityOf<2>(const Shape&);
template Similarity<3> similarityOf<3>(const Shape&);
template bool contains<2>(const Shape&, const Vec<2>&, double);
template bool contains<3>(const Shape&, const Vec<3>&, double);

std::string lengthText(double length) {
  return std::abs(length) < 1 ? fmt::format("{:.6g} mm", 1e3 * length) : fmt::format("{:.6g} m", length);
}

namespace {

double largestOf(const Vec<3>& x, int dimensions) {
  double largest = 0;
  for (int k = 0; k < dimensions; ++k) largest = std::max(largest, std::abs(x[k]));
  return largest;
}

std::string positionText(const Vec<3>& x, int dimensions, bool small) {
  std::string text;
  for (int k = 0; k < dimensions; ++k) {
    if (k > 0) text += ", ";
    const double there = std::abs(x[k]) < 1e-12 ? 0 : x[k];  // but for rounding
    text += fmt::format("{:.6g}", small ? 1e3 * there : there);
  }
  return fmt::format("({}) {}", text, small ? "mm" : "m");
}

}  // namespace

std::string positionText(const Vec<3>& x, int dimensions) {
  return positionText(x, dimensions, largestOf(x, dimensions) < 1);
}

std::string rangeText(const Vec<3>& min, const Vec<3>& max, int dimensions) {
  const bool small = std::max(largestOf(min, dimensions), largestOf(max, dimensions)) < 1;
  return fmt::format("{} to {}", positionText(min, dimensions, small), positionText(max, dimensions, small));
}

}  // namespace treacle
