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

/// Not the boxes around them.
TEST(FlowScales, HollowAndObliqueBodiesAreAsThickAsTheirFluid) {
  Case c = blockOf(fluid(10));
  Shape& s = c.bodies[0].shape;
  s.kind = ShapeKind::Sphere, s.radius = 15e-3, s.innerRadius = 11e-3;
  EXPECT_NEAR(flowScales(c).length, 4e-3, 1e-12);
  s.innerRadius = 0, c.bodies[0].where = "x^2 + y^2 > 0.011^2";
  EXPECT_NEAR(flowScales(c).length, 4e-3, 0.4e-3);
  s.radius = 0, s.kind = ShapeKind::Box, c.bodies[0].where = "y < 0.005 || x < 0.003";
  EXPECT_NEAR(flowScales(c).length, 5e-3, 1e-3);
  c.bodies[0].where = "";
  s.kind = ShapeKind::Polygon;
  s.points = {{0, 0}, {4e-3, 0}, {24e-3, 20e-3}, {20e-3, 20e-3}};  // a strip of 2.8 mm
  EXPECT_NEAR(flowScales(c).length, 4e-3 / std::sqrt(2), 0.3e-3);
  c.dimensions = 3;
  s.kind = ShapeKind::Cylinder, s.start = {}, s.end = {0.02, 0.02, 0.02}, s.radius = 4e-3;
  EXPECT_NEAR(flowScales(c).length, 8e-3, 1e-12);
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

/// Like those of openings, from its start to its end.
TEST(FlowScales, FormulasOfNozzlesCountWhileTheyFlow) {
  Case c = blockOf(fluid(10));
  c.time.end = 1;
  Body& nozzle = c.bodies.emplace_back();
  nozzle.kind = BodyKind::Inflow;
  nozzle.inflow.nozzle.radius = 3e-3;
  nozzle.inflow.speed = TimeFunction{.expression = "0.5*min(t/0.1,1)"};
  EXPECT_NEAR(flowScales(c).given, 0.5, 1e-15);
  EXPECT_NEAR(inflowSpeed(c), 0.5, 1e-15);
  nozzle.inflow.end = 0.05;
  EXPECT_NEAR(inflowSpeed(c), 0.25, 1e-3);
  nozzle.inflow.speed.reset();
  nozzle.inflow.flowRate = TimeFunction{.expression = "1.2e-3*max(0, 1-t)"};
  nozzle.inflow.start = 0.5, nozzle.inflow.end = 0;
  EXPECT_NEAR(inflowSpeed(c), 0.1, 1e-12);
}

Opening slot(double width) {
  Opening o;
  o.face.kind = NozzleKind::Rectangle;
  o.face.center = {0, 0.01, 0}, o.face.direction = {1, 0, 0}, o.face.width = width;
  return o;
}

/// Whatever the sign, and as fast as through a slit of the opening's width and the fluid's length at most.
TEST(FlowScales, PressuresOfOpeningsMoveTheFluid) {
  Case c = blockOf(fluid(10));
  c.gravity = {};
  c.openings.push_back(slot(0.012));
  c.openings[0].pressure = TimeFunction{.times = {0, 1}, .values = {100, -500}};
  const FlowScales flow = flowScales(c);
  EXPECT_NEAR(flow.pressure, 500, 1e-9);
  EXPECT_NEAR(fluidNumbers(c)[0].speed, 500 * 0.012 * 0.012 / (8 * 10 * 0.04), 1e-12);
  EXPECT_NEAR(fluidNumbers(c)[0].compression, 500 / 1e6, 1e-12);
  c.materials[0] = fluid(1e-3);
  EXPECT_NEAR(fluidNumbers(c)[0].speed, std::sqrt(2 * 500 / 1000.0), 1e-12);
}

TEST(FlowScales, FlowRatesOfOpeningsNeedAPressure) {
  Case c = blockOf(fluid(10));
  c.gravity = {};
  c.openings.push_back(slot(0.012));
  c.openings[0].flowRate = TimeFunction{.expression = "-1.2e-4*cos(t)"};
  EXPECT_NEAR(flowScales(c).given, 0.01, 1e-12);
  EXPECT_NEAR(fluidNumbers(c)[0].speed, 0.01, 1e-12);
  EXPECT_NEAR(fluidNumbers(c)[0].compression, 12 * 10 * 0.01 * 0.04 / (0.012 * 0.012) / 1e6, 1e-12);
}

TEST(FlowScales, ForcesOnBodiesPressTheFluid) {
  Case c = blockOf(fluid(10));
  c.gravity = {};
  Body piston;
  piston.kind = BodyKind::Rigid;
  piston.shape.min = {-0.01, 0, 0}, piston.shape.max = {0, 0.02, 0};
  piston.rigid.force[0] = TimeFunction{.value = -100};
  c.bodies.push_back(piston);
  EXPECT_NEAR(flowScales(c).pressure, 5000, 1e-9);
  EXPECT_NEAR(fluidNumbers(c)[0].speed, 5000 * 0.02 * 0.02 / (8 * 10 * 0.04), 1e-12);
  c.bodies.back().rigid.translates[0] = false;
  EXPECT_EQ(flowScales(c).pressure, 0) << "it cannot go where the force points";
}

/// A belt below a box of five times its height; open at one end, or a cavity, it builds up nothing.
TEST(FlowScales, WallsThatDragFluidAlongAClosedGapBuildUpAPressure) {
  Case c = blockOf(fluid(10));
  c.gravity = {};
  c.bodies[0].shape.max = {0.1, 0.02, 0};
  const auto add = [&](const Vec<3>& min, const Vec<3>& max) {
    Body& wall = c.bodies.emplace_back();
    wall.kind = BodyKind::Wall;
    wall.shape.min = min, wall.shape.max = max;
  };
  add({-0.02, -0.004, 0}, {0.2, 0, 0});
  add({-0.004, 0.02, 0}, {0.104, 0.024, 0});
  add({-0.004, 0, 0}, {0, 0.02, 0});
  add({0.1, 0, 0}, {0.104, 0.02, 0});
  EXPECT_EQ(flowScales(c).shear, 0) << "nothing moves";
  c.bodies[1].velocity = {0.03, 0, 0};
  EXPECT_NEAR(flowScales(c).shear, 6 * 0.03 * 4 / 0.02, 1e-9);
  Case cavity = c, open = c;
  cavity.bodies[0].shape.max = {0.02, 0.02, 0}, cavity.bodies[4].shape.min = {0.02, 0, 0};
  EXPECT_EQ(flowScales(cavity).shear, 0);
  open.bodies.pop_back();
  EXPECT_EQ(flowScales(open).shear, 0);
}

TEST(FlowScales, AreThoseOfATurnedCase) {
  Case c = blockOf(fluid(0.01));
  const FluidNumbers upright = fluidNumbers(c)[0];
  c.bodies[0].shape.transform.emplace().angle = 30;
  c.gravity = {5, -5 * std::sqrt(3.0), 0};
  EXPECT_NEAR(flowScales(c).length, 0.02, 1e-12);
  EXPECT_NEAR(flowScales(c).potential, 10 * 0.02, 1e-12);
  EXPECT_NEAR(fluidNumbers(c)[0].compression, upright.compression, 1e-12);
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
