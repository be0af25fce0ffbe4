#pragma once

#include "checkpoint_fields.hpp"
#include "treacle/model/case/case.hpp"
#include "treacle/model/particles/create.hpp"
#include "treacle/model/particles/particles.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace treacle {

// What a checkpoint holds of rigid bodies, of fluid that enters and leaves, and of other memories of a run.
// Errors, of all functions: Hdf5Error.

inline void writeCount(hid_t file, const std::string& name, const FlowCount& count) {
  writeAttribute(file, (name + "_particles").c_str(), static_cast<std::int64_t>(count.particles));
  writeAttribute(file, (name + "_mass").c_str(), count.mass);
}
inline FlowCount readCount(hid_t file, const std::string& name) {
  const auto particles = readAttribute<std::int64_t>(file, (name + "_particles").c_str());
  const auto mass = readAttribute<double>(file, (name + "_mass").c_str());
  if (particles < 0 || !(mass >= 0) || !std::isfinite(mass))
    throw Hdf5Error(
        fmt::format("{} particles of {} kg came or went, expected numbers not less than 0", particles, mass));
  return {static_cast<std::uint64_t>(particles), mass};
}

/// Numbers of a rigid body in the order of the file.
template <class Body, class F>
inline void forEachNumber(Body& b, F&& f) {
  f(b.mass);
  for (auto& x : b.inertia) f(x);
  for (auto* v : {&b.center, &b.velocity, &b.spin})
    for (int k = 0; k < 3; ++k) f((*v)[k]);
  for (auto& x : b.orientation) f(x);
}
inline constexpr std::uint64_t rigidNumbers = 20;

/// A list of numbers, whose length is known from an attribute.
inline void writeNumbers(hid_t file, const char* name, std::span<const double> values) {
  Buffer<double> field(values.size());
  std::copy(values.begin(), values.end(), field.begin());
  writeAttribute(file, (std::string(name) + "_count").c_str(), static_cast<std::uint32_t>(values.size()));
  writeField(file, FieldInfo{name, Of::All, values.size()}, field);
}
/// Errors: Hdf5Error for more than `most`, and for one that is not finite.
inline std::vector<double> readNumbers(hid_t file, const char* name, std::uint64_t most) {
  const auto count = readAttribute<std::uint32_t>(file, (std::string(name) + "_count").c_str());
  if (count > most) throw Hdf5Error(fmt::format("{} values of {}, more than {}", count, name, most));
  std::vector<double> values(count);
  FieldReader<double>(file, FieldInfo{name, Of::All, count}).read({0, count}, values.data());
  for (const double x : values)
    if (!std::isfinite(x)) throw Hdf5Error(fmt::format("a value of {} is not finite", name));
  return values;
}

inline void writeRigid(hid_t file, const RigidMotion& rigid) {
  std::vector<double> numbers;
  for (const RigidBody& body : rigid.bodies) forEachNumber(body, [&](double x) { numbers.push_back(x); });
  writeNumbers(file, "rigid_bodies", numbers);
  writeNumbers(file, "rigid_change", rigid.change);
}

/// Where there is something to write.
inline void writeGas(hid_t file, const GasState& gas) {
  if (gas == GasState{}) return;
  std::vector<double> numbers;
  for (const GasState::Pocket& pocket : gas.pockets)
    for (const double x : {pocket.content, pocket.volume, pocket.pressure}) numbers.push_back(x);
  writeNumbers(file, "gas_pockets", numbers);
  writeNumbers(file, "gas_cells", gas.cells);
  writeNumbers(file, "gas_labels", gas.labels);
}

/// Errors: Hdf5Error for what no gas is.
inline GasState readGas(hid_t file) {
  GasState gas;
  if (!hasAttribute(file, "gas_pockets_count")) return gas;
  const std::vector<double> numbers = readNumbers(file, "gas_pockets", 3 * mostGasPockets);
  for (std::size_t k = 0; k + 3 <= numbers.size(); k += 3)
    gas.pockets.push_back({numbers[k], numbers[k + 1], numbers[k + 2]});
  gas.cells = readNumbers(file, "gas_cells", maxParticles);
  gas.labels = readNumbers(file, "gas_labels", maxParticles);
  const auto isPocket = [&](double label) {
    return label >= 0 && label < static_cast<double>(gas.pockets.size());
  };
  if (numbers.size() % 3 != 0 || std::ranges::any_of(gas.cells, [](double cell) { return cell < 0; }) ||
      gas.cells.size() != gas.labels.size() || !std::ranges::all_of(gas.labels, isPocket))
    throw Hdf5Error("the cells of trapped gas do not fit its pockets");
  return gas;
}

/// Where there is something to write.
inline void writeBulk(hid_t file, const BulkMemory& bulk) {
  if (bulk == BulkMemory{}) return;
  writeAttribute(file, "bulk_viscosity_raised", bulk.viscosity);
  writeAttribute(file, "bulk_modulus_raised", bulk.modulus);
  writeAttribute(file, "bulk_modulus_turning", bulk.turning);
  writeAttribute(file, "bulk_excess", bulk.excess);
  writeAttribute(file, "bulk_rest", bulk.rest);
}
/// Errors: Hdf5Error for what no run remembers.
inline BulkMemory readBulk(hid_t file) {
  if (!hasAttribute(file, "bulk_rest")) return {};
  const BulkMemory bulk{
      readAttribute<double>(file, "bulk_viscosity_raised"), readAttribute<double>(file, "bulk_modulus_raised"),
      hasAttribute(file, "bulk_modulus_turning") ? readAttribute<double>(file, "bulk_modulus_turning") : 1,
      readAttribute<double>(file, "bulk_excess"), readAttribute<double>(file, "bulk_rest")};
  const bool isFinite = std::isfinite(bulk.viscosity + bulk.modulusOfAll() + bulk.excess + bulk.rest);
  const bool isRaised = bulk.viscosity >= 1 && bulk.modulus >= 1 && bulk.turning >= 1;
  if (!isFinite || !isRaised || bulk.excess < 0 || bulk.rest < 0)
    throw Hdf5Error(fmt::format("bulk constants raised by {}, {} and {}, for {} s", bulk.viscosity, bulk.modulus,
                                bulk.turning, bulk.rest));
  return bulk;
}

/// Where there is something to write.
inline void writeResponse(hid_t file, const std::vector<double>& response) {
  if (!response.empty()) writeNumbers(file, "response", response);
}
inline std::vector<double> readResponse(hid_t file) {
  constexpr std::uint64_t most = 6 * maxBodies + maxOpenings + mostGasPockets;
  return hasAttribute(file, "response_count") ? readNumbers(file, "response", most * most) : std::vector<double>{};
}

/// Errors: Hdf5Error for what no body is.
inline RigidMotion readRigid(hid_t file) {
  constexpr std::uint64_t mostUnknowns = 6 * maxBodies;
  RigidMotion rigid;
  const std::vector<double> numbers = readNumbers(file, "rigid_bodies", maxBodies * rigidNumbers);
  if (numbers.size() % rigidNumbers != 0) throw Hdf5Error("the numbers of the rigid bodies are not complete");
  const double* from = numbers.data();
  rigid.bodies.resize(numbers.size() / rigidNumbers);
  for (RigidBody& body : rigid.bodies) {
    forEachNumber(body, [&](double& x) { x = *from++; });
    if (!(body.mass >= 0)) throw Hdf5Error(fmt::format("a rigid body has a mass of {} kg", body.mass));
  }
  rigid.change = readNumbers(file, "rigid_change", mostUnknowns);
  return rigid;
}

inline void writeFlow(hid_t file, const OpenFlow& flow) {
  writeAttribute(file, "next_id", flow.nextId);
  writeAttribute(file, "flow_body_count", static_cast<std::uint32_t>(flow.inflows.size()));
  writeAttribute(file, "outflow_count", static_cast<std::uint32_t>(flow.outflows.size()));
  for (std::size_t k = 0; k < flow.inflows.size(); ++k) {
    const std::string name = fmt::format("inflow_{}", k);
    writeCount(file, name, flow.inflows[k]);
    const std::vector<double>& ways = flow.inflows[k].ways;
    if (ways.size() == 1)
      writeAttribute(file, (name + "_way").c_str(), ways[0]);
    else
      writeNumbers(file, (name + "_ways").c_str(), ways);
  }
  for (std::size_t k = 0; k < flow.outflows.size(); ++k)
    writeCount(file, fmt::format("outflow_{}", k), flow.outflows[k]);
  if (!flow.openings.empty())
    writeAttribute(file, "opening_count", static_cast<std::uint32_t>(flow.openings.size()));
  for (std::size_t k = 0; k < flow.openings.size(); ++k) {
    writeCount(file, fmt::format("opening_{}_in", k), flow.openings[k].in);
    writeCount(file, fmt::format("opening_{}_out", k), flow.openings[k].out);
    writeAttribute(file, fmt::format("opening_{}_drag", k).c_str(), flow.openings[k].drag);
    writeAttribute(file, fmt::format("opening_{}_pressure", k).c_str(), flow.openings[k].pressure);
  }
}

/// Errors: Hdf5Error for what no run remembers.
inline OpenFlow readFlow(hid_t file) {
  OpenFlow flow;
  flow.nextId = readAttribute<std::uint32_t>(file, "next_id");
  const auto bodies = readAttribute<std::uint32_t>(file, "flow_body_count"),
             outflows = readAttribute<std::uint32_t>(file, "outflow_count");
  if (bodies > maxBodies || outflows > maxOutflows)
    throw Hdf5Error(fmt::format("{} bodies and {} outflows, more than the limits of {} and {}", bodies, outflows,
                                maxBodies, maxOutflows));
  for (std::uint32_t k = 0; k < bodies; ++k) {
    const std::string name = fmt::format("inflow_{}", k);
    const std::string columns = name + "_ways";
    OpenFlow::Inflow inflow{readCount(file, name), {}};
    if (hasAttribute(file, (columns + "_count").c_str()))
      inflow.ways = readNumbers(file, columns.c_str(), maxParticles);
    else
      inflow.ways = {readAttribute<double>(file, (name + "_way").c_str())};
    if (inflow.ways.empty()) throw Hdf5Error("an inflow has no columns of particles");
    for (const double way : inflow.ways)
      if (!(way >= 0) || !std::isfinite(way))
        throw Hdf5Error(fmt::format("the layers of an inflow have gone {} m, expected at least 0", way));
    flow.inflows.push_back(std::move(inflow));
  }
  for (std::uint32_t k = 0; k < outflows; ++k)
    flow.outflows.push_back(readCount(file, fmt::format("outflow_{}", k)));
  if (!hasAttribute(file, "opening_count")) return flow;
  const auto openings = readAttribute<std::uint32_t>(file, "opening_count");
  if (openings > maxOpenings)
    throw Hdf5Error(fmt::format("{} openings, more than the limit of {}", openings, maxOpenings));
  for (std::uint32_t k = 0; k < openings; ++k) {
    const std::string name = fmt::format("opening_{}", k);
    flow.openings.push_back({readCount(file, name + "_in"), readCount(file, name + "_out"),
                             readAttribute<double>(file, (name + "_drag").c_str()),
                             readAttribute<double>(file, (name + "_pressure").c_str())});
    if (!std::isfinite(flow.openings.back().drag) || !std::isfinite(flow.openings.back().pressure))
      throw Hdf5Error("the drag or the pressure of an opening is not finite");
  }
  return flow;
}

}  // namespace treacle
