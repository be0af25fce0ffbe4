#include "treacle/model/case/flow_scales.hpp"

#include "body_thickness.hpp"
#include "drives.hpp"
#include "particles/fluid_extent.hpp"
#include "treacle/model/motion/nozzle.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace treacle {
namespace {

double shortestSide(const Case& c, const Body& body) {
  return body.kind == BodyKind::Inflow ? widthOf(body.inflow.nozzle, c.dimensions) : fluidThickness(c, body);
}

/// Of the fastest column, while the nozzle flows.
double inflowSpeed(const Case& c, const Body& body) {
  const Inflow& inflow = body.inflow;
  if (body.kind != BodyKind::Inflow || (!inflow.speed && !inflow.flowRate)) return 0;
  const TimeFunction& given = inflow.speed ? *inflow.speed : *inflow.flowRate;
  const double end = inflow.end > 0 ? std::min(inflow.end, c.time.end) : c.time.end;
  const double most = largestSize(given, inflow.start, std::max(inflow.start, end));
  if (inflow.speed && inflow.profile == plugProfile) return most;
  const auto of = [&](const auto& layers) {
    return std::ranges::max(layers.profile()) * (inflow.speed ? most : most / layers.area());
  };
  return c.dimensions == 2 ? of(NozzleLayers<2>(c, body)) : of(NozzleLayers<3>(c, body));
}

FluidNumbers numbersOf(const Case& c, const Material& m, const FlowScales& flow) {
  FluidNumbers n{.material = m.name};
  const double mu = c.typicalViscosity(m), g = flow.acceleration, inertia = m.density * flow.length * flow.length;
  // Where inertia rules a fluid falls freely, where viscosity does it flows as fast as its weight shears it.
  n.speed = std::max(flow.given, mu > 0 ? std::min(flow.fall, inertia * g / mu) : flow.fall);
  const double pressed = std::sqrt(2 * flow.pressure / m.density);
  n.speed = std::max(n.speed, mu > 0 ? std::min(pressed, flow.seep / mu) : pressed);
  if (m.bulkModulus > 0) n.compression = flow.pressureOf(m.density, mu) / m.bulkModulus;
  if (m.surfaceTension > 0) {
    n.capillaryStep = std::max(2 * mu * c.spacing / m.surfaceTension,
                               std::sqrt(m.density * std::pow(c.spacing, 3) / m.surfaceTension));
    n.bond = inertia * g / m.surfaceTension;
    const double inertial = std::sqrt(m.surfaceTension / (m.density * flow.length));
    n.speed = std::max(n.speed, mu > 0 ? std::min(inertial, m.surfaceTension / mu) : inertial);
  }
  if (mu > 0) {
    n.reynolds = m.density * n.speed * flow.length / mu;
    n.viscousTime = inertia / mu;
    n.ratio = m.bulkViscosity / mu;
  }
  return n;
}

}  // namespace

double inflowSpeed(const Case& c) {
  double speed = 0;
  for (const Body& body : c.bodies) speed = std::max(speed, inflowSpeed(c, body));
  return speed;
}

FlowScales flowScales(const Case& c) {
  FlowScales flow;
  const CentrifugalScale centrifugal = centrifugalScale(c);
  flow.acceleration = std::max(norm(c.gravity), centrifugal.acceleration);
  flow.potential = norm(c.gravity) * fluidHeight(c) + centrifugal.potential;
  flow.fall = std::sqrt(2 * flow.potential);
  flow.given = givenSpeed(c);
  double shortest = std::numeric_limits<double>::infinity();
  for (const Body& body : c.bodies) {
    if (!body.holdsFluid()) continue;
    const double side = shortestSide(c, body), speed = inflowSpeed(c, body);
    shortest = std::min(shortest, side);
    flow.given = std::max(flow.given, speed);
    if (side > 0) flow.nozzleShear = std::max(flow.nozzleShear, speed / side);
  }
  if (std::isfinite(shortest)) flow.length = shortest;
  const Drives drives = drivesOf(c, flow.length);
  flow.given = std::max(flow.given, drives.speed);
  flow.pressure = drives.pressure, flow.seep = drives.seep, flow.shear = drives.shear;
  return flow;
}

std::vector<FluidNumbers> fluidNumbers(const Case& c, const FlowScales& flow) {
  std::vector<FluidNumbers> numbers;
  for (std::size_t k = 0; k < c.materials.size(); ++k)
    if (std::ranges::any_of(c.bodies,
                            [&](const Body& b) { return b.holdsFluid() && b.material == static_cast<int>(k); }))
      numbers.push_back(numbersOf(c, c.materials[k], flow));
  return numbers;
}

}  // namespace treacle
