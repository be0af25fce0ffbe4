#include "treacle/io/tables/rigid_writer.hpp"

#include "files/csv_cell.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <utility>

namespace treacle {
namespace {

std::string columns(const Case& c) {
  std::string text = "step,time";
  for (const Body& body : c.bodies) {
    if (body.kind != BodyKind::Rigid) continue;
    const auto add = [&](const std::string& quantity) { text += ',' + csvCell(body.name + quantity); };
    for (const char* quantity : {"_", "_velocity_"})
      for (int k = 0; k < c.dimensions; ++k) add(fmt::format("{}{}", quantity, "xyz"[k]));
    if (c.dimensions == 2) {
      add("_angle"), add("_angular_velocity");
      continue;
    }
    for (const char k : {'w', 'x', 'y', 'z'}) add(fmt::format("_orientation_{}", k));
    for (const char k : {'x', 'y', 'z'}) add(fmt::format("_angular_velocity_{}", k));
  }
  return text;
}

}  // namespace

RigidWriter::RigidWriter(RowTarget to, const Case& c)
    : dimensions_(c.dimensions), rows_(std::move(to), columns(c)) {}

void RigidWriter::append(std::int64_t step, double time, const std::vector<RigidBody>& bodies) {
  std::string row = fmt::format("{},{}", step, time);
  const auto add = [&](double x) { row += fmt::format(",{}", x); };
  for (const RigidBody& body : bodies) {
    if (body.mass == 0) continue;
    for (const Vec<3>* v : {&body.center, &body.velocity})
      for (int k = 0; k < dimensions_; ++k) add((*v)[k]);
    if (dimensions_ == 2) {
      add(2 * std::atan2(body.orientation[3], body.orientation[0]));
      add(body.spin[2]);
      continue;
    }
    for (const double q : body.orientation) add(q);
    for (int k = 0; k < 3; ++k) add(body.spin[k]);
  }
  rows_.append(std::move(row));
}

}  // namespace treacle
