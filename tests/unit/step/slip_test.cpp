#include "support/state_of.hpp"
#include "treacle/step/run/simulation.hpp"

#include <gtest/gtest.h>

namespace treacle::test {
namespace {

/// A block of 6 by 5 spacings that stands still in a symmetric tank, in fluid at rest that slips along all walls;
/// all of it displaced.
Case slippingTank(const Vec<3>& by) {
  Case c;
  c.dimensions = 2;
  c.spacing = 1e-3;
  c.domain = {Vec<3>{-0.02, -0.01, 0} + by, Vec<3>{0.04, 0.05, 0} + by, {}};
  c.gravity = {0, -9.81, 0};
  c.time.step = 0.5e-3, c.time.end = 1;
  c.materials.resize(1);
  Material& m = c.materials[0];
  m.name = "syrup", m.density = 1300, m.dynamicViscosity = 3, m.bulkViscosity = 3e3, m.bulkModulus = 1e6;
  m.slipLength = 0.01;
  const auto box = [&](const char* name, BodyKind kind, const Vec<3>& min, const Vec<3>& max) {
    Body b;
    b.name = name, b.kind = kind;
    b.shape.kind = ShapeKind::Box, b.shape.min = min + by, b.shape.max = max + by;
    c.bodies.push_back(b);
  };
  box("block", BodyKind::Wall, {9e-3, 7e-3, 0}, {15e-3, 12e-3, 0});
  box("pool", BodyKind::Fluid, {0, 0, 0}, {24e-3, 18e-3, 0});
  box("floor", BodyKind::Wall, {-8e-3, -4e-3, 0}, {32e-3, 0, 0});
  box("left", BodyKind::Wall, {-4e-3, 0, 0}, {0, 30e-3, 0});
  box("right", BodyKind::Wall, {24e-3, 0, 0}, {28e-3, 30e-3, 0});
  c.bodies[1].subtract = {"block"};
  c.probes.resize(1);
  c.probes[0].name = "load", c.probes[0].kind = ProbeKind::Load, c.probes[0].body = "block";
  return c;
}

/// The fluid presses on the block as Archimedes says, and not to a side, wherever ties of rounding at its edges
/// fall. It comes to rest, and the pressure next to the walls is that inside. With a part along walls for each
/// pair by itself the buoyancy was 1.14, the force to a side 0.03 and pressures next to the walls 0.85 to 1.17 of
/// their own.
TEST(Slip, LeavesFluidAtRest) {
  for (const Vec<3>& by : {Vec<3>{}, Vec<3>{16e-3, -32e-3, 0}}) {
    const Case c = slippingTank(by);
    Simulation<2> simulation(c, created<2>(c));
    StepReport last;
    for (int k = 0; k < 200; ++k) last = simulation.advance();
    const double weight = 1300 * 9.81 * 30e-6;
    EXPECT_NEAR(last.loads[0].force[1] / weight, 1, 0.02);
    EXPECT_NEAR(last.loads[0].force[0] / weight, 0, 1e-6);
    EXPECT_LT(last.diagnostics.maxSpeed, 0.6e-3);
    const Particles<2> p = stateOf(simulation);
    double pressure = 0, expected = 0;  // of the first row at both sides, half way up
    for (std::uint32_t i = 0; i < p.fluidCount; ++i) {
      const Vec<2> x = p.position[i] - resized<2>(by);
      if ((x[0] > 1e-3 && x[0] < 23e-3) || x[1] < 4e-3 || x[1] > 12e-3) continue;
      pressure += p.pressure[i], expected += 1300 * 9.81 * (18e-3 - x[1]);
    }
    EXPECT_NEAR(pressure / expected, 1, 0.05);
  }
}

}  // namespace
}  // namespace treacle::test
