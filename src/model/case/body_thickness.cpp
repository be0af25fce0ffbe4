#include "body_thickness.hpp"

#include "geometry/body_region.hpp"
#include "treacle/core/pseudo_random.hpp"
#include "treacle/model/geometry/shape.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

namespace treacle {
namespace {

constexpr double unbounded = std::numeric_limits<double>::infinity();

/// Along the axes and between them, some twice; none along a periodic axis that the body goes on across.
template <int D>
std::vector<Vec<D>> directionsOf(const std::array<bool, 3>& goesOn) {
  std::vector<Vec<D>> directions;
  const int most = D == 2 ? 2 : 1, numbers = 2 * most + 1, count = D == 2 ? numbers * numbers : 27;
  for (int code = count / 2 + 1; code < count; ++code) {
    Vec<D> v;
    bool along = false;
    for (int k = 0, rest = code; k < D; ++k, rest /= numbers) {
      v[k] = rest % numbers - most;
      along = along || (v[k] != 0 && goesOn[static_cast<std::size_t>(k)]);
    }
    if (!along) directions.push_back(v * (1 / norm(v)));
  }
  return directions;
}

/// From a place of a body to its end, no farther than `most` [m].
template <int D>
double wayOut(const BodyRegion<D>& region, const Vec<D>& x, const Vec<D>& direction, double spacing, double most) {
  double inside = 0;
  while (region.holds(x + (inside + spacing) * direction)) {
    inside += spacing;
    if (inside >= most) return most;
  }
  double outside = inside + spacing;
  for (int k = 0; k < 6; ++k) {
    const double middle = (inside + outside) / 2;
    (region.holds(x + middle * direction) ? inside : outside) = middle;
  }
  return (inside + outside) / 2;
}

/// Twice the longest of the ways from many places of a body to its end; at most `most`, which it is where no place
/// is found.
template <int D>
double measuredThickness(const Case& c, const Body& body, const std::array<bool, 3>& goesOn, double most) {
  constexpr int places = 2000;
  constexpr std::uint32_t tries = 20000;
  const BodyRegion<D> region(c, body);
  const Extent box = boundingBox(body.shape, c.dimensions);
  const std::vector<Vec<D>> directions = directionsOf<D>(goesOn);
  double longest = 0;
  int found = 0;
  for (std::uint32_t k = 0; k < tries && found < places; ++k) {
    Vec<D> x;
    for (int axis = 0; axis < D; ++axis)
      x[axis] = box.min[axis] + (0.5 + 0.5 * pseudoRandom(D * k + static_cast<std::uint32_t>(axis))) *
                                    (box.max[axis] - box.min[axis]);
    if (!region.holds(x)) continue;
    ++found;
    double shortest = most / 2;
    for (const Vec<D>& direction : directions)
      for (const Vec<D>& way : {direction, -direction})
        if (shortest > longest) shortest = std::min(shortest, wayOut(region, x, way, c.spacing, shortest));
    longest = std::max(longest, shortest);
  }
  return found > 0 ? 2 * longest : most;
}

}  // namespace

std::pair<double, std::string> ownThickness(const Shape& s, int dimensions) {
  if (s.kind == ShapeKind::Box) {
    int thinnest = 0;
    for (int k = 1; k < dimensions; ++k)
      if (s.max[k] - s.min[k] < s.max[thinnest] - s.min[thinnest]) thinnest = k;
    return {s.max[thinnest] - s.min[thinnest], std::string("along ") + "xyz"[thinnest]};
  }
  if (s.kind == ShapeKind::Torus)
    return {s.innerRadius > 0 ? s.tubeRadius - s.innerRadius : 2 * s.tubeRadius, "across its tube"};
  if (s.kind == ShapeKind::Cone) {
    const bool hollow = s.innerStartRadius > 0 || s.innerEndRadius > 0;
    const double widest = 2 * std::max(s.startRadius, s.endRadius);
    const double across =
        hollow ? std::max(s.startRadius - s.innerStartRadius, s.endRadius - s.innerEndRadius) : widest;
    const double length = norm(s.end - s.start);
    return length < across ? std::pair{length, std::string("along its axis")}
                           : std::pair{across, std::string(hollow ? "between its radii" : "across")};
  }
  const double radial = s.innerRadius > 0 ? s.radius - s.innerRadius : 2 * s.radius;
  const double length = norm(s.end - s.start);
  if (s.kind == ShapeKind::Cylinder && length < radial) return {length, "along its axis"};
  return {radial, s.innerRadius > 0 ? "between its radii" : "across"};
}

double fluidThickness(const Case& c, const Body& body) {
  const Shape& s = body.shape;
  const auto& periodic = c.domain.periodic;
  const bool own = s.transform && std::ranges::none_of(periodic, std::identity{});  // before it is turned
  const Extent box = own ? untransformedBox(s, c.dimensions) : boundingBox(s, c.dimensions);
  const double scale = s.transform ? s.transform->scale : 1;
  double side = unbounded, period = unbounded;
  std::array<bool, 3> goesOn{};
  for (int k = 0; k < c.dimensions; ++k) {
    const auto axis = static_cast<std::size_t>(k);
    const double extent = (own ? scale : 1) * (box.max[k] - box.min[k]),
                 length = c.domain.max[k] - c.domain.min[k];
    goesOn[axis] = periodic[axis] && extent > length - c.spacing;
    double& least = goesOn[axis] ? period : side;
    least = std::min(least, extent);
  }
  if (!std::isfinite(side)) return period;
  const bool round = s.kind == ShapeKind::Sphere || s.kind == ShapeKind::Cylinder || s.kind == ShapeKind::Cone ||
                     s.kind == ShapeKind::Torus;
  if (round && std::ranges::none_of(goesOn, std::identity{}))
    side = std::min(side, scale * ownThickness(s, c.dimensions).first);
  const bool solid = (s.kind == ShapeKind::Polygon && s.points.size() > 2) ||
                     (s.kind == ShapeKind::Mesh && s.file.mesh.value && !s.isThinSheet());
  if (s.kind == ShapeKind::Particles || (!solid && body.where.empty() && body.subtract.empty())) return side;
  if (s.kind == ShapeKind::Mesh && !solid) return side;
  return c.dimensions == 2 ? measuredThickness<2>(c, body, goesOn, side)
                           : measuredThickness<3>(c, body, goesOn, side);
}

}  // namespace treacle
