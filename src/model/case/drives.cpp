#include "drives.hpp"

#include "geometry/body_region.hpp"
#include "particles/fluid_extent.hpp"
#include "treacle/model/geometry/shape.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

namespace treacle {
namespace {

/// Of the face of an opening, a disc or a rectangle [m2; m in 2D].
double areaOf(const Nozzle& n, int dimensions) {
  if (n.kind == NozzleKind::Disc) return dimensions == 2 ? 2 * n.radius : std::numbers::pi * n.radius * n.radius;
  return dimensions == 2 ? n.width : n.width * n.height;
}

/// Longest side of a box around fluid bodies and openings [m].
double longestWay(const Case& c) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Vec<3> low = Vec<3>::filled(infinity), high = Vec<3>::filled(-infinity);
  const auto add = [&](const Extent& box) {
    for (int k = 0; k < 3; ++k) low[k] = std::min(low[k], box.min[k]), high[k] = std::max(high[k], box.max[k]);
  };
  for (const Body& body : c.bodies)
    if (body.kind == BodyKind::Fluid) add(boundingBox(body.shape, c.dimensions));
  for (const Opening& o : c.openings) add({o.face.center, o.face.center});
  double longest = 0;
  for (int k = 0; k < c.dimensions; ++k) longest = std::max(longest, high[k] - low[k]);
  return longest;
}

/// The largest force on a body along an axis that it may go along, over its cross-section there [Pa].
double pressureOfForce(const Case& c, const Body& body) {
  if (body.kind != BodyKind::Rigid || body.rigid.hinge) return 0;
  const Extent box = boundingBox(body.shape, c.dimensions);
  double most = 0;
  for (std::size_t k = 0; k < static_cast<std::size_t>(c.dimensions); ++k) {
    if (!body.rigid.force[k] || !body.rigid.translates[k]) continue;
    double section = 1;
    for (int j = 0; j < c.dimensions; ++j)
      if (j != static_cast<int>(k)) section *= box.max[j] - box.min[j];
    if (section > 0) most = std::max(most, largestSize(*body.rigid.force[k], 0, c.time.end) / section);
  }
  return most;
}

/// Shortest and longest side of a fluid body that is a box, of those that do not go on across periodic ends, and
/// whether walls are all around it.
template <int D>
class ClosedBox {
 public:
  ClosedBox(const Case& c, const Body& body) : body_(body), spacing_(c.spacing) {
    for (int k = 0; k < D; ++k)
      goesOn_[k] = c.domain.periodic[static_cast<std::size_t>(k)] &&
                   side(k) > c.domain.max[k] - c.domain.min[k] - c.spacing;
  }

  double shortest() const {
    double least = std::numeric_limits<double>::infinity();
    for (int k = 0; k < D; ++k)
      if (!goesOn_[k]) least = std::min(least, side(k));
    return least;
  }
  double longest() const {
    double most = 0;
    for (int k = 0; k < D; ++k)
      if (!goesOn_[k]) most = std::max(most, side(k));
    return most;
  }

  bool isWithin(const std::vector<BodyRegion<D>>& walls) const {
    for (int k = 0; k < 2 * D; ++k)
      if (!goesOn_[k / 2] && !isBehind(k / 2, k % 2 == 1, walls)) return false;
    return true;
  }

 private:
  static constexpr int samples = 15;  // along each axis of a face

  double side(int k) const { return body_.shape.max[k] - body_.shape.min[k]; }

  /// Whether there is a wall a spacing behind all places of a face.
  bool isBehind(int axis, bool upper, const std::vector<BodyRegion<D>>& walls) const {
    int count = 1;
    for (int k = 1; k < D; ++k) count *= samples;
    for (int sample = 0; sample < count; ++sample) {
      Vec<D> x{};
      for (int k = 0, rest = sample; k < D; ++k) {
        if (k == axis) {
          x[k] = upper ? body_.shape.max[k] + spacing_ : body_.shape.min[k] - spacing_;
        } else {
          x[k] = body_.shape.min[k] + (rest % samples + 0.5) / samples * side(k);
          rest /= samples;
        }
      }
      if (std::ranges::none_of(walls, [&](const BodyRegion<D>& wall) { return wall.holds(x); })) return false;
    }
    return true;
  }

  const Body& body_;
  double spacing_;
  bool goesOn_[D];
};

/// What walls that go along a closed gap of length L and width h build up, over the viscosity: 6 U L/h^2 of a film
/// without a net flow, less what a cavity has as well, in which the fluid turns back at once [1/s].
template <int D>
double shearInFilms(const Case& c) {
  double slowest = std::numeric_limits<double>::infinity(), fastest = 0;
  for (const Body& body : c.bodies) {
    if (body.kind != BodyKind::Wall || body.rotation) continue;
    const double speed = largestSpeedOf(c, body);
    slowest = std::min(slowest, speed), fastest = std::max(fastest, speed);
  }
  if (!(fastest > slowest)) return 0;
  std::vector<BodyRegion<D>> walls;
  double most = 0;
  for (const Body& body : c.bodies) {
    if (body.kind != BodyKind::Fluid || body.shape.kind != ShapeKind::Box || body.shape.transform) continue;
    const ClosedBox<D> box(c, body);
    const double h = box.shortest(), shear = 6 * (fastest - slowest) * (box.longest() / h - 1) / h;
    if (!(h > 0) || !(shear > most)) continue;
    if (walls.empty())
      for (const Body& wall : c.bodies)
        if (wall.kind == BodyKind::Wall && !wall.shape.isThinSheet()) walls.emplace_back(c, wall);
    if (box.isWithin(walls)) most = shear;
  }
  return most;
}

}  // namespace

double largestSize(const TimeFunction& f, double from, double to) {
  constexpr int samples = 1000;
  double most = 0;
  for (const double x : f.values) most = std::max(most, std::abs(x));
  for (int k = 0; k < (f.isConstant() ? 1 : samples); ++k)
    most = std::max(most, std::abs(f.at(from + k * (to - from) / samples)));
  return most;
}

double widthOf(const Nozzle& n, int dimensions) {
  if (n.kind == NozzleKind::Disc) return n.innerRadius > 0 ? n.radius - n.innerRadius : 2 * n.radius;
  if (n.kind == NozzleKind::Rectangle) return dimensions == 3 ? std::min(n.width, n.height) : n.width;
  Vec<2> low{}, high{};
  for (const Vec<2>& x : n.points)
    for (int k = 0; k < 2; ++k) low[k] = std::min(low[k], x[k]), high[k] = std::max(high[k], x[k]);
  return std::min(high[0] - low[0], high[1] - low[1]);
}

Drives drivesOf(const Case& c, double length) {
  // Of the flow through a slit or tube: pressure over mu U L/h^2, and largest over mean speed.
  const double resistance = c.dimensions == 2 ? 12 : 32, peak = c.dimensions == 2 ? 1.5 : 2;
  Drives drives;
  const double longest = longestWay(c);
  const auto press = [&](double pressure, double width) {
    const double way = std::max(longest, width);
    drives.pressure = std::max(drives.pressure, pressure);
    if (way > 0) drives.seep = std::max(drives.seep, peak * pressure * width * width / (resistance * way));
  };
  for (const Opening& o : c.openings) {
    const double width = widthOf(o.face, c.dimensions), area = areaOf(o.face, c.dimensions);
    if (o.pressure) press(largestSize(*o.pressure, 0, c.time.end), width);
    if (!o.flowRate || !(area > 0)) continue;
    const double speed = largestSize(*o.flowRate, 0, c.time.end) / area;
    drives.speed = std::max(drives.speed, speed);
    drives.shear = std::max(drives.shear, resistance * speed * std::max(longest, width) / (width * width));
  }
  for (const Body& body : c.bodies) press(pressureOfForce(c, body), length);
  drives.shear = std::max(drives.shear, c.dimensions == 2 ? shearInFilms<2>(c) : shearInFilms<3>(c));
  return drives;
}

}  // namespace treacle
