#include "treacle/model/case/bulk_constants.hpp"

#include "carried_fluids.hpp"
#include "particles/fluid_extent.hpp"
#include "treacle/model/case/checks.hpp"
#include "treacle/model/case/flow_scales.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace treacle {
namespace {

constexpr double compressed = 0.002, compressedInNozzles = 0.01;
constexpr double shareOfStable = 0.5;  // of the longest step
// Of constants that follow the density. The excess counts if pressures make up this part of it; the viscosity is
// over that at first.
constexpr double mostExcess = 0.005, leastCompression = 0.5, mostViscosity = 16;
constexpr double turns = 16;  // kappa / lambda of fluid that folds, over its rate of turning

/// How far the highest fluid and the lowest place are apart to which it can fall [m].
double tallestColumn(const Case& c) {
  if (norm(c.gravity) == 0) return 0;
  Heights fluid;
  for (const Body& body : c.bodies) {
    if (!body.holdsFluid()) continue;
    const Vec<3>& center = body.inflow.nozzle.center;
    const Heights h =
        body.kind == BodyKind::Inflow ? heightsOf(c, Extent{center, center}) : heightsOf(c, body.shape);
    fluid.low = std::min(fluid.low, h.low), fluid.high = std::max(fluid.high, h.high);
  }
  double low = fluid.low;
  for (const Body& body : c.bodies) {
    if (body.holdsFluid()) continue;
    const Heights h = heightsOf(c, body.shape);
    if (h.high <= fluid.low + rounding * c.spacing) low = std::min(low, h.high);
  }
  return std::max(0.0, fluid.high - low);
}

/// What the case says of one fluid.
struct Expected {
  double viscosity;  // mu [Pa s]
  double modulus;    // kappa by the pressures; 0 where the case names none [Pa]
  double step;       // [s]
  double settling;   // in which density errors are to vanish at the shortest, lambda/kappa [s]
};

/// `tallest`: tallestColumn(c).
Expected expectedOf(const Case& c, const Material& m, double speed, const FlowScales& flow, double tallest) {
  const double mu = c.typicalViscosity(m);
  double pressure = std::max({m.density * flow.potential, flow.pressure, mu * flow.shear,
                              m.density * speed * speed, m.density * norm(c.gravity) * tallest});
  if (flow.length > 0)
    pressure = std::max({pressure, mu * speed / flow.length, 4 * m.surfaceTension / flow.length});
  double step = c.time.step;
  if (c.time.automatic) {
    const double courant = speed > 0 ? std::min(0.5 * c.spacing / speed, c.time.end) : c.time.end;
    step = step > 0 ? std::min(step, courant) : courant;
  }
  // Faster than gravity moves particles past each other, errors of the density keep them in motion.
  const double settling = flow.acceleration > 0 ? 2 * std::sqrt(c.spacing / flow.acceleration) : 0;
  return {mu, std::max(pressure / compressed, flow.nozzlePressure(mu) / compressedInNozzles), step, settling};
}

/// kappa / lambda of the materials whose constants follow the density, but for BulkMemory::turning [1/s].
double openRate(const Case& c, const BulkMemory& memory) {
  double rate = 0;
  for (const Material& m : c.materials)
    if (m.hasOpenBulk())
      rate = std::max(rate, m.bulkModulus * memory.modulus / (m.bulkViscosity * memory.viscosity));
  return rate;
}

/// `rate`: openRate(); `grown`: the excess from which on kappa grows; `room`: by which it may for the step;
/// `wanted`: by which it is to grow at most.
bool followTurning(double excess, double grown, double rate, double room, double wanted, BulkMemory& memory) {
  const double next = std::exp2(std::floor(std::log2(std::max(1.0, std::min(room, wanted)))));
  const bool grows = excess > grown && next > memory.turning;
  const bool isSlow = 2 * wanted < memory.turning || room < memory.turning;
  const bool isCalm = memory.rest == 0 && 2 * excess < mostExcess;
  if (!grows && (memory.turning == 1 || !(isSlow || isCalm))) return false;
  memory.turning = grows || isSlow ? next : memory.turning / 2;
  memory.rest = 2 / (rate * memory.turning);
  return true;
}

/// With three digits, as people write such numbers.
double rounded(double x) { return std::stod(fmt::format("{:.3g}", x)); }

void setConstants(const Case& c, Material& m, const Expected& is) {
  const double stable = shareOfStable * mostCompression(c);  // dt kappa / lambda
  if (m.autoBulkViscosity) {
    const double kappa = m.autoBulkModulus ? is.modulus : m.bulkModulus;
    const double settling = m.autoBulkModulus ? is.settling : 0;
    m.bulkViscosity =
        rounded(std::max(recommendedBulkRatio * is.viscosity, kappa * std::max(is.step / stable, settling)));
  }
  if (!m.autoBulkModulus) return;
  const double most = stable * m.bulkViscosity / is.step;
  m.bulkModulus = rounded(is.modulus > 0 ? std::min(is.modulus, most) : 0.1 * most);
}

}  // namespace

void setBulkConstants(Case& c) {
  const auto isOpen = [](const Material& m) { return m.autoBulkViscosity || m.autoBulkModulus; };
  if (c.method.kind != MethodKind::MphI || std::ranges::none_of(c.materials, isOpen)) return;
  const FlowScales flow = flowScales(c);
  const std::vector<FluidNumbers> fluids = fluidNumbers(c, flow);
  const double tallest = tallestColumn(c);
  double viscosity = 0, modulus = 0;  // the largest ones of fluids
  const auto numbersOf = [&](const Material& m) {
    return std::ranges::find(fluids, m.name, &FluidNumbers::material);
  };
  for (Material& m : c.materials)
    if (const auto of = numbersOf(m); of != fluids.end()) {
      setConstants(c, m, expectedOf(c, m, of->speed, flow, tallest));
      viscosity = std::max(viscosity, m.bulkViscosity), modulus = std::max(modulus, m.bulkModulus);
    }
  for (Material& m : c.materials) {
    if (numbersOf(m) == fluids.end()) {
      if (m.autoBulkViscosity) m.bulkViscosity = viscosity;
      if (m.autoBulkModulus) m.bulkModulus = modulus;
    }
  }
}

double turningScale(const Case& c) {
  if (c.method.kind != MethodKind::MphI || std::ranges::none_of(c.materials, &Material::hasOpenBulk)) return 0;
  double density = 0;
  for (const Body& body : c.bodies)
    if (body.holdsFluid())
      density = std::max(density, c.materials[static_cast<std::size_t>(body.material)].density);
  return flowScales(c).length * std::sqrt(density * std::pow(c.spacing, c.dimensions));
}

bool adaptBulkConstants(const Case& c, const FluidDensity& is, double dt, bool isFirst, BulkMemory& memory) {
  memory.rest = std::max(0.0, memory.rest - dt);
  const double excess = is.excess, rate = openRate(c, memory);
  if (rate == 0) return false;
  if (isFirst) memory.excess = excess > mostExcess ? excess : 0;
  const double stable = shareOfStable * mostCompression(c) / c.time.step, room = stable / rate;
  const double grown = std::max(mostExcess, 1.2 * memory.excess);
  if (followTurning(excess, grown, rate, room, turns * is.turning / rate, memory)) return true;
  const bool helped = memory.excess == 0 || (memory.modulus > 1 && excess < 0.9 * memory.excess);
  if (excess <= (memory.rest == 0 && helped ? mostExcess : grown)) return false;
  if (!(is.compression >= leastCompression * excess)) return false;
  if (room >= 2) {
    memory.modulus *= std::min(4.0, room);
  } else if (memory.viscosity < mostViscosity) {
    memory.modulus *= 2, memory.viscosity *= 2;
  } else {
    return false;
  }
  memory.excess = excess, memory.rest = 2 / openRate(c, memory);
  return true;
}

}  // namespace treacle
