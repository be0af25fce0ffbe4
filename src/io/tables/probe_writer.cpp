#include "treacle/io/tables/probe_writer.hpp"

#include "compare/fluid_sampler.hpp"
#include "treacle/core/parallel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace treacle {
namespace {

/// ",NAME_x,NAME_y" and so on; without a name ",x,y".
std::string axes(const Case& c, const std::string& name) {
  std::string text;
  for (int k = 0; k < c.dimensions; ++k) text += fmt::format(",{}{}{}", name, name.empty() ? "" : "_", "xyz"[k]);
  return text;
}

/// Names of the columns of fields that not all cases have.
std::string ownFields(const Case& c) {
  return std::string(c.hasOwnViscosities() ? ",dynamic_viscosity,shear_rate" : "") +
         (c.heat ? ",temperature" : "");
}

std::string columns(const Case& c, const Probe& p) {
  switch (p.kind) {
    case ProbeKind::Point:
    case ProbeKind::Line:
    case ProbeKind::Plane:
      return fmt::format("time{}{}{},pressure{}", p.kind == ProbeKind::Line ? ",distance" : "", axes(c, ""),
                         axes(c, "velocity"), ownFields(c));
    case ProbeKind::Height:
      return "time,height" + axes(c, "");
    case ProbeKind::Flow:
      return "time,volume_flow_rate,mass_flow_rate";
    case ProbeKind::Region:
      return fmt::format("time,volume,mass{}{},pressure,dynamic_viscosity{}{}", axes(c, "center"),
                         axes(c, "velocity"), c.hasOwnViscosities() ? ",shear_rate" : "",
                         c.heat ? ",temperature" : "");
    case ProbeKind::WallPressure:
      return "time,pressure,largest";
    case ProbeKind::Load:
      break;
  }
  return fmt::format("time{}{},power", axes(c, "force"),
                     c.dimensions == 2 ? ",torque" : ",torque_x,torque_y,torque_z");
}

/// A centre of particles as they count in a region: one that counts in part stands up to half a spacing outside.
Vec<3> movedInside(const Probe& region, int dimensions, Vec<3> x) {
  if (region.box)
    for (int k = 0; k < dimensions; ++k) x[k] = std::clamp(x[k], region.box->min[k], region.box->max[k]);
  if (const double square = norm2(region.normal); square > 0)
    x = x - (std::max(0.0, dot(x - region.point, region.normal)) / square) * region.normal;
  return x;
}

}  // namespace

ProbeWriter::ProbeWriter(RowTarget to, const Case& c, const Probe& probe)
    : case_(c),
      probe_(probe),
      hasOwnViscosities_(c.hasOwnViscosities()),
      rows_(std::move(to), columns(c, probe)) {}

std::string ProbeWriter::components(const Vec<3>& v) const {
  std::string text;
  for (int k = 0; k < case_.dimensions; ++k) text += fmt::format(",{}", v[k]);
  return text;
}

void ProbeWriter::append(double time, const Probe& now, const Frame& fluid, const Frame& walls) {
  const FluidSampler sampler(fluid, walls, case_.domain, case_.spacing);
  if (probe_.kind == ProbeKind::Height) {
    const Vec<3> way = now.to - now.from;
    const double height = sampler.extent(now.from, now.to);
    return rows_.append(fmt::format("{},{}{}", time, height, components(now.from + (height / norm(way)) * way)));
  }
  const ProbePlaces places = ProbePlaces::of(now, case_.spacing);
  std::vector<FluidSample> samples(places.count());
  parallelFor(samples.size(), parallelGrain, [&](std::size_t k) { samples[k] = sampler.at(places.at(k)); });
  std::string rows;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const Vec<3> x = places.at(k);
    const FluidSample& s = samples[k];
    if (k > 0) rows += '\n';
    rows += fmt::format("{}", time);
    if (probe_.kind == ProbeKind::Line) rows += fmt::format(",{}", norm(x - now.from));
    rows += components(x) + components(s.velocity) + fmt::format(",{}", s.pressure);
    if (hasOwnViscosities_) rows += fmt::format(",{},{}", s.viscosity, s.shearRate);
    if (case_.heat) rows += fmt::format(",{}", s.temperature);
  }
  rows_.append(std::move(rows));
}

/// Means are those by volume. A part without fluid has nan, of which 0/0 would have the sign that a processor
/// likes. So has one whose volume is the rounding of a surface.
void ProbeWriter::append(double time, const Probe& now, const PartSums& s) {
  if (probe_.kind == ProbeKind::Flow) {
    const Vec<3> downstream = (1 / norm(now.normal)) * now.normal;
    return rows_.append(fmt::format("{},{},{}", time, dot(s.flow, downstream), dot(s.momentum, downstream)));
  }
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const bool some = s.volume > 1e-9 * std::pow(case_.spacing, case_.dimensions);
  const auto mean = [&](double sum) { return some ? sum / s.volume : nan; };
  Vec<3> center = Vec<3>::filled(nan);
  for (int k = 0; some && k < 3; ++k) center[k] = s.moment[k] / s.mass;
  if (some) center = movedInside(now, case_.dimensions, center);
  std::string row = fmt::format("{},{},{}", time, s.volume, s.mass);
  for (int k = 0; k < case_.dimensions; ++k) row += fmt::format(",{}", center[k]);
  for (int k = 0; k < case_.dimensions; ++k) row += fmt::format(",{}", mean(s.flow[k]));
  row += fmt::format(",{},{}", mean(s.pressure), mean(s.viscosity));
  if (hasOwnViscosities_) row += fmt::format(",{}", mean(s.shearRate));
  if (case_.heat) row += fmt::format(",{}", mean(s.temperature));
  rows_.append(std::move(row));
}

void ProbeWriter::append(double time, const PatchMean& pressure) {
  rows_.append(fmt::format("{},{},{}", time, pressure.impulse / pressure.time, pressure.largest));
}

void ProbeWriter::append(double time, const std::vector<WallLoad>& walls) {
  std::size_t index = 0;  // among the walls of the case
  for (const Body& body : case_.bodies) {
    if (body.name == probe_.body) break;
    index += body.isWall();
  }
  const WallLoad& load = walls.at(index);
  std::string row = fmt::format("{}{}", time, components(load.force));
  for (int k = case_.dimensions == 2 ? 2 : 0; k < 3; ++k) row += fmt::format(",{}", load.torque[k]);
  rows_.append(row + fmt::format(",{}", load.power));
}

}  // namespace treacle
