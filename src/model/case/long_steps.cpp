#include "long_steps.hpp"

#include "carried_fluids.hpp"
#include "particles/fluid_extent.hpp"
#include "treacle/model/case/checks.hpp"
#include "treacle/model/case/flow_scales.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace treacle {
namespace {

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

}  // namespace treacle
