#include "advice.hpp"

#include "print.hpp"
#include "treacle/model/case/bulk_constants.hpp"
#include "treacle/model/case/checks.hpp"
#include "treacle/model/case/flow_scales.hpp"
#include "treacle/model/materials/state_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace treacle {
namespace {

constexpr double mostCompressed = 0.01;  // by the weight of the fluid

/// How many particles lie across the shortest side of the fluid, and the errors measured with so many
/// (docs/validation.md).
void printResolution(const Case& c, const FlowScales& flow) {
  if (flow.length == 0) return;
  const double across = flow.length / c.spacing;
  print("# resolution: {:.3g} particles across the shortest side of the fluid, {:.3g} m", across, flow.length);
  if (c.method.kind == MethodKind::MphI && c.method.scheme == SchemeKind::Accurate)
    print(
        "; rates and fronts are within 1 to 5 % with 20 (resolution = {:.3g}), 2.5 % with 40 ({:.3g}), 1.5 % with "
        "80 ({:.3g})",
        c.resolution * 20 / across, c.resolution * 40 / across, c.resolution * 80 / across);
  print("\n");
}

void printFluid(const FluidNumbers& n, bool elastic) {
  print("# fluid '{}': ", n.material);
  if (n.viscousTime > 0)
    print("Reynolds number {:.3g} at {:.3g} m/s", n.reynolds, n.speed);
  else
    print("no viscosity, {:.3g} m/s", n.speed);
  if (n.viscousTime > 0) print(", viscous time {:.3g} s", n.viscousTime);
  if (elastic && n.ratio > 0) print(", lambda / mu = {:.4g}", n.ratio);
  if (n.compression > 0) print(", compressed by up to {:.2g} %", 100 * n.compression);
  if (n.capillaryStep > 0) print(", Bond number {:.3g}, capillary step {:.3g} s", n.bond, n.capillaryStep);
  print("\n");
}

/// When a state has gone half of the way to its upper bound at the temperature of the start, without shear; 0:
/// later than the end of the run [s].
double halfTime(const Case& c, std::size_t material, std::size_t state, const MaterialState& s) {
  std::vector<FormulaStep> steps;
  StateTable table = StateTable::make(c, steps);
  table.steps = steps.data();
  const Material& m = c.materials[material];
  double x[StateTable::variables] = {c.heat ? c.typicalTemperature(m) : 0};
  std::ranges::copy(c.startsOfStates(m), x + StateTable::FirstState);
  constexpr int parts = 1000;
  const double half = 0.5 * (s.start + s.highest());
  for (int k = 1; k <= parts; ++k) {
    table.advance(static_cast<int>(material), c.time.end / parts, x);
    if (x[StateTable::FirstState + state] >= half) return k * c.time.end / parts;
  }
  return 0;
}

/// Times and numbers of what a material remembers.
void printRemembered(const Case& c, const FluidNumbers& n, const FlowScales& flow) {
  const auto found = std::ranges::find(c.materials, n.material, &Material::name);
  const Material& m = *found;
  for (const ElasticMode& mode : m.elastic) {
    const double time = c.typicalShift(m) * mode.relaxationTime;
    print("# elastic mode '{}' of '{}': relaxation time {:.3g} s, {:.3g} steps", mode.name, m.name, time,
          time / c.time.step);
    if (flow.length > 0) print(", Weissenberg number {:.3g}", time * n.speed / flow.length);
    print(", Deborah number {:.3g}\n", time / c.time.end);
  }
  const std::vector<std::string> names = c.stateNames();
  for (const MaterialState& s : m.states) {
    if (s.highest() >= 1e30) continue;
    const auto state = static_cast<std::size_t>(std::ranges::find(names, s.name) - names.begin());
    const double half = halfTime(c, static_cast<std::size_t>(found - c.materials.begin()), state, s);
    if (half > 0)
      print("# state '{}' of '{}': half of the way to {:g} at rest after {:.3g} s, {:.3g} steps\n", s.name, m.name,
            s.highest(), half, half / c.time.step);
    else
      print("# state '{}' of '{}': less than half of the way to {:g} at rest until the end\n", s.name, m.name,
            s.highest());
  }
  if (m.freezing && m.freezing->latentHeat > 0)
    print("# freezing of '{}': Stefan number {:.3g}\n", m.name,
          m.specificHeat * std::abs(c.typicalTemperature(m) - m.freezing->liquidus) / m.freezing->latentHeat);
}

/// A bulk viscosity that is enough, and the bulk moduli that go with it and the step: stiff enough for the
/// pressures, soft enough for the step. Where the case leaves both to treacle, they are those that it has chosen.
void printBulk(const Case& c, const Material& m, const FlowScales& flow) {
  const double mu = c.typicalViscosity(m);
  if (mu == 0 || (m.autoBulkViscosity && m.autoBulkModulus)) return;
  const double lambda = recommendedBulkRatio * mu;
  const double most = mostCompression(c) * lambda / c.time.step;
  const double least = flow.pressureOf(m.density, mu) / mostCompressed;
  std::string modulus;
  if (c.time.automatic && least > 0)
    modulus = fmt::format(
        ", bulk_modulus of at least {:.3g} (compressed by 1 %); steps may then be as long as {:g} bulk_viscosity "
        "/ bulk_modulus",
        least, mostCompression(c));
  else if (!c.time.automatic && least == 0)
    modulus = fmt::format(", bulk_modulus of at most {:.3g} (stable with both)", most);
  else if (!c.time.automatic && least < most)
    modulus =
        fmt::format(", bulk_modulus from {:.3g} (compressed by 1 %) to {:.3g} (stable with both)", least, most);
  else if (!c.time.automatic)
    modulus = fmt::format(", and a shorter step: a bulk_modulus of {:.3g}, compressed by 1 %, needs {:.3g} s",
                          least, c.time.step * most / least);
  print("# advice for '{}': bulk_viscosity {:.3g} ({:g} times the viscosity){}\n", m.name, lambda,
        recommendedBulkRatio, modulus);
}

/// Prints the time step of a case of MPH-I, which stability, surface tension and the known speeds limit.
void printStep(const Case& c, const std::vector<FluidNumbers>& fluids, const FlowScales& flow) {
  StableStep longest = longestStableStep(c);
  const auto bound = [&](double length, std::string reason) {
    if (length < longest.length) longest = {length, std::move(reason)};
  };
  for (const FluidNumbers& n : fluids)
    if (n.capillaryStep > 0) bound(n.capillaryStep, fmt::format("surface tension of '{}'", n.material));
  if (flow.given > 0) bound(c.spacing / flow.given, "one spacing at the given speeds");
  if (!std::isfinite(longest.length)) return;
  print("# advice for the step: \"auto\", or at most {:.3g} s ({})\n", longest.length, longest.reason);
}

}  // namespace

void printAdvice(const Case& c) {
  const bool elastic = c.method.kind == MethodKind::MphI;
  const FlowScales flow = flowScales(c);
  const std::vector<FluidNumbers> fluids = fluidNumbers(c, flow);
  printResolution(c, flow);
  for (const FluidNumbers& n : fluids) printFluid(n, elastic);
  for (const FluidNumbers& n : fluids) printRemembered(c, n, flow);
  if (!elastic) {
    const double speed = std::max(flow.given, flow.fall);
    if (speed > 0)
      print("# advice for the step: at most {:.3g} s, half a spacing at {:.3g} m/s\n", 0.5 * c.spacing / speed,
            speed);
    return;
  }
  for (const FluidNumbers& n : fluids)
    printBulk(c, *std::ranges::find(c.materials, n.material, &Material::name), flow);
  printStep(c, fluids, flow);
}

}  // namespace treacle
