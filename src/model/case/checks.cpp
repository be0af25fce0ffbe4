#include "treacle/model/case/checks.hpp"

#include "body_thickness.hpp"
#include "carried_fluids.hpp"
#include "likely_mistakes.hpp"
#include "long_steps.hpp"
#include "particles/body_points.hpp"
#include "particles/fluid_extent.hpp"
#include "treacle/model/case/bulk_constants.hpp"
#include "treacle/model/case/flow_scales.hpp"
#include "treacle/model/case/names.hpp"
#include "treacle/model/geometry/shape.hpp"
#include "treacle/model/geometry/thickness.hpp"
#include "treacle/model/motion/friction.hpp"
#include "treacle/model/motion/wall_motion.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <limits>

namespace treacle {
namespace {

/// That of a polygon or mesh that is not all of the inside; 0 stands for what is needed.
double layerThickness(const Shape& s) {
  const bool known = s.fill != FillKind::Inside && s.thickness > 0;
  return known ? s.thickness : std::numeric_limits<double>::infinity();
}

/// The same as it stands in the case [m]; infinite where it is not known.
std::pair<double, std::string> thickness(const Shape& s, int dimensions) {
  if (s.kind == ShapeKind::Polygon || s.kind == ShapeKind::Mesh) return {layerThickness(s), "(thickness)"};
  if (s.kind == ShapeKind::Particles) return {std::numeric_limits<double>::infinity(), ""};
  auto [extent, where] = ownThickness(s, dimensions);
  return {extent * (s.transform ? s.transform->scale : 1), std::move(where)};
}

/// What the interaction radius is called.
std::string_view reachName(const Case& c) {
  if (c.method.kind == MethodKind::Isph) return "reach 2 h of the kernel";
  if (c.viscosityRadius() >= c.densityRadius()) return "viscosity radius h_v";
  return c.densityRadius() > c.pressureRadius() ? "density radius h_n" : "pressure radius h_p";
}

void warnCompression(const Case& c, std::vector<std::string>& warnings) {
  const double most = mostCompression(c);
  for (const StabilityNumbers& n : stabilityNumbers(c)) {
    if (n.compression <= most * (1 + rounding)) continue;
    std::string advice = "give it a bulk_viscosity of at least bulk_modulus times the step";
    if (std::isfinite(n.compression))
      advice = fmt::format("take bulk_modulus <= {}, or a step of at most {:.3g} s", mostBulkModulusText(c),
                           c.time.step * most / n.compression);
    warnings.push_back(
        fmt::format("material '{}': dt kappa / lambda = {:.4g} is greater than {:g}, the step may be unstable; {}",
                    n.material, n.compression, most, advice));
  }
}

/// A bulk viscosity holds back whatever changes how particles lie. A dam break of Reynolds number 55 came 10 %
/// less far with 32,000 times the viscosity, 24 % with 100,000 times, and as far as with 1000 times with 10,000
/// times. One that treacle chose with its modulus is as small as the step lets it be; a light fluid beside another
/// one may need that of this.
void warnLargeBulkViscosity(const Case& c, std::vector<std::string>& warnings) {
  constexpr double most = 2e4, enough = 1e-3;  // of compression
  if (c.method.kind != MethodKind::MphI) return;
  const FlowScales flow = flowScales(c);
  const std::vector<FluidNumbers> fluids = fluidNumbers(c, flow);
  for (const FluidNumbers& n : fluids) {
    const Material& m = *std::ranges::find(c.materials, n.material, &Material::name);
    const bool follows = m.autoBulkViscosity && !m.autoBulkModulus;  // from a modulus of the case
    if (n.ratio <= most || (!follows && (m.autoBulkViscosity || fluids.size() > 1))) continue;
    const double mu = c.typicalViscosity(m), modulus = flow.pressureOf(m.density, mu) / enough;
    const std::string cause = follows ? fmt::format(", which steps of {:.3g} s need with bulk_modulus = {:.3g} Pa",
                                                    c.time.step, m.bulkModulus)
                                      : "";
    std::string advice = fmt::format("bulk_viscosity = {:.3g}, {:g} times the viscosity",
                                     recommendedBulkRatio * mu, recommendedBulkRatio);
    if (follows && modulus > 0 && modulus < m.bulkModulus)
      advice = fmt::format("bulk_modulus = {:.2g}, with which pressures compress it by 0.1 %, or leave it out",
                           modulus);
    else if (follows)
      advice = "a smaller bulk_modulus, or leave it out";
    warnings.push_back(fmt::format(
        "material '{}': its bulk viscosity of {:.3g} Pa s is {:.2g} times its viscosity{}; fluid flows too slowly "
        "with more than {:g} times; take {}",
        m.name, m.bulkViscosity, n.ratio, cause, most, advice));
  }
}

void warnThinWalls(const Case& c, std::vector<std::string>& warnings) {
  for (const Body& body : c.bodies) {
    if (!body.isWall() || body.shape.isThinSheet()) continue;
    const auto [extent, where] = thickness(body.shape, c.dimensions);
    const double reach = c.interactionRadius();
    if (extent >= reach * (1 - rounding)) continue;
    warnings.push_back(fmt::format(
        "wall '{}' is {} thick {}, thinner than the {} = {} ({:g} spacings): fluid next to it misses neighbours",
        body.name, lengthText(extent), where, reachName(c), lengthText(reach), reach / c.spacing));
  }
}

/// How far a particle of a wall that turns may be from its centre without ever leaving the domain [m].
double safeRadius(const Case& c, const Body& body, int samples) {
  double radius = std::numeric_limits<double>::infinity();
  for (int sample = 0; sample <= samples; ++sample) {
    const Vec<3> center = body.rotation->center + wallDisplacement(body, c.time.end * sample / samples);
    for (int k = 0; k < c.dimensions; ++k)
      if (!c.domain.periodic[static_cast<std::size_t>(k)])
        radius = std::min({radius, center[k] - c.domain.min[k], c.domain.max[k] - center[k]});
  }
  return radius;
}

/// Places of particles of a wall at the start, of which some leave the domain first if the wall does [m].
template <int D>
std::vector<Vec<D>> outermost(const Case& c, const Body& body, int samples) {
  if (body.rotation) {
    std::vector<std::string> notes;
    std::vector<Vec<D>> places = bodyPoints<D>(c, body, notes).place;
    const double safe = safeRadius(c, body, samples);
    std::erase_if(places, [&](const Vec<D>& x) { return norm(x - resized<D>(body.rotation->center)) <= safe; });
    return places;
  }
  const Extent box = boundingBox(body.shape, c.dimensions);
  const Vec<D> half = Vec<D>::filled(c.spacing / 2);  // particles are that far inside
  return {resized<D>(box.min) + half, resized<D>(box.max) - half};
}

/// A wall that moves on and on, such as a lid or a belt, needs a periodic axis.
template <int D>
void warnLeavingWalls(const Case& c, std::vector<std::string>& warnings) {
  constexpr int samples = 200;
  for (const Body& body : c.bodies) {
    const bool isKnown = body.rotation ? body.shape.kind != ShapeKind::Particles : body.where.empty();
    if (body.kind != BodyKind::Wall || !isKnown || body.shape.isThinSheet()) continue;
    const std::vector<Vec<D>> places = outermost<D>(c, body, samples);
    const auto leavesAlong = [&](const WallMotion<D>& motion, double t) {
      for (const Vec<D>& place : places) {
        const Vec<D> x = place + t * motion.chordAt(place);
        for (int k = 0; k < D; ++k)
          if (!c.domain.periodic[static_cast<std::size_t>(k)] &&
              (x[k] < c.domain.min[k] - rounding * c.spacing || x[k] > c.domain.max[k] + rounding * c.spacing))
            return k;
      }
      return D;
    };
    for (int sample = 1; sample <= samples; ++sample) {
      const double t = c.time.end * sample / samples;
      const int axis = leavesAlong(wallMotion<D>(c.domain, body, 0, t), t);
      if (axis == D) continue;
      warnings.push_back(
          fmt::format("wall '{}' leaves the domain along {} before t = {:.3g} s, where the run will end; make the "
                      "axis periodic, the domain larger, or the motion one that stays",
                      body.name, "xyz"[axis], t));
      break;
    }
  }
}

/// Rims are thin, too.
void warnThinMeshes(const Case& c, std::vector<std::string>& warnings) {
  constexpr double most = 0.2;  // of the surface
  for (const Body& body : c.bodies) {
    const Shape& s = body.shape;
    const bool isFilled = s.fill == FillKind::Inside || s.fill == FillKind::Shell;
    const bool isThere = s.kind == ShapeKind::Polygon || (s.kind == ShapeKind::Mesh && s.file.mesh.value);
    if (body.kind != BodyKind::Wall || !isFilled || !isThere) continue;
    const double reach = c.interactionRadius();
    const ThinParts thin = thinParts(s, c.dimensions, reach * (1 - rounding));
    if (thin.share < most) continue;
    warnings.push_back(fmt::format(
        "wall '{}': {:.0f} % of its surface is on parts that are thinner than the {} = {}, such as {} "
        "at {}: fluid acts through them and may leak; take fill = \"thin-sheet\" or a spacing of at most {}",
        body.name, 100 * thin.share, reachName(c), lengthText(reach), lengthText(thin.thickness),
        positionText(thin.place, c.dimensions), lengthText(thin.thickness * c.spacing / reach)));
  }
}

/// Sums over particles are to stand for integrals. With radii from these on, the sums of the weight of gradients
/// over a cubic lattice vary by less than 0.2 % with the place, and those of its slope times r by less than 0.5 %;
/// at 2 spacings the latter vary by up to 7 %. The weights of [K23] need the neighbours along the diagonal.
void warnShortRadii(const Case& c, std::vector<std::string>& warnings) {
  const MethodSettings& m = c.method;
  if (m.kind != MethodKind::MphI) return;
  const auto check = [&](std::string_view key, double radius, double least) {
    if (radius >= least * (1 - rounding)) return;
    warnings.push_back(fmt::format(
        "method.{} = {:g} spacings is short for the scheme '{}', expected at least {:g}: sums over so few "
        "neighbours depend on where these stand",
        key, radius, nameOf(m.scheme), least));
  };
  const bool published = m.scheme == SchemeKind::Published;
  check("pressure_radius", m.pressureRadius, published ? 1.5 : 2.5);
  check("viscosity_radius", m.viscosityRadius, published ? 1.5 : 2);
}

/// Numbers that no material has: a unit is wrong, or a key.
void warnUnlikely(const Case& c, std::vector<std::string>& warnings) {
  const auto look = [&](const std::string& of, std::string_view key, double x, double least, double most,
                        std::string_view unit) {
    if (x == 0 || (x >= least && x <= most)) return;
    warnings.push_back(fmt::format("{} has {} = {:g} {}; fluids and solids have {:g} to {:g}: is it in SI units?",
                                   of, key, x, unit, least, most));
  };
  for (const Material& m : c.materials) {
    const std::string of = fmt::format("material '{}'", m.name);
    look(of, "density", m.density, 0.01, 3e4, "kg/m3");
    look(of, "surface_tension", m.surfaceTension, 1e-6, 100, "N/m");
    if (!c.heat) continue;
    look(of, "conductivity", m.conductivity, 1e-3, 1e4, "W/(m K)");
    look(of, "specific_heat", m.specificHeat, 10, 2e4, "J/(kg K)");
    look(of, "thermal_expansion", std::abs(m.thermalExpansion), 1e-7, 0.02, "1/K");
    if (!m.freezing) continue;
    look("freezing of " + of, "latent_heat", m.freezing->latentHeat, 100, 1e7, "J/kg");
    look("freezing of " + of, "solidus", m.freezing->solidus, 10, 5000, "K");
    look("freezing of " + of, "solid_conductivity", m.freezing->solidConductivity, 1e-3, 1e4, "W/(m K)");
    look("freezing of " + of, "solid_specific_heat", m.freezing->solidSpecificHeat, 10, 2e4, "J/(kg K)");
  }
  if (c.heat)
    for (const Body& b : c.bodies)
      if (b.temperatureExpression.empty())
        look(fmt::format("body '{}'", b.name), "temperature", b.temperature, 50, 5000, "K");
}

/// Whether a viscosity is known at a temperature: between the rows of its table, or where its law is not cut off.
bool isKnownAt(const ViscosityShift& shift, double temperature) {
  if (shift.model == ShiftModel::Table)
    return temperature >= shift.temperatures.front() && temperature <= shift.temperatures.back();
  const double factor = ShiftFactor::make(shift)(temperature);
  return factor > shift.least * (1 + rounding) && factor < shift.most * (1 - rounding);
}

std::string knownRange(const ViscosityShift& shift) {
  if (shift.model == ShiftModel::Table)
    return fmt::format("from {:g} to {:g} K", shift.temperatures.front(), shift.temperatures.back());
  return fmt::format("for factors from {:g} to {:g}", shift.least, shift.most);
}

/// Walls are checked against tables only: where a law is cut off at a wall, the case intends it.
void warnTemperatures(const Case& c, std::vector<std::string>& warnings) {
  constexpr double zeroCelsius = 273.15, coldest = 200;
  if (!c.heat) return;
  for (const Body& body : c.bodies) {
    if (!body.temperatureExpression.empty() || body.fileTemperatures || body.temperature == 0) continue;
    for (const Material& m : c.materials) {
      const auto& shift = m.viscosityShift;
      const bool meets = body.holdsFluid() ? &materialOf(c, body) == &m
                                           : shift && shift->model == ShiftModel::Table &&
                                                 std::ranges::any_of(c.bodies, [&](const Body& b) {
                                                   return b.holdsFluid() && &materialOf(c, b) == &m;
                                                 });
      if (!meets || !shift || isKnownAt(*shift, body.temperature)) continue;
      warnings.push_back(fmt::format(
          "body '{}' has temperature = {:g} K, where viscosity_shift of material '{}' is cut off: it is given "
          "{}{}",
          body.name, body.temperature, m.name, knownRange(*shift),
          body.temperature < coldest
              ? fmt::format(". Are these degrees Celsius? Expected kelvin, {:g}", body.temperature + zeroCelsius)
              : ""));
    }
  }
}

/// Surface tension acts as it is at the start of a step: a step is not to be much longer than what viscosity and
/// inertia take to move a particle by its spacing (docs/surface-tension.md).
void warnTension(const Case& c, std::vector<std::string>& warnings) {
  for (const Material& m : c.materials) {
    if (m.surfaceTension == 0) continue;
    const double most = std::max(2 * c.typicalViscosity(m) * c.spacing / m.surfaceTension,
                                 std::sqrt(m.density * std::pow(c.spacing, 3) / m.surfaceTension));
    if (c.time.step <= most * (1 + rounding)) continue;
    warnings.push_back(fmt::format(
        "material '{}': steps of {:g} s are long for its surface tension, particles of the surface may leave it; "
        "take {} <= {:.2g}",
        m.name, c.time.step, c.time.stepKey(), most));
  }
}

/// Keys of a fluid on a material that no fluid is made of, and those of walls likewise, or where no surface meets
/// them.
void warnKeysOfOthers(const Case& c, std::vector<std::string>& warnings) {
  for (const Material& m : c.materials) {
    const auto isOf = [&](auto&& kind) {
      return std::ranges::any_of(c.bodies, [&](const Body& b) { return &materialOf(c, b) == &m && kind(b); });
    };
    const bool fluid = isOf([](const Body& b) { return b.holdsFluid(); });
    const bool wall = isOf([](const Body& b) { return b.isWall(); });
    const auto warn = [&](std::string_view key, std::string_view why) {
      warnings.push_back(fmt::format("material '{}' has {} without effect: {}", m.name, key, why));
    };
    constexpr std::string_view noFluid = "no fluid is made of it", noWall = "no wall is made of it";
    if (m.surfaceTension > 0 && !fluid) warn("surface_tension", noFluid);
    if (c.heat && m.emissivity > 0 && !fluid) warn("emissivity", noFluid);
    const bool angle = m.contactAngle != Material{}.contactAngle;
    if (angle && !wall) warn("contact_angle", noWall);
    if (!m.contactAngles.empty() && !wall) warn("contact_angles", noWall);
    if ((angle || !m.contactAngles.empty()) && wall && !c.hasSurfaceTension())
      warn(angle ? "contact_angle" : "contact_angles", "no fluid has a surface_tension");
  }
}

/// Warns of bodies that may touch if only one of them has friction.
void warnFriction(const Case& c, std::vector<std::string>& warnings) {
  for (const Body& body : c.bodies) {
    const auto rubs = [&](const Body& other) {
      return &other != &body && (body.kind == BodyKind::Rigid || other.kind == BodyKind::Rigid) &&
             frictionBetween(body, other) > 0;
    };
    if (body.friction == 0 || std::ranges::any_of(c.bodies, rubs)) continue;
    warnings.push_back(fmt::format("body '{}' has friction = {:g} without effect: {}", body.name, body.friction,
                                   c.hasRigid()
                                       ? "no body that it can touch has any, and the geometric mean of both counts"
                                       : "no body is rigid, and fluid knows no friction"));
  }
}

void warnSprings(const Case& c, std::vector<std::string>& warnings) {
  for (const Body& body : c.bodies)
    for (const Spring& s : body.rigid.springs)
      if (s.stiffness == 0 && s.damping == 0)
        warnings.push_back(fmt::format(
            "spring '{}' of body '{}' is without effect: its stiffness and damping are 0", s.name, body.name));
}

}  // namespace

std::vector<StabilityNumbers> stabilityNumbers(const Case& c) {
  std::vector<StabilityNumbers> numbers;
  for (const Material& m : c.materials) {
    const double diffusion = c.time.step / (m.density * c.spacing * c.spacing);
    const bool elastic = c.method.kind == MethodKind::MphI && m.bulkModulus > 0;
    const double compression = elastic ? c.time.step * m.bulkModulus / m.bulkViscosity : 0;
    numbers.push_back({m.name, compression, c.typicalViscosity(m) * diffusion, m.bulkViscosity * diffusion});
  }
  return numbers;
}

double mostCompression(const Case& c) { return c.densityRadius() > c.pressureRadius() * (1 + rounding) ? 0.5 : 1; }

std::string mostBulkModulusText(const Case& c) {
  return mostCompression(c) == 1 ? "bulk_viscosity / step" : "0.5 bulk_viscosity / step";
}

std::vector<std::string> caseWarnings(const Case& c) {
  std::vector<std::string> warnings;
  warnCompression(c, warnings);
  warnLargeBulkViscosity(c, warnings);
  if (c.method.kind == MethodKind::MphI && norm(c.gravity) > 0) {
    warnLightFluids(c, warnings);
    warnSoftFluids(c, warnings);
  }
  warnCourant(c, warnings);
  warnOscillations(c, warnings);
  warnViscousSteps(c, warnings);
  warnUnlikely(c, warnings);
  warnTemperatures(c, warnings);
  warnTension(c, warnings);
  warnKeysOfOthers(c, warnings);
  warnThinWalls(c, warnings);
  warnThinMeshes(c, warnings);
  c.dimensions == 2 ? warnLeavingWalls<2>(c, warnings) : warnLeavingWalls<3>(c, warnings);
  warnFriction(c, warnings);
  warnSprings(c, warnings);
  warnShortRadii(c, warnings);
  warnLikelyMistakes(c, warnings);
  if (!c.time.stepsVary()) warnTimes(c, warnings);
  return warnings;
}

}  // namespace treacle
