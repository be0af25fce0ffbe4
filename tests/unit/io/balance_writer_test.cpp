#include "treacle/io/tables/balance_writer.hpp"

#include "limited_files.hpp"
#include "support/temporary_directory.hpp"
#include "treacle/core/error.hpp"

#include <cmath>
#include <sstream>

using namespace treacle;
using namespace treacle::test;

namespace {

constexpr const char* powers =
    "step,time,shear_dissipation,bulk_dissipation,inertial_loss,elastic_power,elastic_energy,wall_power";

Case caseOf(int dimensions, const std::vector<std::string>& walls) {
  Case c;
  c.dimensions = dimensions;
  c.method.scheme = SchemeKind::Published;
  c.materials.resize(1);
  c.bodies.resize(1);
  c.bodies[0].name = "pool";
  for (const std::string& name : walls) {
    c.bodies.emplace_back();
    c.bodies.back().name = name;
    c.bodies.back().kind = BodyKind::Wall;
  }
  return c;
}

}  // namespace

TEST(BalanceWriter, FormatIsFixed) {
  TemporaryDirectory directory;
  const Balance balance{1, 2.5, 1e-3, -4, 1e-20, 0.1, {{{7, -8, 0}, {0, 0, 9}}, {{0.5, 1, 0}, {0, 0, -2}}}};
  BalanceWriter plane(directory / "balance.csv", caseOf(2, {"floor", "lid"}));
  plane.append(3, 0.003, balance);
  // Seen without closing the writer.
  EXPECT_EQ(content(directory / "balance.csv"),
            std::string(powers) +
                ",floor_force_x,floor_force_y,floor_torque,lid_force_x,lid_force_y,lid_torque\n"
                "3,0.003,1,2.5,0.001,-4,1e-20,0.1,7,-8,9,0.5,1,-2\n");

  BalanceWriter space(directory / "balance.csv", caseOf(3, {"the \"old\" tank, left"}));
  space.append(4, 0.5, {0, 0, 0, 0, 0, 0, {{{1, 2, 3}, {4, 5, 6}}}});
  std::string columns = powers;
  for (const char* quantity : {"force_x", "force_y", "force_z", "torque_x", "torque_y", "torque_z"})
    columns += ",\"the \"\"old\"\" tank, left_" + std::string(quantity) + '"';
  EXPECT_EQ(content(directory / "balance.csv"), columns + "\n4,0.5,0,0,0,0,0,0,1,2,3,4,5,6\n");
}

TEST(BalanceWriter, ThePowersOfRepulsionAndShiftStandWhereTheSchemeHasThem) {
  TemporaryDirectory directory;
  Case c = caseOf(2, {"floor"});
  c.method.scheme = SchemeKind::Accurate;
  c.spacing = 1e-3;
  BalanceWriter writer(directory / "balance.csv", c);
  writer.append(3, 0.003, {1, 2.5, 1e-3, -4, 1e-20, 0.1, {{{7, -8, 0}, {0, 0, 9}}}, 0.75, -0.5});
  EXPECT_EQ(content(directory / "balance.csv"),
            std::string(powers) +
                ",repulsion_power,shift_power,floor_force_x,floor_force_y,floor_torque\n"
                "3,0.003,1,2.5,0.001,-4,1e-20,0.1,0.75,-0.5,7,-8,9\n");
}

TEST(BalanceWriter, SurfacesStandWhereSomeFluidHasATension) {
  TemporaryDirectory directory;
  Case c = caseOf(2, {});
  c.materials[0].surfaceTension = 0.07;
  Balance balance{1, 2.5, 1e-3, -4, 1e-20, 0.1, {}};
  balance.surfacePower = -0.25, balance.surfaceEnergy = 8;
  BalanceWriter writer(directory / "balance.csv", c);
  writer.append(3, 0.003, balance);
  EXPECT_EQ(content(directory / "balance.csv"),
            std::string(powers) + ",surface_power,surface_energy\n3,0.003,1,2.5,0.001,-4,1e-20,0.1,-0.25,8\n");
}

TEST(BalanceWriter, BuoyancyStandsWhereSomeFluidExpands) {
  TemporaryDirectory directory;
  Case c = caseOf(2, {});
  c.heat.emplace();
  c.materials.emplace_back().thermalExpansion = 1e-3;
  Balance balance{1, 2.5, 1e-3, -4, 1e-20, 0.1, {}};
  balance.buoyancyPower = -0.25;
  balance.heat = HeatBalance{.energy = 5, .heating = 6, .walls = 7, .surface = 8};
  BalanceWriter writer(directory / "balance.csv", c);
  writer.append(3, 0.003, balance);
  EXPECT_EQ(content(directory / "balance.csv"),
            std::string(powers) +
                ",buoyancy_power,heat_energy,viscous_heating,heat_from_walls,heat_from_surface\n"
                "3,0.003,1,2.5,0.001,-4,1e-20,0.1,-0.25,5,6,7,8\n");
}

TEST(BalanceWriter, NumbersReadBackToTheSameBits) {
  TemporaryDirectory directory;
  const auto value = [](int k) { return std::exp(20 * std::sin(k)) / 3; };
  const Balance balance{
      value(1), value(2), value(3), -value(4), value(5), value(6), {{{value(7), value(8), 0}, {0, 0, -value(9)}}}};
  BalanceWriter(directory / "balance.csv", caseOf(2, {"floor"})).append(1, value(0), balance);
  std::istringstream text(content(directory / "balance.csv"));
  std::string cell;
  std::getline(text, cell);
  std::getline(text, cell, ',');
  for (int k = 0; k < 10; ++k) {
    std::getline(text, cell, ',');
    EXPECT_EQ(std::stod(cell), k == 4 || k == 9 ? -value(k) : value(k));
  }
}

TEST(BalanceWriter, FullDiskLeavesWholeRows) {
  TemporaryDirectory directory;
  const auto path = directory / "balance.csv";
  EXPECT_TRUE(withFileLimit(1000, [&] {
    BalanceWriter writer(path, caseOf(2, {"floor"}));
    const std::string message = messageOf<RunError>([&] {
      for (int k = 0; k < 100; ++k) writer.append(k, 0.1 * k, {1, 2, 3, 4, 5, 6, {{}}});
    });
    return message == "cannot write " + path.string() + ": File too large";
  }));
  const std::string text = content(path);
  EXPECT_TRUE(text.ends_with(",1,2,3,4,5,6,0,0,0\n")) << text;
  EXPECT_GT(text.size(), 900u);
}
