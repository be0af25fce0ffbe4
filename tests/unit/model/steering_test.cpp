#include "treacle/model/case/steering.hpp"

#include "treacle/core/error.hpp"
#include "treacle/model/motion/nozzle.hpp"
#include "treacle/model/motion/wall_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

namespace treacle {
namespace {

Body bodyOf(BodyKind kind, const char* name) {
  Body body;
  body.name = name, body.kind = kind;
  return body;
}
Body wall() { return bodyOf(BodyKind::Wall, "lid"); }
Body inflow() {
  Body body = bodyOf(BodyKind::Inflow, "nozzle");
  body.inflow.flowRate = TimeFunction{.value = 3};
  return body;
}
void expectWay(const Body& body, double t, const Vec<3>& way) {
  EXPECT_LE(norm(wallDisplacement(body, t) - way), 1e-14) << "t = " << t;
}
template <class F>
void expectRefusal(F&& f, const std::string& text) {
  try {
    f();
    ADD_FAILURE() << "nothing was thrown";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find(text), std::string::npos) << e.what();
  }
}

TEST(Steering, KeepsThePast) {
  Body body = wall();
  body.velocity = {1, 0, 0};
  body = steered(body, {.velocity = Vec<3>{0, 2, 0}}, 0.5);
  body = steered(body, {.velocity = Vec<3>{-1, 0, 0}}, 0.75);
  expectWay(body, 0.25, {0.25, 0, 0});
  expectWay(body, 0.5, {0.5, 0, 0});
  expectWay(body, 0.75, {0.5, 0.5, 0});
  expectWay(body, 1.75, {-0.5, 0.5, 0});
  EXPECT_LE(norm(wallVelocity(body, 1.25, 0.25) - Vec<3>{-1, 0, 0}), 1e-12);
  EXPECT_LE(norm(wallVelocity(body, 100, 0.001) - Vec<3>{-1, 0, 0}), 1e-9);
}

TEST(Steering, GoesOnFromTables) {
  Body body = wall();
  body.displacement[1] = TimeFunction{.times = {0.2, 0.4, 2}, .values = {1, 3, 9}};
  body = steered(body, {.velocity = Vec<3>{0, 0, 0}}, 0.8);
  expectWay(body, 0.1, {0, 0, 0});
  expectWay(body, 0.3, {0, 1, 0});
  expectWay(body, 0.8, {0, 3.5, 0});
  expectWay(body, 3, {0, 3.5, 0});
}

TEST(Steering, LastWordCounts) {
  const Body first = steered(wall(), {.velocity = Vec<3>{5, 0, 0}}, 1);
  expectWay(steered(first, {.velocity = Vec<3>{0, 0, 1}}, 1), 2, {0, 0, 1});
  expectWay(steered(wall(), {.velocity = Vec<3>{5, 0, 0}}, 0), 2, {10, 0, 0});
}

TEST(Steering, Turns) {
  Body body = wall();
  body.rotation.emplace();
  body.rotation->speed = 2;
  body = steered(body, {.spin = -4}, 1);
  const WallMotion<2> before = wallMotion<2>(Domain{}, body, 0.5, 0.1),
                      after = wallMotion<2>(Domain{}, body, 1.5, 0.1);
  EXPECT_NEAR(before.spin[2], 2, 1e-12);
  EXPECT_NEAR(after.spin[2], -4, 1e-9);
  EXPECT_NEAR(after.sine, 0, 1e-12);  // 2 - 2
}

/// A nozzle, too.
TEST(Steering, TurnsNozzles) {
  Body body = inflow();
  body.inflow.nozzle.direction = {1, 0, 0};
  body.inflow.nozzle.radius = 1;
  body.rotation = Rotation{};
  Case c;
  c.dimensions = 2;
  c.spacing = 0.5;
  body = steered(steered(body, {.spin = 3}, 0), {.spin = -1}, 0.5);
  EXPECT_LE(norm(NozzleLayers<2>(c, body).direction(0.25) - Vec<2>{std::cos(0.75), std::sin(0.75)}), 1e-12);
  EXPECT_LE(norm(NozzleLayers<2>(c, body).direction(1.5) - Vec<2>{std::cos(0.5), std::sin(0.5)}), 1e-9);
  expectRefusal([&] { steered(inflow(), {.spin = 1}, 1); }, "it has no rotation");
}

TEST(Steering, SwitchesTheFlowAtOnce) {
  Body body = steered(inflow(), {.flowRate = 7}, 0.5);
  body = steered(body, {.flowRate = 0}, 0.75);
  EXPECT_EQ(body.inflow.flowRate->at(0.5), 3);
  EXPECT_EQ(body.inflow.flowRate->at(0.6), 7);
  EXPECT_EQ(body.inflow.flowRate->at(10), 0);
  EXPECT_NEAR(body.inflow.flowRate->integral(0, 1), 1.5 + 0.25 * 7, 1e-12);
}

TEST(Steering, IsInPlaceOnceThereAreTables) {
  const Body first = steered(wall(), {.velocity = Vec<3>{5, 0, 0}}, 1);
  EXPECT_FALSE(isSteeredAlready(wall(), first));
  EXPECT_TRUE(isSteeredAlready(first, steered(first, {.velocity = Vec<3>{0, 0, 1}}, 2)));
  EXPECT_TRUE(isSteeredAlready(inflow(), steered(inflow(), {.flowRate = 1}, 2)));
}

TEST(Steering, RefusesWhatIsNotThere) {
  const Body fluid = bodyOf(BodyKind::Fluid, "honey");
  Body waves = wall(), formula = wall();
  waves.oscillation = {{1, 0, 0}, 1, 0};
  formula.displacement[0] = TimeFunction{.expression = "t^2"};
  const Steering go{.velocity = Vec<3>{1, 0, 0}};
  expectRefusal([&] { steered(fluid, go, 1); }, "velocity of 'honey': it is neither a wall nor an inflow");
  expectRefusal([&] { steered(waves, go, 1); }, "it oscillates");
  expectRefusal([&] { steered(formula, go, 1); }, "displacement is a formula, \"t^2\"");
  expectRefusal([&] { steered(wall(), {.spin = 1}, 1); }, "it has no rotation");
  expectRefusal([&] { steered(wall(), {.speed = 1}, 1); }, "it is not an inflow");
  expectRefusal([&] { steered(inflow(), {.speed = 1}, 1); }, "the case gives its flow_rate");
  expectRefusal([&] { steered(inflow(), {.flowRate = -1}, 1); }, "expected a number of at least 0");
  const double no = std::numeric_limits<double>::quiet_NaN();
  expectRefusal([&] { steered(wall(), {.velocity = Vec<3>{no, 0, 0}}, 1); }, "expected finite numbers");
}

}  // namespace
}  // namespace treacle
