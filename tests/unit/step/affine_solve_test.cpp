#include "bodies/affine_solve.hpp"

#include "treacle/core/pseudo_random.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

namespace treacle::test {
namespace {

TEST(AffineSolve, FindsTheZeroOfAnAffineFunction) {
  for (const std::size_t n : {1u, 2u, 6u, 12u}) {
    std::vector<double> a(n * n), zero(n);
    for (std::size_t i = 0; i < n; ++i) {
      zero[i] = pseudoRandom(i) - 0.5;
      for (std::size_t j = 0; j < n; ++j) a[i * n + j] = pseudoRandom(7 + i * n + j) - 0.5 + (i == j ? 1e3 : 0);
    }
    const auto f = [&](const std::vector<double>& x) {
      std::vector<double> y(n);
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j) y[i] += a[i * n + j] * (x[j] - zero[j]);
      return y;
    };
    std::vector<double> x(n, 3.0), derivative;
    const auto result = AffineSolve::run(f, x, derivative, std::vector<double>(x.size(), 1.0), 1e-9, 20);
    EXPECT_TRUE(result.converged);
    EXPECT_LE(result.values, static_cast<int>(n) + 3);
    for (std::size_t i = 0; i < n; ++i) EXPECT_NEAR(x[i], zero[i], 1e-9);
    // From a derivative of a function that is not far.
    for (double& d : a) d *= 1.05;
    x.assign(n, 3.0);
    const auto again = AffineSolve::run(f, x, derivative, std::vector<double>(x.size(), 1.0), 1e-6, 20);
    EXPECT_TRUE(again.converged);
    EXPECT_LE(again.values, 6);
    for (std::size_t i = 0; i < n; ++i) EXPECT_NEAR(x[i], zero[i], 1e-6);
  }
}

/// It keeps its value, and the derivative is not kept: later it may act.
TEST(AffineSolve, ForgetsADerivativeInWhichAnUnknownChangesNothing) {
  std::vector<double> x{2, 2}, derivative;
  const auto idle = [](const std::vector<double>& at) { return std::vector<double>{at[0] - 1, -3}; };
  EXPECT_TRUE(AffineSolve::run(idle, x, derivative, {1, 1}, 1e-9, 20).converged);
  EXPECT_NEAR(x[0], 1, 1e-9);
  EXPECT_EQ(x[1], 2);
  EXPECT_TRUE(derivative.empty());
  const auto both = [](const std::vector<double>& at) { return std::vector<double>{at[0] - 1, at[1] - 3}; };
  EXPECT_TRUE(AffineSolve::run(both, x, derivative, {1, 1}, 1e-9, 20).converged);
  EXPECT_NEAR(x[1], 3, 1e-9);
  EXPECT_EQ(derivative.size(), 4u);
}

/// From the derivative of quite another function: it would not become right in twelve steps.
TEST(AffineSolve, FindsAnewADerivativeThatLeadsAstray) {
  constexpr std::size_t n = 12;
  const auto f = [](const std::vector<double>& x) {
    std::vector<double> y(n);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) y[i] += (pseudoRandom(i * n + j) + (i == j ? 4 : 0)) * (x[j] - 0.5);
    return y;
  };
  std::vector<double> x(n, 3.0), derivative(n * n);
  for (std::size_t k = 0; k < n * n; ++k) derivative[k] = pseudoRandom(1000 + k);
  const auto result = AffineSolve::run(f, x, derivative, std::vector<double>(x.size(), 1.0), 1e-6, 12);
  EXPECT_TRUE(result.converged);
  EXPECT_LE(result.values, 25);
  for (const double found : x) EXPECT_NEAR(found, 0.5, 1e-6);
}

/// Values of a solver have errors, which may be worth more than the tolerance of a step.
TEST(AffineSolve, TakesWhatValuesWithErrorsGive) {
  std::size_t calls = 0;
  const auto f = [&](const std::vector<double>& x) {
    const double noise = 2e-5 * pseudoRandom(++calls);
    return std::vector<double>{3 * (x[0] - 0.5) + x[1] + noise, x[0] - 0.5 + 2 * x[1] - noise};
  };
  std::vector<double> x{0, 0}, derivative;
  const auto result = AffineSolve::run(f, x, derivative, std::vector<double>(x.size(), 1.0), 1e-6, 40);
  EXPECT_TRUE(result.converged);
  EXPECT_LE(result.values, 25);
  EXPECT_NEAR(x[0], 0.5, 1e-4);
  EXPECT_NEAR(x[1], 0, 1e-4);
}

/// Two unknowns of which one, coupled to the other, is held: the solution of the complementarity problem by hand.
TEST(AffineSolve, KeepsToRestraints) {
  const auto f = [](const std::vector<double>& x) {
    return std::vector<double>{2 * x[0] + x[1] - 3, x[0] + 3 * x[1] + 5};
  };
  std::vector<double> x{0, 0}, derivative;
  const Restraint floor{{0, 1}, {0, 0.5}, -1}, redundant{{0, 2}, {0, 3}, -2}, slack{{1, 0}, {1, 0}, -10};
  auto result =
      AffineSolve::run(f, x, derivative, std::vector<double>(x.size(), 1.0), 1e-9, 20, {slack, floor, redundant});
  EXPECT_TRUE(result.converged);
  EXPECT_NEAR(x[1], -1, 1e-9);  // without it -2.6
  EXPECT_NEAR(x[0], 2, 1e-9);
  // One that pulls is none.
  const Restraint below{{0, 1}, {0, 0.5}, -4};
  result = AffineSolve::run(f, x, derivative, std::vector<double>(x.size(), 1.0), 1e-9, 20, {below});
  EXPECT_TRUE(result.converged);
  EXPECT_NEAR(x[1], -2.6, 1e-9);
  EXPECT_NEAR(x[0], 2.8, 1e-9);
}

/// What lies on a plane is held by friction up to its grip, and beyond that braked against the way that it slides.
TEST(AffineSolve, GripsWhatItHolds) {
  const auto f = [](const std::vector<double>& x) {
    return std::vector<double>{2 * (x[0] - 3), 2 * (x[1] + 1), 2 * (x[2] - 4)};
  };
  Restraint floor{{0, 1, 0}, {0, 1, 0}, 0, {{{1, 0, 0}, {1, 0, 0}, 0}, {{0, 0, 1}, {0, 0, 1}, 0}}, 0.5};
  const auto found = [&] {
    std::vector<double> x{0, 0, 0}, derivative;
    EXPECT_TRUE(
        AffineSolve::run(f, x, derivative, std::vector<double>(x.size(), 1.0), 1e-9, 20, {floor}).converged);
    return x;
  };
  // The plane pushes with 2, friction with 1 in the direction (-3, -4)/5.
  std::vector<double> x = found();
  EXPECT_NEAR(x[0], 3 - 0.3, 1e-8);
  EXPECT_NEAR(x[1], 0, 1e-8);
  EXPECT_NEAR(x[2], 4 - 0.4, 1e-8);
  floor.slides[0].rest = 3;  // a plane that moves: there the push of 1 is along the other axis
  x = found();
  EXPECT_NEAR(x[0], 3, 1e-8);
  EXPECT_NEAR(x[2], 4 - 0.5, 1e-8);
  floor.grip = 5;
  x = found();
  EXPECT_NEAR(x[0], 3, 1e-8);
  EXPECT_NEAR(x[2], 0, 1e-8);
  floor.least = -2;  // that the fluid lifts it off
  x = found();
  EXPECT_NEAR(x[1], -1, 1e-8);
  EXPECT_NEAR(x[2], 4, 1e-8);
}

}  // namespace
}  // namespace treacle::test
