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
  face.form = Face<D>::Form::Round;
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

template <int D>
void addCone(const Shape& s, std::vector<Face<D>>& faces) {
  const Vec<D> start = resized<D>(s.start), end = resized<D>(s.end);
  const double length = norm(end - start);
  const Vec<D> axis = (end - start) * (1 / length);
  faces.push_back(plane(end, axis));
  faces.push_back(plane(start, -axis));
  const auto add = [&](double startRadius, double endRadius, double side) {
    const double slope = (endRadius - startRadius) / length;
    if constexpr (D == 2) {
      const Vec<D> across = someNormal(axis);
      for (const Vec<D>& n : {across, -across}) {
        const Vec<D> normal = (n - axis * slope) * (side / std::sqrt(1 + slope * slope));
        faces.push_back(plane(start + n * startRadius, normal));
      }
    } else {
      Face<D> mantle = roundFace(start, axis, startRadius, side);
      mantle.form = Face<D>::Form::Cone, mantle.slope = slope;
      faces.push_back(mantle);
    }
  };
  add(s.startRadius, s.endRadius, 1);
  if (s.innerStartRadius > 0 || s.innerEndRadius > 0) add(s.innerStartRadius, s.innerEndRadius, -1);
}

template <int D>
void addTorus(const Shape& s, std::vector<Face<D>>& faces) {
  for (const auto& [radius, side] : {std::pair{s.tubeRadius, 1.0}, std::pair{s.innerRadius, -1.0}}) {
    if (radius == 0) continue;
    Face<D> tube = roundFace(resized<D>(s.center), resized<D>(s.axis * (1 / norm(s.axis))), radius, side);
    tube.form = Face<D>::Form::Ring, tube.ring = s.radius;
    faces.push_back(tube);
  }
}

template <int D>
void addSolid(const Solid<D>& solid, std::vector<Face<D>>& faces) {
  for (int k = 0; k < solid.faceCount(); ++k) {
    Face<D> face;
    face.form = Face<D>::Form::Solid, face.solid = &solid, face.solidFace = k;
    faces.push_back(face);
  }
}

bool isConvex(const Shape& s) {
  const bool hollow = s.innerRadius > 0 || s.innerStartRadius > 0 || s.innerEndRadius > 0;
  return !hollow && s.kind != ShapeKind::Torus && !isSolid(s);
}

}  // namespace

template <int D>
typename Face<D>::Across Face<D>::across(const Vec<D>& x) const {
  const Vec<D> offset = x - origin;
  const double along = dot(axis, offset);
  const Vec<D> arm = offset - axis * along;
  const double distance = norm(arm);
  return {distance > 0 ? arm * (1 / distance) : someNormal(axis), distance, radius + slope * along};
}

template <int D>
typename Face<D>::At Face<D>::at(const Vec<D>& x) const {
  if (form == Form::Solid) {
    const auto [height, out] = solid->at(solidFace, x - origin);
    return {height, out};
  }
  Vec<D> arm = x - origin;
  if (flat()) return {dot(normal, arm), normal};
  if (form == Form::Cone) {
    const auto [outwards, distance, itsRadius] = across(x);
    const double cosine = 1 / std::sqrt(1 + slope * slope);
    return {side * (distance - itsRadius) * cosine, (outwards - axis * slope) * (side * cosine)};
  }
  if (form == Form::Ring) {
    arm -= across(x).outwards * ring;
    const double distance = norm(arm);
    const Vec<D> outwards = distance > 1e-9 * radius ? arm * (1 / distance) : axis;
    return {side * (distance - radius), outwards * side};
  }
  arm -= axis * dot(axis, arm);
  const double distance = norm(arm);
  const Vec<D> outwards = distance > 1e-9 * radius ? arm * (1 / distance) : someNormal(axis);
  return {side * (distance - radius), outwards * side};
}

template <int D>
std::optional<typename Face<D>::Behind> Face<D>::behind(const Vec<D>& x) const {
  if (form == Form::Plane || form == Form::Solid || side < 0) return std::nullopt;
  if (form == Form::Cone) {
    const auto [outwards, distance, itsRadius] = across(x);
    const double cosine = 1 / std::sqrt(1 + slope * slope);
    if (distance >= itsRadius) return std::nullopt;
    return Behind{(distance + itsRadius) * cosine, (-outwards - axis * slope) * cosine};
  }
  const auto [height, out] = at(x);
  if (height >= 0) return std::nullopt;
  return Behind{2 * radius + height, -out};
}

template <int D>
WallPart<D>::WallPart(const Body& body, const Vec<D>& shift, const Expression* where, const Solid<D>* solid,
                      double spacing)
    : shape_(body.shape),
      similarity_(similarityOf<D>(body.shape)),
      shift_(shift),
      where_(where),
      solid_(solid),
      slack_(1e-6 * spacing),
      convex_(isConvex(body.shape)) {
  const double own = spacing / similarity_.scale();  // before the transform
  if (shape_.kind == ShapeKind::Box)
    // Where a box is that thin, its only layer of particles stands outside of it.
    for (int k = 0; k < D; ++k)
      if (shape_.max[k] - shape_.min[k] < own / 2) shape_.max[k] = shape_.min[k] + own;
  const Extent box = boundingBox(shape_, D);
  min_ = (solid ? solid->min() : resized<D>(box.min)) + shift - Vec<D>::filled(slack_);
  max_ = (solid ? solid->max() : resized<D>(box.max)) + shift + Vec<D>::filled(slack_);
  addFaces();
  for (Face<D>& face : faces_) {
    if (!solid) face.origin = similarity_.point(face.origin);
    face.origin += shift;
    face.normal = similarity_.direction(face.normal), face.axis = similarity_.direction(face.axis);
    face.radius *= similarity_.scale(), face.ring *= similarity_.scale();
  }
}

template <int D>
void WallPart<D>::addFaces() {
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
    case ShapeKind::Cone:
      addCone(shape_, faces_);
      break;
    case ShapeKind::Torus:
      addTorus(shape_, faces_);
      break;
    case ShapeKind::Polygon:
    case ShapeKind::Mesh:
      addSolid(*solid_, faces_);
      break;
    case ShapeKind::Particles:
      break;  // nobody knows where their surface is
  }
}

template <int D>
bool WallPart<D>::shapeContains(const Vec<D>& x) const {
  for (int k = 0; k < D; ++k)
    if (x[k] < min_[k] || x[k] > max_[k]) return false;
  if (solid_) return solid_->contains(x - shift_);
  const double slack = slack_ / similarity_.scale();
  if (shape_.kind == ShapeKind::Box) {
    const Vec<D> local = similarity_.pointBefore(x - shift_);
    for (int k = 0; similarity_.turns() && k < D; ++k)
      if (local[k] < shape_.min[k] - slack || local[k] > shape_.max[k] + slack) return false;
    return true;
  }
  return shape_.kind != ShapeKind::Particles &&
         treacle::contains<D>(shape_, similarity_.pointBefore(x - shift_), slack);
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
