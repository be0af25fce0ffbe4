#include "face.hpp"

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
std::vector<Face<D>> facesOf(const Shape& s, const Solid<D>* solid) {
  std::vector<Face<D>> faces;
  switch (s.kind) {
    case ShapeKind::Box:
      addBox(s, faces);
      break;
    case ShapeKind::Sphere:
      addSphere(s, faces);
      break;
    case ShapeKind::Cylinder:
      addCylinder(s, faces);
      break;
    case ShapeKind::Cone:
      addCone(s, faces);
      break;
    case ShapeKind::Torus:
      addTorus(s, faces);
      break;
    case ShapeKind::Polygon:
    case ShapeKind::Mesh:
      addSolid(*solid, faces);
      break;
    case ShapeKind::Polyline:
    case ShapeKind::Particles:
      break;  // nobody knows where the surface of particles is
  }
  return faces;
}

template struct Face<2>;
template struct Face<3>;
template std::vector<Face<2>> facesOf<2>(const Shape&, const Solid<2>*);
template std::vector<Face<3>> facesOf<3>(const Shape&, const Solid<3>*);

}  // namespace treacle
