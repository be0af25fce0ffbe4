#include "likely_mistakes.hpp"

#include "geometry/body_region.hpp"
#include "treacle/model/geometry/shape.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace treacle {
namespace {

void warnUnits(const Case& c, std::vector<std::string>& warnings) {
  constexpr double zeroCelsius = 273.15, coldest = 200, thinnest = 1e4, strongest = 200;
  if (c.heat && c.heat->ambient < coldest)
    warnings.push_back(
        fmt::format("heat.ambient_temperature is {:g} K. Are these degrees Celsius? Expected kelvin, {:g}",
                    c.heat->ambient, c.heat->ambient + zeroCelsius));
  if (c.gas && c.gas->pressure > 0 && c.gas->pressure < thinnest)
    warnings.push_back(
        fmt::format("gas.pressure is {:g} Pa, and that of the atmosphere is 101325 Pa; expected the "
                    "absolute pressure of the air in Pa, not in kPa or bar",
                    c.gas->pressure));
  if (const double g = norm(c.gravity); !c.frame && g > strongest)
    warnings.push_back(
        fmt::format("gravity.acceleration is {:g} m/s2, {:.3g} times that of the earth; expected m/s2, "
                    "and a [frame] for a centrifuge",
                    g, g / 9.81));
}

bool isOutside(const Case& c, const Vec<3>& min, const Vec<3>& max) {
  for (int k = 0; k < c.dimensions; ++k)
    if (max[k] <= c.domain.min[k] || min[k] >= c.domain.max[k]) return true;
  return false;
}

bool isOutside(const Case& c, const Outflow& o) {
  if (o.kind == OutflowKind::Box) return isOutside(c, o.min, o.max);
  double farthest = 0;  // corner of the domain along the normal, from the point
  for (int k = 0; k < c.dimensions; ++k)
    farthest += o.normal[k] * ((o.normal[k] > 0 ? c.domain.max : c.domain.min)[k] - o.point[k]);
  return farthest <= 0;
}

/// Whether walls hold all of what a vent has in the domain, where they are at the start.
template <int D>
bool isWalledUp(const Case& c, const Vent& vent) {
  constexpr int most = 20;  // places along an axis
  std::vector<BodyRegion<D>> walls;
  for (const Body& body : c.bodies)
    if (body.isWall() && !body.shape.isThinSheet() && body.shape.kind != ShapeKind::Particles)
      walls.emplace_back(c, body);
  Vec<D> low, side;
  int counts[D], all = 1;
  for (int k = 0; k < D; ++k) {
    low[k] = std::max(vent.min[k], c.domain.min[k]);
    side[k] = std::min(vent.max[k], c.domain.max[k]) - low[k];
    counts[k] = static_cast<int>(std::clamp(std::ceil(2 * side[k] / c.spacing), 1.0, double{most}));
    all *= counts[k];
  }
  for (int place = 0; place < all; ++place) {
    Vec<D> x;
    for (int k = 0, rest = place; k < D; rest /= counts[k], ++k)
      x[k] = low[k] + (rest % counts[k] + 0.5) / counts[k] * side[k];
    if (std::ranges::none_of(walls, [&](const BodyRegion<D>& wall) { return wall.holds(x); })) return false;
  }
  return true;
}

void warnPlaces(const Case& c, std::vector<std::string>& warnings) {
  const auto warn = [&](std::string_view what, const std::string& name) {
    warnings.push_back(fmt::format("{} '{}' is without effect: all of it is outside the domain, {}", what, name,
                                   rangeText(c.domain.min, c.domain.max, c.dimensions)));
  };
  for (const Outflow& o : c.outflows)
    if (isOutside(c, o)) warn("outflow", o.name);
  for (const Probe& p : c.probes)
    if (p.box && isOutside(c, p.box->min, p.box->max)) warn("the box of probe", p.name);
  if (!c.gas) return;
  for (const Vent& v : c.gas->vents) {
    if (isOutside(c, v.min, v.max))
      warn("vent", v.name);
    else if (c.dimensions == 2 ? isWalledUp<2>(c, v) : isWalledUp<3>(c, v))
      warnings.push_back(fmt::format(
          "vent '{}' is without effect: walls fill all of it; expected a box that reaches into the gas", v.name));
  }
}

void warnLateTimes(const Case& c, std::vector<std::string>& warnings) {
  for (const Probe& p : c.probes)
    if (p.interval > c.time.end * (1 + 1e-9))
      warnings.push_back(
          fmt::format("probe '{}' reads {}: its interval of {:g} s is longer than the run of {:g} s", p.name,
                      p.isOnWall() ? "nothing" : "the state at the start only", p.interval, c.time.end));
  for (const Body& b : c.bodies)
    if (b.kind == BodyKind::Rigid && b.rigid.release >= c.time.end)
      warnings.push_back(
          fmt::format("rigid body '{}' stands still: its release at {:g} s is not before the end of "
                      "the run, {:g} s",
                      b.name, b.rigid.release, c.time.end));
}

void warnMaterialsOfProbes(const Case& c, std::vector<std::string>& warnings) {
  for (const Probe& p : c.probes) {
    if (!p.isSummed() || p.material.empty()) continue;
    const auto isOfIt = [&](int material) {
      const auto index = static_cast<std::size_t>(material);
      return index < c.materials.size() && c.materials[index].name == p.material;
    };
    if (std::ranges::any_of(c.bodies, [&](const Body& b) { return b.holdsFluid() && isOfIt(b.material); }))
      continue;
    warnings.push_back(
        fmt::format("probe '{}' finds nothing: no fluid is made of its material '{}'", p.name, p.material));
  }
}

/// A round body has a particle at its centre however small it is. Notes say how boxes are rounded.
void warnSmallBodies(const Case& c, std::vector<std::string>& warnings) {
  for (const Body& b : c.bodies) {
    const ShapeKind kind = b.shape.kind;
    if (b.kind == BodyKind::Inflow || (kind != ShapeKind::Sphere && kind != ShapeKind::Cylinder)) continue;
    const Extent box = boundingBox(b.shape, c.dimensions);
    double largest = 0;
    for (int k = 0; k < c.dimensions; ++k) largest = std::max(largest, box.max[k] - box.min[k]);
    if (largest < 0.5 * c.spacing)
      warnings.push_back(
          fmt::format("body '{}' is {} large, less than half of the spacing {}; it becomes one "
                      "particle, which has the size of the spacing",
                      b.name, lengthText(largest), lengthText(c.spacing)));
  }
}

}  // namespace

void warnLikelyMistakes(const Case& c, std::vector<std::string>& warnings) {
  warnUnits(c, warnings);
  warnPlaces(c, warnings);
  warnLateTimes(c, warnings);
  warnMaterialsOfProbes(c, warnings);
  warnSmallBodies(c, warnings);
  if (c.method.kind != MethodKind::MphI || c.method.scheme != SchemeKind::Published) return;
  if (c.method.tensionLimit > 0)
    warnings.push_back(
        "method.tension_limit is without effect: the scheme \"published\" has no tension; expected the scheme "
        "\"accurate\" beside it");
  for (const Material& m : c.materials)
    if (m.slipLength > 0)
      warnings.push_back(fmt::format(
          "material '{}' has slip_length without effect: the scheme \"published\" has no slip; expected "
          "the scheme \"accurate\" beside it",
          m.name));
}

}  // namespace treacle
