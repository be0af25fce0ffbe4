#include "treacle/model/case/flow_scales.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace treacle {
namespace {

/// A block of 40 x 20 mm on nothing, spacing 1 mm.
Case blockOf(const Material& material) {
  Case c;
  c.dimensions = 2, c.spacing = 1e-3;
  c.gravity = {0, -10, 0};
  c.materials.push_back(material);
  Body block;
  block.shape.max = {0.04, 0.02, 0};
  c.bodies.push_back(block);
  return c;
}

Material fluid(double viscosity) {
  Material m;
  m.name = "fluid", m.density = 1000, m.dynamicViscosity = viscosity, m.bulkViscosity = 1e4, m.bulkModulus = 1e6;
  return m;
}

TEST(FlowScales, ViscosityHoldsBackWhatFallsElse) {
  const double fall = std::sqrt(2 * 10 * 0.02);
  const FluidNumbers thick = fluidNumbers(blockOf(fluid(10))).at(0),
                     thin = fluidNumbers(blockOf(fluid(0.01))).at(0);
  EXPECT_NEAR(thick.speed, 1000 * 10 * 0.02 * 0.02 / 10, 1e-12);
  EXPECT_NEAR(thick.reynolds, 1000 * 0.4 * 0.02 / 10, 1e-12);
  EXPECT_NEAR(thick.ratio, 1000, 1e-9);
  EXPECT_NEAR(thick.viscousTime, 0.04, 1e-12);
  EXPECT_NEAR(thick.compression, 1000 * 10 * 0.02 / 1e6, 1e-12);
  EXPECT_NEAR(thin.speed, fall, 1e-12);
}

TEST(FlowScales, SurfaceTensionMovesFluidWithoutWeight) {
  Material m = fluid(10);
  m.surfaceTension = 0.5;
  Case c = blockOf(m);
  c.gravity = {};
  const FluidNumbers n = fluidNumbers(c).at(0);
  EXPECT_NEAR(n.speed, 0.05, 1e-12);  // gamma/mu
  EXPECT_NEAR(n.capillaryStep, 2 * 10 * 1e-3 / 0.5, 1e-12);
  EXPECT_EQ(n.bond, 0);
  EXPECT_EQ(n.compression, 0);
}

TEST(FlowScales, AFrameThatTurnsPressesTheFluid) {
  Case c = blockOf(fluid(10));
  c.gravity = {};
  c.domain = {{-0.1, -0.1, 0}, {0.1, 0.1, 0}};
  Rotation frame;
  frame.speed = 60;
  c.frame = frame;
  const double square = 60 * 60 * (0.0395 * 0.0395 + 0.0195 * 0.0195), inner = 60 * 60 * 2 * 0.0005 * 0.0005;
  const FlowScales flow = flowScales(c);
  EXPECT_NEAR(flow.acceleration, 60 * std::sqrt(square), 1e-9);
  EXPECT_NEAR(flow.potential, (square - inner) / 2, 1e-9);
  EXPECT_NEAR(fluidNumbers(c).at(0).compression, 1000 * flow.potential / 1e6, 1e-12);
}

TEST(FlowScales, FluidHasNoSideAlongAPeriodicAxis) {
  Case c = blockOf(fluid(10));
  Shape& block = c.bodies[0].shape;
  block.min = {}, block.max = {10e-3, 40e-3, 0};
  c.domain = {{0, -1, 0}, {10e-3, 1, 0}, {}};
  EXPECT_NEAR(flowScales(c).length, 10e-3, 1e-15);
  c.domain.periodic[0] = true;
  EXPECT_NEAR(flowScales(c).length, 40e-3, 1e-15);
  c.domain = {{0, 0, 0}, {10e-3, 40e-3, 0}, {true, true, false}};
  EXPECT_NEAR(flowScales(c).length, 10e-3, 1e-15);
}

TEST(FlowScales, NozzlesCountByWidthAndSpeed) {
  Case c = blockOf(fluid(10));
  Body nozzle;
  nozzle.kind = BodyKind::Inflow;
  nozzle.inflow.nozzle.radius = 3e-3;
  nozzle.inflow.speed = TimeFunction{.times = {0, 1, 2}, .values = {0, 0.7, 0.1}};
  c.bodies.push_back(nozzle);
  EXPECT_NEAR(flowScales(c).length, 6e-3, 1e-15);
  EXPECT_NEAR(flowScales(c).given, 0.7, 1e-15);
  EXPECT_NEAR(fluidNumbers(c).at(0).compression, 32 * 10 * 0.7 / 6e-3 / 1e6, 1e-12);
  c.bodies.back().inflow.speed.reset();
  c.bodies.back().inflow.flowRate = TimeFunction{.value = 1.2e-3};
  EXPECT_NEAR(flowScales(c).given, 0.2, 1e-15);
  c.bodies.back().inflow.speed = TimeFunction{.value = 0.7};
  c.bodies.back().inflow.nozzle.innerRadius = 1e-3;  // a ring
  EXPECT_NEAR(flowScales(c).length, 2e-3, 1e-15);
  EXPECT_NEAR(fluidNumbers(c).at(0).speed, 0.7, 1e-15);
}

TEST(FlowScales, MaterialsOfWallsAloneAreNoFluids) {
  Case c = blockOf(fluid(10));
  c.materials.push_back(fluid(1));
  c.bodies.push_back(c.bodies.front());
  c.bodies.back().kind = BodyKind::Wall, c.bodies.back().material = 1;
  EXPECT_EQ(fluidNumbers(c).size(), 1u);
}

}  // namespace
}  // namespace treacle
