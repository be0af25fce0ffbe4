#include "carried_fluids.hpp"

#include "particles/fluid_extent.hpp"
#include "treacle/model/case/checks.hpp"
#include "treacle/model/case/flow_scales.hpp"
#include "treacle/model/geometry/shape.hpp"
#include "treacle/model/materials/pressed_particle.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <limits>

namespace treacle {
namespace {

constexpr double mostPushed = 0.5;  // spacings
constexpr double latticeViscosity = PressedParticle::latticeViscosity;

PressedParticle particleOf(const Case& c, const Material& m) {
  return {m.density, c.typicalViscosity(m), c.spacing, c.time.step};
}

/// The step in which the pressure p [Pa] carries a particle by `way` [s].
double stepOfWay(const Case& c, const Material& m, double p, double way) {
  const double half = 0.5 * way * latticeViscosity * c.typicalViscosity(m) / p;
  return half + std::sqrt(half * half + way * m.density * c.spacing * c.spacing / p);
}

/// Whether the steps of the scheme keep particles under pressure in their places (StiffnessLimits).
bool keepsPlaces(const Case& c, const Material& m) { return c.isAccurate() && c.typicalViscosity(m) > 0; }

}  // namespace

double weightOn(const Case& c, const Body& below, bool heavier) {
  int down = 0;
  for (int k = 1; k < c.dimensions; ++k)
    if (std::abs(c.gravity[k]) > std::abs(c.gravity[down])) down = k;
  const Extent box = boundingBox(below.shape, c.dimensions);
  const Heights h = heightsOf(c, below.shape);
  double pressure = 0;
  for (const Body& body : c.bodies) {
    const double density = materialOf(c, body).density;
    if (body.kind != BodyKind::Fluid || &body == &below) continue;
    if (heavier && density <= materialOf(c, below).density) continue;
    const Extent other = boundingBox(body.shape, c.dimensions);
    const Heights its = heightsOf(c, body.shape);
    bool onIt = its.high > h.high;
    for (int k = 0; k < c.dimensions; ++k)
      onIt = onIt && (k == down || (other.min[k] < box.max[k] && box.min[k] < other.max[k]));
    if (onIt) pressure += density * norm(c.gravity) * (its.high - std::max(its.low, h.low));
  }
  return pressure;
}

double pressureOfHeavier(const Case& c, const Material& m) {
  if (norm(c.gravity) == 0) return 0;
  double least = std::numeric_limits<double>::infinity();
  for (const Body& body : c.bodies)
    if (body.kind == BodyKind::Fluid && &materialOf(c, body) == &m)
      least = std::min(least, weightOn(c, body, true));
  return std::isinf(least) ? 0 : least;
}

double pressureOfWeight(const Case& c, const Material& m) {
  if (norm(c.gravity) == 0) return 0;
  double most = 0;
  for (const Body& body : c.bodies)
    if (body.kind == BodyKind::Fluid && &materialOf(c, body) == &m) most = std::max(most, pressureIn(c, body));
  return most;
}

double additionalViscosity(const Case& c, const Material& m, double p) {
  return c.isAccurate() ? StiffnessLimits::of(c.method.pressureRadius).viscosity(particleOf(c, m), p) : 0;
}

double longestCarryingStep(const Case& c, const Material& m, double p) {
  return keepsPlaces(c, m) ? std::numeric_limits<double>::infinity() : stepOfWay(c, m, p, mostPushed);
}

double pressureIn(const Case& c, const Body& body) {
  const double own = heightsOf(c, body.shape).extent();
  return weightOn(c, body, false) + materialOf(c, body).density * norm(c.gravity) * own;
}

void warnLightFluids(const Case& c, std::vector<std::string>& warnings) {
  for (const Body& body : c.bodies) {
    const double p = body.kind == BodyKind::Fluid ? weightOn(c, body, true) : 0;
    if (p == 0) continue;
    const Material& m = materialOf(c, body);
    if (keepsPlaces(c, m)) continue;
    const double dt = c.time.step, inertia = m.density * c.spacing * c.spacing;
    const double way = particleOf(c, m).way(p);
    if (way <= mostPushed * (1 + rounding)) continue;
    warnings.push_back(fmt::format(
        "fluid '{}' is too light and too thin for the heavier fluid on it: a pressure of {:.3g} Pa can move its "
        "particles by {:.3g} spacings in a step, more than {:g}, so that the heavier fluid may sink into it; take "
        "steps of at most {:.2g} s, or a dynamic_viscosity of '{}' of at least {:.2g} Pa s",
        body.name, p, way, mostPushed, longestCarryingStep(c, m, p), m.name,
        (p * dt / mostPushed - inertia / dt) / latticeViscosity));
  }
}

void warnSoftFluids(const Case& c, std::vector<std::string>& warnings) {
  constexpr double most = 0.1;
  for (const Body& body : c.bodies) {
    if (body.kind != BodyKind::Fluid) continue;
    const Material& m = materialOf(c, body);
    const double p = pressureIn(c, body);
    const double share = std::min(p / m.bulkModulus, p * c.time.end / m.bulkViscosity);
    if (!(share > most)) continue;
    warnings.push_back(fmt::format(
        "fluid '{}' is too soft for the weight that it carries: {:.3g} Pa may compress it by {:.2g} %; take a "
        "bulk_modulus of '{}' of at least {:.2g} Pa, and a bulk_viscosity of at least {:.2g} Pa s",
        body.name, p, 100 * std::min(share, 1.0), m.name, p / most, p / most * c.time.step / mostCompression(c)));
  }
}

}  // namespace treacle
