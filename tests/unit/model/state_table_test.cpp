#include "treacle/model/materials/state_table.hpp"

#include "treacle/model/case/case.hpp"

#include <gtest/gtest.h>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <vector>

namespace treacle {
namespace {

constexpr double R = 8.31446261815324;

/// One material with states, with heat.
struct States {
  Case c;
  std::vector<FormulaStep> steps;
  StateTable table;

  States(std::initializer_list<MaterialState> states) {
    c.heat.emplace();
    c.materials.resize(1);
    c.materials[0].density = 1200, c.materials[0].specificHeat = 1500;
    c.materials[0].states = states;
    table = StateTable::make(c, steps);
    table.steps = steps.data();
  }
  /// The states and the temperature after a time, in so many steps.
  std::vector<double> after(double time, int count, std::vector<double> start, double T, double rate) const {
    double x[StateTable::variables] = {T, rate, 0};
    for (std::size_t k = 0; k < start.size(); ++k) x[StateTable::FirstState + k] = start[k];
    for (int k = 0; k < count; ++k) table.advance(0, time / count, x);
    EXPECT_NEAR(x[StateTable::Time], time, 1e-9 * time);
    start.assign(x + StateTable::FirstState, x + StateTable::FirstState + start.size());
    start.push_back(x[StateTable::Temperature]);
    return start;
  }
};

/// By small steps of fourth order (Runge, Kutta).
double integrated(const std::function<double(double)>& f, double s, double time) {
  constexpr int steps = 200000;
  const double h = time / steps;
  for (int k = 0; k < steps; ++k) {
    const double a = f(s), b = f(s + h / 2 * a), c = f(s + h / 2 * b), d = f(s + h * c);
    s += h / 6 * (a + 2 * b + 2 * c + d);
  }
  return s;
}

MaterialState resin(double heat) {
  return {.name = "cure",
          .law = StateLaw::KamalSourour,
          .a1 = 2e5,
          .e1 = 6e4,
          .a2 = 4e6,
          .e2 = 5.5e4,
          .m = 0.8,
          .n = 1.4,
          .mostConversion = 0.95,
          .heat = heat};
}
double cureRate(double s, double T) {
  return (2e5 * std::exp(-6e4 / (R * T)) + 4e6 * std::exp(-5.5e4 / (R * T)) * std::pow(s, 0.8)) *
         std::pow(std::max(0.95 - s, 0.0), 1.4);
}

TEST(StateTable, CuresAtOneTemperature) {
  const States states{resin(0)};
  for (const double time : {20.0, 200.0, 1000.0}) {
    const double exact = integrated([](double s) { return cureRate(s, 380); }, 0, time);
    EXPECT_NEAR(states.after(time, 1, {0}, 380, 0)[0] / exact, 1, 1e-3) << time;
    EXPECT_NEAR(states.after(time, 50, {0}, 380, 0)[0] / exact, 1, 3e-4) << time;
  }
}

/// What reacts warms the particle: T = T_0 + h s / c_p.
TEST(StateTable, CuresByItsOwnHeat) {
  const States states{resin(2.4e5)};
  for (const double time : {20.0, 60.0, 100.0}) {
    const double exact = integrated([](double s) { return cureRate(s, 360 + 160 * s); }, 0, time);
    const auto found = states.after(time, 20, {0}, 360, 0);
    EXPECT_NEAR(found[0] / exact, 1, 1e-3) << time;
    EXPECT_NEAR(found[1], 360 + 160 * found[0], 1e-9);
  }
}

/// However fast the law is against the step: the exact solution is exponential.
TEST(StateTable, FollowsFastBreakdown) {
  const MaterialState structure{
      .name = "structure", .law = StateLaw::Houska, .buildUp = 0.5, .breakDown = 2, .exponent = 1.5, .start = 1};
  const States states{structure};
  for (const double rate : {0.0, 0.1, 3.0, 100.0, 1e6}) {
    const double breakdown = 2 * std::pow(rate, 1.5), end = 0.5 / (0.5 + breakdown);
    for (const double time : {0.01, 1.0, 30.0}) {
      const double exact = end + (0.8 - end) * std::exp(-(0.5 + breakdown) * time);
      EXPECT_NEAR(states.after(time, 3, {0.8}, 300, rate)[0], exact, 3e-4 * exact + 1e-5) << rate << ' ' << time;
    }
  }
}

TEST(StateTable, GrowsAtRestAndStaysInItsBounds) {
  const States states{{.name = "flocs", .law = StateLaw::Roussel, .breakDown = 0.01, .time = 50, .most = 3}};
  EXPECT_NEAR(states.after(100, 10, {0}, 300, 0)[0], 2, 1e-9);
  EXPECT_EQ(states.after(1000, 10, {0}, 300, 0)[0], 3);
  EXPECT_NEAR(states.after(5000, 10, {0}, 300, 20)[0], 1 / (50 * 0.01 * 20), 1e-4);
}

/// Laws may read other states, the time and the temperature.
TEST(StateTable, IntegratesLawsOfAUser) {
  const States states{{.name = "a", .rate = "-b"}, {.name = "b", .rate = "a"}, {.name = "c", .rate = "t*T"}};
  const auto found = states.after(1, 20, {1, 0, 0}, 300, 0);
  EXPECT_NEAR(found[0], std::cos(1), 1e-3);
  EXPECT_NEAR(found[1], std::sin(1), 1e-3);
  EXPECT_NEAR(found[2], 150, 0.05);
}

TEST(StateTable, LeavesWhatIsNotFiniteAsItIs) {
  const States states{{.name = "a", .rate = "ln(-1)"}};
  EXPECT_TRUE(std::isnan(states.after(1, 1, {1}, 300, 0)[0]));
}

TEST(StateTable, MultipliesViscositiesUpToTheGel) {
  Case c;
  c.materials.resize(2);
  Material& m = c.materials[1];
  m.states = {{.name = "cure", .rate = "0"}};
  m.gelling = Gelling{.state = "cure", .conversion = 0.6, .a = 1.5, .b = -1, .mostFactor = 1000};
  m.viscosityFactor = "2 + shear_rate";
  std::vector<FormulaStep> steps;
  StateTable table = StateTable::make(c, steps);
  table.steps = steps.data();
  const auto factor = [&](int material, double cure) {
    const double x[StateTable::variables] = {0, 1, 0, cure};
    return table.viscosityFactor(material, x);
  };
  EXPECT_EQ(factor(0, 0.5), 1);
  EXPECT_DOUBLE_EQ(factor(1, 0), 3);
  EXPECT_DOUBLE_EQ(factor(1, 0.3), 3 * std::pow(2, 1.2));
  EXPECT_EQ(factor(1, 0.6), 3000);
  EXPECT_EQ(factor(1, 0.9), 3000);
  EXPECT_EQ(factor(1, 0.5999999), 3000);
}

}  // namespace
}  // namespace treacle
