#include "lattice.hpp"

#include "geometry/polygon.hpp"
#include "geometry/solid_points.hpp"
#include "treacle/core/error.hpp"
#include "treacle/model/geometry/mesh.hpp"
#include "treacle/model/geometry/shape.hpp"
#include "treacle/model/particles/create.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace treacle {
namespace {

constexpr double rounding = 1e-6;  // [spacings]

/// Lattice points `origin + k spacing` with low <= k < high on each axis, which then go through the transform of
/// their shape.
template <int D>
struct Lattice {
  double spacing;  // before the transform
  Vec<D> origin;
  Vec<D> low, high;  // whole numbers; double, so that absurd extents do not overflow

  double points() const {
    double product = 1;
    for (int k = 0; k < D; ++k) product *= high[k] - low[k];
    return product;
  }
};

/// How far a point is from the boxes around all fluid at the start and from the nozzles [m].
double distanceToFluid(const Case& c, const Vec<3>& x) {
  double least = std::numeric_limits<double>::infinity();
  for (const Body& body : c.bodies) {
    if (!body.holdsFluid()) continue;
    const bool nozzle = body.kind == BodyKind::Inflow;
    const Extent box = nozzle ? Extent{body.inflow.nozzle.center, body.inflow.nozzle.center}
                              : boundingBox(body.shape, c.dimensions);
    Vec<3> d{};
    for (int k = 0; k < c.dimensions; ++k) d[k] = x[k] - std::clamp(x[k], box.min[k], box.max[k]);
    least = std::min(least, norm(d));
  }
  return least;
}

/// Whether the particles of a box begin at the face `max` of an axis: that of a wall which is nearer to the fluid.
template <int D>
bool beginsAtMax(const Case& c, const Body& body, int axis) {
  if (body.kind != BodyKind::Wall) return false;
  const Similarity<D> similarity = similarityOf<D>(body.shape);
  const auto distance = [&](double along) {
    Vec<D> middle = 0.5 * resized<D>(body.shape.min + body.shape.max);
    middle[axis] = along;
    return distanceToFluid(c, resized<3>(similarity.point(middle)));
  };
  return distance(body.shape.max[axis]) < distance(body.shape.min[axis]) - rounding * c.spacing;
}

template <int D>
Lattice<D> boxLattice(const Case& c, const Body& body, double spacing, std::vector<std::string>& notes) {
  Lattice<D> lattice{};
  lattice.spacing = spacing;
  for (int k = 0; k < D; ++k) {
    const double min = body.shape.min[k], max = body.shape.max[k];
    const double spacings = (max - min) / spacing;
    const double count = std::max(1.0, std::round(spacings));
    lattice.origin[k] = min + spacing / 2;
    lattice.high[k] = count;
    if (std::abs(spacings - count) <= rounding * std::max(1.0, spacings)) continue;
    const bool fromMax = beginsAtMax<D>(c, body, k);
    if (fromMax) lattice.origin[k] = max - (count - 0.5) * spacing;
    notes.push_back(fmt::format(
        "body '{}': {} along {} is {:.6g} spacings; filled with {:.0f} particle{} from its {} corner ({})",
        body.name, lengthText(spacings * c.spacing), "xyz"[k], spacings, count, count == 1 ? "" : "s",
        fromMax ? "max" : "min", lengthText(count * c.spacing)));
  }
  return lattice;
}

template <int D>
Lattice<D> roundLattice(const Body& body, double spacing) {
  const Shape& s = body.shape;
  Lattice<D> lattice{};
  lattice.spacing = spacing;
  lattice.origin = resized<D>(s.center);
  if (s.kind == ShapeKind::Cylinder || s.kind == ShapeKind::Cone) {
    // Half a spacing along the axis: layers of particles stand in the middle of slices, as in a box.
    const Vec<D> axis = resized<D>(s.end - s.start);
    lattice.origin = resized<D>(s.start) + axis * (spacing / 2 / norm(axis));
  }
  const Extent box = untransformedBox(s, D);
  for (int k = 0; k < D; ++k) {
    lattice.low[k] = std::floor((box.min[k] - lattice.origin[k]) / spacing);
    lattice.high[k] = std::ceil((box.max[k] - lattice.origin[k]) / spacing) + 1;
  }
  return lattice;
}

/// Before the transform of a shape.
double spacingOf(const Body& body, double spacing) {
  return body.shape.transform ? spacing / body.shape.transform->scale : spacing;
}

/// What a closed mesh holds at least: the inside that is farther from its surface than the middle of a cell from
/// its corners.
double meshPoints(const Mesh& mesh, double spacing) {
  const double rim = std::sqrt(3.0) / 2 * spacing * mesh.facts().area;
  return mesh.facts().closed() ? std::max(0.0, std::abs(mesh.facts().volume) - rim) / std::pow(spacing, 3) : 0;
}

/// What a polygon, or the prism of one, holds at least, likewise.
double polygonPoints(const Shape& s, int dimensions, double spacing) {
  double length = 0;
  for (std::size_t k = 0; k < s.points.size(); ++k)
    length += norm(s.points[(k + 1) % s.points.size()] - s.points[k]);
  const double rim = std::sqrt(0.5) * spacing * length,
               area = std::max(0.0, std::abs(signedArea2(s.points)) / 2 - rim);
  const double layers = dimensions == 3 ? std::max(0.0, (s.top - s.bottom) / spacing - 1) : 1;
  return area / (spacing * spacing) * layers;
}

bool isInDomain(const Case& c, const Shape& s) {
  const Extent box = boundingBox(s, c.dimensions);
  for (int k = 0; k < c.dimensions; ++k)
    if (box.min[k] < c.domain.min[k] || box.max[k] > c.domain.max[k]) return false;
  return true;
}

/// What a round shape holds at least: the volume that is farther from its surface than a spacing.
double roundPoints(const Shape& s, int dimensions, double spacing) {
  constexpr double pi = std::numbers::pi;
  const auto ball = [&](double r) { return dimensions == 2 ? pi * r * r : 4 * pi / 3 * r * r * r; };
  const auto across = [&](double r) { return dimensions == 2 ? 2 * r : pi * r * r; };
  const auto shell = [&](auto&& content, double outer, double inner) {
    const double in = inner > 0 ? inner + spacing : 0, out = outer - spacing;
    return out > in ? content(out) - content(in) : 0;
  };
  double volume = 0;
  if (s.kind == ShapeKind::Sphere) volume = shell(ball, s.radius, s.innerRadius);
  if (s.kind == ShapeKind::Cylinder)
    volume = shell(across, s.radius, s.innerRadius) * std::max(0.0, norm(s.end - s.start) - 2 * spacing);
  if (s.kind == ShapeKind::Torus) volume = 2 * pi * s.radius * shell(across, s.tubeRadius, s.innerRadius);
  return volume / std::pow(spacing, dimensions);
}

}  // namespace

double leastPoints(const Case& c) {
  std::vector<std::string> notes;
  double points = 0;
  for (const Body& body : c.bodies) {
    if (!body.where.empty() || !body.subtract.empty()) continue;
    const Shape& s = body.shape;
    const double spacing = spacingOf(body, c.spacing);
    if (s.kind == ShapeKind::Box)
      points += c.dimensions == 2 ? boxLattice<2>(c, body, spacing, notes).points()
                                  : boxLattice<3>(c, body, spacing, notes).points();
    if (isInDomain(c, s)) points += roundPoints(s, c.dimensions, spacing);  // else its first particle ends it
    if (s.kind == ShapeKind::Polygon && s.fill == FillKind::Inside && isInDomain(c, s))
      points += polygonPoints(s, c.dimensions, spacing);
    if (s.kind == ShapeKind::Mesh && s.fill == FillKind::Inside && s.file.mesh.value)
      points += meshPoints(*s.file.mesh.value, spacing);
    if (s.kind == ShapeKind::Particles && s.file.particles.value)
      points += static_cast<double>(s.file.particles.value->position.size());
  }
  return points;
}

template <int D>
std::vector<Vec<D>> latticePoints(const Case& c, const Body& body, std::vector<std::string>& notes,
                                  const std::function<bool(const Vec<D>&)>& keep) {
  if (body.shape.isThinSheet()) return sheetPoints<D>(c, body, notes, keep);
  if (isSolid(body.shape)) return solidPoints<D>(c, body, notes, keep);
  const bool box = body.shape.kind == ShapeKind::Box;
  const double spacing = spacingOf(body, c.spacing);
  const Lattice<D> lattice = box ? boxLattice<D>(c, body, spacing, notes) : roundLattice<D>(body, spacing);
  const Similarity<D> similarity = similarityOf<D>(body.shape);

  // A thin shell fills little of its bounding box; beyond 16 times the limit searching it is no use either.
  if (lattice.points() > static_cast<double>(maxParticles) * (box ? 1 : 16)) throw tooManyPoints(body);

  std::vector<Vec<D>> points;
  if (box) points.reserve(static_cast<std::size_t>(lattice.points()));
  Vec<D> k = lattice.low;
  for (int axis = 0; axis < D;) {
    const Vec<D> local = lattice.origin + k * spacing;
    if (box || contains<D>(body.shape, local, rounding * spacing))
      if (const Vec<D> x = similarity.point(local); keep(x)) points.push_back(x);
    if (points.size() > maxParticles) throw tooManyPoints(body);
    for (axis = 0; axis < D; ++axis) {
      if (++k[axis] < lattice.high[axis]) break;
      k[axis] = lattice.low[axis];
    }
  }
  return points;
}

template std::vector<Vec<2>> latticePoints<2>(const Case&, const Body&, std::vector<std::string>&,
                                              const std::function<bool(const Vec<2>&)>&);
template std::vector<Vec<3>> latticePoints<3>(const Case&, const Body&, std::vector<std::string>&,
                                              const std::function<bool(const Vec<3>&)>&);

}  // namespace treacle
