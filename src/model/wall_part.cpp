#include "wall_part.hpp"

#include <algorithm>
#include <cmath>

namespace treacle {
namespace {

/// A unit vector normal to a direction; that of zero is any.
template <int D>
Vec<D> someNormal(const Vec<D>& direction) {
  Vec<D> n{};
  if constexpr (D == 2) {
    n = {-direction[1], direction[0]};
  } else {
    int least = 0;
    for (int k = 1; k < D; ++k)
      if (std::abs(direction[k]) < std::abs(direction[least])) least = k;
    Vec<D> other{};
    other[least] = 1;
    n = cross(direction, other);
  }
  const double length = norm(n);
  if (length > 0) return n * (1 / length);
  n[0] = 1;
  return n;
}

template <int D>
Face<D> plane(const Vec<D>& origin, const Vec<D>& normal) {
  Face<D> face;
  face.origin = origin, face.normal = normal;
  return face;
}

template <int D>
Face<D> roundFace(const Vec<D>& origin, const Vec<D>& axis, double radius, double side) {
  Face<D> face;
  face.origin = origin, face.axis = axis, face.radius = radius, face.side = side;
  return face;
}

template <int D>
void addBox(const Shape& s, std::vector<Face<D>>& faces) {
  for (int k = 0; k < D; ++k) {
    Vec<D> normal{};
    normal[k] = 1;
    faces.push_back(plane(resized<D>(s.max), normal));
    faces.push_back(plane(resized<D>(s.min), -normal));
  }
}

template <int D>
void addSphere(const Shape& s, std::vector<Face<D>>& faces) {
  faces.push_back(roundFace(resized<D>(s.center), Vec<D>{}, s.radius, 1));
  if (s.innerRadius > 0) faces.push_back(roundFace(resized<D>(s.center), Vec<D>{}, s.innerRadius, -1));
}

template <int D>
void addCylinder(const Shape& s, std::vector<Face<D>>& faces) {
  const Vec<D> start = resized<D>(s.start), end = resized<D>(s.end);
  const Vec<D> axis = (end - start) * (1 / norm(end - start));
  faces.push_back(plane(end, axis));
  faces.push_back(plane(start, -axis));
  for (const auto& [radius, side] : {std::pair{s.radius, 1.0}, std::pair{s.innerRadius, -1.0}}) {
    if (radius == 0) continue;
    if constexpr (D == 2) {
      const Vec<D> normal = someNormal(axis);
      for (const Vec<D>& n : {normal, -normal}) faces.push_back(plane(start + n * radius, n * side));
    } else {
      faces.push_back(roundFace(start, axis, radius, side));
    }
  }
}

}  // namespace

template <int D>
typename Face<D>::At Face<D>::at(const Vec<D>& x) const {
  Vec<D> arm = x - origin;
  if (flat()) return {dot(normal, arm), normal};
  arm -= axis * dot(axis, arm);
  const double distance = norm(arm);
  const Vec<D> outwards = distance > 1e-9 * radius ? arm * (1 / distance) : someNormal(axis);
  return {side * (distance - radius), outwards * side};
}

template <int D>
WallPart<D>::WallPart(const Body& body, const Vec<D>& shift, const Expression* where, double spacing)
    : shape_(body.shape), shift_(shift), where_(where), slack_(1e-6 * spacing) {
  if (shape_.kind == ShapeKind::Box)
    // Where a box is that thin, its only layer of particles stands outside of it.
    for (int k = 0; k < D; ++k)
      if (shape_.max[k] - shape_.min[k] < spacing / 2) shape_.max[k] = shape_.min[k] + spacing;
  const Extent box = boundingBox(shape_, D);
  min_ = resized<D>(box.min) + shift - Vec<D>::filled(slack_);
  max_ = resized<D>(box.max) + shift + Vec<D>::filled(slack_);
  switch (shape_.kind) {
    case ShapeKind::Box:
      addBox(shape_, faces_);
      break;
    case ShapeKind::Sphere:
      addSphere(shape_, faces_);
      break;
    case ShapeKind::Cylinder:
      addCylinder(shape_, faces_);
      break;
  }
  for (Face<D>& face : faces_) face.origin += shift;
}

template <int D>
bool WallPart<D>::shapeContains(const Vec<D>& x) const {
  for (int k = 0; k < D; ++k)
    if (x[k] < min_[k] || x[k] > max_[k]) return false;
  return shape_.kind == ShapeKind::Box || treacle::contains<D>(shape_, x - shift_, slack_);
}

/// Beside particles a condition may have no value; there is no wall then.
template <int D>
bool WallPart<D>::whereHolds(const Vec<D>& x) const {
  if (!where_) return true;
  const double value = (*where_)(resized<3>(x - shift_));
  return std::isfinite(value) && value != 0;
}

template struct Face<2>;
template struct Face<3>;
template class WallPart<2>;
template class WallPart<3>;

bool moveAlike(const Body& a, const Body& b) {
  constexpr double rounding = 1e-12;
  const auto spin = [](const Body& body) {
    return body.rotation ? body.rotation->speed * body.rotation->direction() : Vec<3>{};
  };
  const auto swings = [](const Body& body) {
    return body.oscillation.period > 0 && norm(body.oscillation.amplitude) > 0;
  };
  if (a.kind != BodyKind::Wall || b.kind != BodyKind::Wall) return false;
  if (a.velocity != b.velocity || swings(a) != swings(b)) return false;
  if (swings(a) && a.oscillation != b.oscillation) return false;
  const Vec<3> turn = spin(a);
  if (norm(turn - spin(b)) > rounding * norm(turn)) return false;
  if (norm(turn) == 0) return true;
  // Two points of one axis are centres of the same rotation.
  const Vec<3>& from = a.rotation->center;
  const Vec<3> apart = b.rotation->center - from;
  return norm(cross(turn, apart)) <= rounding * norm(turn) * (norm(from) + norm(apart));
}

}  // namespace treacle
