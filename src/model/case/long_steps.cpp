#include "long_steps.hpp"

#include "carried_fluids.hpp"
#include "particles/fluid_extent.hpp"
#include "treacle/model/case/checks.hpp"
#include "treacle/model/case/flow_scales.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace treacle {
namespace {

bool wholeNumber(double x) { return std::abs(x - std::round(x)) <= rounding * std::max(1.0, std::abs(x)); }

/// Automatic steps are at most this part of the time in which heat goes through the fluid.
constexpr double shareOfConduction = 0.003;

/// The Courant number of the longest step that a run makes.
double courantNumberAt(const Case& c, double speed) {
  const double number = speed * c.time.step / c.spacing;
  const double most = c.time.mostCourant();
  return most > 0 ? std::min(number, most) : number;
}

/// What is known before the run, but for falls [m/s].
double knownSpeed(const Case& c) { return std::max(givenSpeed(c), inflowSpeed(c)); }

}  // namespace

double courantNumber(const Case& c) {
  const double fall = std::sqrt(2 * (norm(c.gravity) * fluidHeight(c) + centrifugalScale(c).potential));
  return courantNumberAt(c, std::max(knownSpeed(c), fall));
}

void warnCourant(const Case& c, std::vector<std::string>& warnings) {
  const bool isph = c.method.kind == MethodKind::Isph;
  const double largest = isph ? 0.5 : 1, number = isph ? courantNumber(c) : courantNumberAt(c, knownSpeed(c));
  if (number <= largest * (1 + rounding)) return;
  warnings.push_back(fmt::format(
      "the Courant number of steps of {:g} s is {:.3g}, more than {:g}: {}; take steps of at most {:.2g} "
      "s, or let time.courant limit them",
      c.time.step, number, largest,
      isph ? "the step may be unstable" : "particles may pass each other or enter walls in a step",
      c.time.step * largest / number));
}

void warnOscillations(const Case& c, std::vector<std::string>& warnings) {
  constexpr double stepsOfPeriod = 20;
  for (const Body& body : c.bodies) {
    const double period = body.oscillation.period;
    if (period == 0 || norm(body.oscillation.amplitude) == 0 ||
        c.time.step * stepsOfPeriod <= period * (1 + rounding))
      continue;
    warnings.push_back(fmt::format(
        "body '{}' oscillates with a period of {:g} s, {:.3g} steps of {:g} s; take {} <= {:.2g}", body.name,
        period, period / c.time.step, c.time.step, c.time.stepKey(), period / stepsOfPeriod));
  }
}

void warnViscousSteps(const Case& c, std::vector<std::string>& warnings) {
  if (c.method.kind != MethodKind::Isph) return;
  double most = 0;  // diffusivity of momentum [m2/s]
  std::string material;
  for (const Body& body : c.bodies) {
    if (!body.holdsFluid()) continue;
    const Material& m = materialOf(c, body);
    if (m.dynamicViscosity / m.density > most) most = m.dynamicViscosity / m.density, material = m.name;
  }
  const double number = most * c.time.step / (c.spacing * c.spacing);
  if (number <= 1 + rounding) return;
  warnings.push_back(fmt::format(
      "steps of {:g} s are {:.3g} rho l^2/mu of '{}', more than 1: in such steps of ISPH pressures let "
      "viscous fluid slip along walls, and fronts come out too far, by some 10 % with 2.5 and 20 % "
      "with 10; take method.name = \"mph-i\", or {} <= {:.2g}",
      c.time.step, number, material, c.time.stepKey(), c.spacing * c.spacing / most));
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

StableStep longestStableStep(const Case& c) {
  StableStep stable{std::numeric_limits<double>::infinity(), "nothing"};
  const auto bound = [&](double length, std::string reason) {
    if (length < stable.length) stable = {length, std::move(reason)};
  };
  for (const Material& m : c.materials)
    if (m.bulkModulus > 0 && m.bulkViscosity > 0)  // without the latter no step is
      bound(mostCompression(c) * m.bulkViscosity / m.bulkModulus,
            fmt::format("dt kappa / lambda of '{}'", m.name));
  if (c.heat && c.time.automatic) {  // the error of a step does not see temperatures
    const double length = flowScales(c).length;
    for (const Material& m : c.materials)
      if (m.conductivity > 0 && m.specificHeat > 0 && length > 0)
        bound(shareOfConduction * m.density * m.specificHeat * length * length / m.conductivity,
              fmt::format("the conduction of heat in '{}'", m.name));
  }
  for (const Body& body : c.bodies) {
    if (body.kind != BodyKind::Fluid || norm(c.gravity) == 0) continue;
    if (const double p = weightOn(c, body, true); p > 0)
      bound(longestCarryingStep(c, materialOf(c, body), p), fmt::format("the heavier fluid on '{}'", body.name));
  }
  return stable;
}

void setStepBounds(Case& c) {
  TimeSettings& t = c.time;
  if (!t.automatic) return;
  if (t.step == 0) t.step = std::min(longestStableStep(c).length, t.end);
  if (t.least == 0) t.least = defaultLeastStep(t);
}

double defaultLeastStep(const TimeSettings& t) { return t.step / 1e4; }

}  // namespace treacle
