#include "treacle/model/checks.hpp"

#include "body_points.hpp"
#include "treacle/model/names.hpp"
#include "treacle/model/shape.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace treacle {
namespace {

constexpr double rounding = 1e-6;  // relative error allowed in "a whole number of steps"

bool wholeNumber(double x) { return std::abs(x - std::round(x)) <= rounding * std::max(1.0, std::abs(x)); }

/// Extent of all fluid bodies along gravity [m].
double fluidHeight(const Case& c) {
  const double g = norm(c.gravity);
  if (g == 0) return 0;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Body& body : c.bodies) {
    if (body.kind != BodyKind::Fluid) continue;
    const Extent box = boundingBox(body.shape, c.dimensions);
    for (int k = 0; k < 8; ++k) {
      const Vec<3> corner{k & 1 ? box.max[0] : box.min[0], k & 2 ? box.max[1] : box.min[1],
                          k & 4 ? box.max[2] : box.min[2]};
      const double along = dot(corner, c.gravity) / g;
      low = std::min(low, along), high = std::max(high, along);
    }
  }
  return std::max(0.0, high - low);
}

/// Thinnest extent of a wall [m], with the words that say where.
std::pair<double, std::string> thickness(const Shape& s, int dimensions) {
  if (s.kind == ShapeKind::Box) {
    int thinnest = 0;
    for (int k = 1; k < dimensions; ++k)
      if (s.max[k] - s.min[k] < s.max[thinnest] - s.min[thinnest]) thinnest = k;
    return {s.max[thinnest] - s.min[thinnest], std::string("along ") + "xyz"[thinnest]};
  }
  const double radial = s.innerRadius > 0 ? s.radius - s.innerRadius : 2 * s.radius;
  const double length = norm(s.end - s.start);
  if (s.kind == ShapeKind::Cylinder && length < radial) return {length, "along its axis"};
  return {radial, s.innerRadius > 0 ? "between its radii" : "across"};
}

/// Largest speed of a fluid body at the start, of a wall at any time [m/s].
template <int D>
double largestSpeed(const Case& c, const Body& body) {
  const Oscillation& o = body.oscillation;
  const double carried =
      norm(body.velocity) + (o.period > 0 ? 2 * std::numbers::pi * norm(o.amplitude) / o.period : 0);
  const bool expressions = body.velocityExpression != decltype(body.velocityExpression){};
  if (!expressions && !body.rotation) return carried;
  const InitialVelocity<D> velocity(c, body);
  const WallMotion<D> wall = wallMotion<D>(c.domain, body, 0, 0);
  std::vector<std::string> notes;
  double speed = 0;
  for (const Vec<D>& x : bodyPoints<D>(c, body, notes))
    speed = std::max(speed, norm(body.rotation ? wall.swirl(wall.arm(x)) : velocity.at(x)));
  return body.rotation ? carried + speed : speed;
}

/// What the interaction radius is called.
std::string_view reachName(const Case& c) {
  if (c.method.kind == MethodKind::Isph) return "reach 2 h of the kernel";
  if (c.viscosityRadius() >= c.densityRadius()) return "viscosity radius h_v";
  return c.densityRadius() > c.pressureRadius() ? "density radius h_n" : "pressure radius h_p";
}

void warnCompression(const Case& c, std::vector<std::string>& warnings) {
  for (const StabilityNumbers& n : stabilityNumbers(c)) {
    if (n.compression <= 1 + rounding) continue;
    std::string advice = "give it a bulk_viscosity of at least bulk_modulus times the step";
    if (std::isfinite(n.compression))
      advice = fmt::format("take bulk_modulus <= bulk_viscosity / step, or a step of at most {:.3g} s",
                           c.time.step / n.compression);
    warnings.push_back(
        fmt::format("material '{}': dt kappa / lambda = {:.4g} is greater than 1, the step may be unstable; {}",
                    n.material, n.compression, advice));
  }
}

void warnThinWalls(const Case& c, std::vector<std::string>& warnings) {
  for (const Body& body : c.bodies) {
    if (body.kind != BodyKind::Wall) continue;
    const auto [extent, where] = thickness(body.shape, c.dimensions);
    const double reach = c.interactionRadius();
    if (extent >= reach * (1 - rounding)) continue;
    warnings.push_back(fmt::format(
        "wall '{}' is {} thick {}, thinner than the {} = {} ({:g} spacings): fluid next to it misses neighbours",
        body.name, lengthText(extent), where, reachName(c), lengthText(reach), reach / c.spacing));
  }
}

/// Sums over particles are to stand for integrals. With radii from these on, those of a Wendland function over a
/// cubic lattice vary by less than 2.5 % with the place, of its slope times r by less than 6 %, and those of the
/// biquadratic weight times r^2 by less than 4.5 %; at 2 spacings the former vary by up to 6 % (C2) and 25 % (C4),
/// at 1.75 the latter by 7 %.
void warnShortRadii(const Case& c, std::vector<std::string>& warnings) {
  const MethodSettings& m = c.method;
  if (m.kind != MethodKind::MphI) return;
  const auto check = [&](std::string_view key, double radius, double least, std::string_view weight) {
    if (radius >= least * (1 - rounding)) return;
    warnings.push_back(fmt::format(
        "method.{} = {:g} spacings is short for the weight '{}', expected at least {:g}: sums over so few "
        "neighbours depend on where these stand",
        key, radius, weight, least));
  };
  const bool mps = m.pressureWeight == PressureWeight::Mps;  // needs the neighbours along the diagonal
  check("pressure_radius", m.pressureRadius, mps ? 1.5 : 2.5, nameOf(m.pressureWeight));
  check("viscosity_radius", m.viscosityRadius, m.viscosityWeight == ViscosityWeight::Mps ? 1.5 : 2,
        nameOf(m.viscosityWeight));
}

/// Largest of the initial speeds and those of the walls [m/s].
double givenSpeed(const Case& c) {
  double speed = 0;
  for (const Body& body : c.bodies)
    speed = std::max(speed, c.dimensions == 2 ? largestSpeed<2>(c, body) : largestSpeed<3>(c, body));
  return speed;
}

/// Of the longest step that a run makes.
double courantNumberAt(const Case& c, double speed) {
  const double number = speed * c.time.step / c.spacing;
  return c.time.stepsVary() ? std::min(number, c.time.courant) : number;
}

/// The forces of MPH-I are implicit but for gravity; ISPH moves on what it has at the start of a step. How fast a
/// viscous fluid falls nobody knows before, so with MPH-I the speeds that the case gives count alone.
void warnCourant(const Case& c, std::vector<std::string>& warnings) {
  const bool isph = c.method.kind == MethodKind::Isph;
  const double largest = isph ? 0.5 : 1, number = isph ? courantNumber(c) : courantNumberAt(c, givenSpeed(c));
  if (number <= largest * (1 + rounding)) return;
  warnings.push_back(fmt::format(
      "the Courant number of steps of {:g} s is {:.3g}, more than {:g}: {}; take steps of at most {:.2g} "
      "s, or let time.courant limit them",
      c.time.step, number, largest,
      isph ? "the step may be unstable" : "particles may pass each other or enter walls in a step",
      c.time.step * largest / number));
}

void warnTimes(const Case& c, std::vector<std::string>& warnings) {
  if (!wholeNumber(c.time.end / c.time.step))
    warnings.push_back(fmt::format(
        "time.end = {:g} s is not a whole number of steps of {:g} s; the run makes {} steps and ends at {:.6g} s",
        c.time.end, c.time.step, c.steps(), static_cast<double>(c.steps()) * c.time.step));
  if (c.output.interval > 0 && !wholeNumber(c.output.interval / c.time.step))
    warnings.push_back(
        fmt::format("output.interval = {:g} s is not a whole number of steps of {:g} s; frames are written at "
                    "the nearest step",
                    c.output.interval, c.time.step));
}

}  // namespace

std::vector<StabilityNumbers> stabilityNumbers(const Case& c) {
  std::vector<StabilityNumbers> numbers;
  for (const Material& m : c.materials) {
    const double diffusion = c.time.step / (m.density * c.spacing * c.spacing);
    const bool elastic = c.method.kind == MethodKind::MphI && m.bulkModulus > 0;
    const double compression = elastic ? c.time.step * m.bulkModulus / m.bulkViscosity : 0;
    numbers.push_back({m.name, compression, m.dynamicViscosity * diffusion, m.bulkViscosity * diffusion});
  }
  return numbers;
}

double courantNumber(const Case& c) {
  return courantNumberAt(c, std::max(givenSpeed(c), std::sqrt(2 * norm(c.gravity) * fluidHeight(c))));
}

std::vector<std::string> caseWarnings(const Case& c) {
  std::vector<std::string> warnings;
  warnCompression(c, warnings);
  warnCourant(c, warnings);
  warnThinWalls(c, warnings);
  warnShortRadii(c, warnings);
  if (!c.time.stepsVary()) warnTimes(c, warnings);
  return warnings;
}

}  // namespace treacle
