#include "treacle/io/tables/balance_writer.hpp"

#include "files/csv_cell.hpp"

#include <fmt/format.h>

#include <string>
#include <utility>

namespace treacle {
namespace {

std::string columns(const Case& c) {
  std::string text =
      "step,time,shear_dissipation,bulk_dissipation,inertial_loss,elastic_power,elastic_energy,wall_power";
  if (c.repulsionRadius() > 0) text += ",repulsion_power";
  if (c.keepsVolume()) text += ",shift_power";
  if (c.hasSurfaceTension()) text += ",surface_power,surface_energy";
  if (c.hasBuoyancy()) text += ",buoyancy_power";
  if (c.heat) text += ",heat_energy,viscous_heating,heat_from_walls,heat_from_surface";
  if (c.heat && c.hasStates()) text += ",heat_from_states";
  for (const Body& body : c.bodies) {
    if (!body.isWall()) continue;
    const auto add = [&](const std::string& quantity) { text += ',' + csvCell(body.name + quantity); };
    for (int k = 0; k < c.dimensions; ++k) add(fmt::format("_force_{}", "xyz"[k]));
    if (c.dimensions == 2)
      add("_torque");
    else
      for (const char axis : {'x', 'y', 'z'}) add(fmt::format("_torque_{}", axis));
  }
  return text;
}

}  // namespace

BalanceWriter::BalanceWriter(RowTarget to, const Case& c)
    : dimensions_(c.dimensions),
      repels_(c.repulsionRadius() > 0),
      shifts_(c.keepsVolume()),
      hasSurface_(c.hasSurfaceTension()),
      rises_(c.hasBuoyancy()),
      hasStates_(c.hasStates()),
      rows_(std::move(to), columns(c)) {}

void BalanceWriter::append(std::int64_t step, double time, const Balance& b) {
  std::string row = fmt::format("{},{},{},{},{},{},{},{}", step, time, b.shearDissipation, b.bulkDissipation,
                                b.inertialLoss, b.elasticPower, b.elasticEnergy, b.wallPower);
  if (repels_) row += fmt::format(",{}", b.repulsionPower);
  if (shifts_) row += fmt::format(",{}", b.shiftPower);
  if (hasSurface_) row += fmt::format(",{},{}", b.surfacePower, b.surfaceEnergy);
  if (rises_) row += fmt::format(",{}", b.buoyancyPower);
  if (b.heat) row += fmt::format(",{},{},{},{}", b.heat->energy, b.heat->heating, b.heat->walls, b.heat->surface);
  if (b.heat && hasStates_) row += fmt::format(",{}", b.heat->states);
  for (const WallLoad& load : b.walls) {
    for (int k = 0; k < dimensions_; ++k) row += fmt::format(",{}", load.force[k]);
    for (int k = dimensions_ == 2 ? 2 : 0; k < 3; ++k) row += fmt::format(",{}", load.torque[k]);
  }
  rows_.append(std::move(row));
}

}  // namespace treacle
