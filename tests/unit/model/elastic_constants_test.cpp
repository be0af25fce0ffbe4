#include "treacle/model/materials/elastic_constants.hpp"

#include <gtest/gtest.h>
#include <cmath>
#include <vector>

namespace treacle {
namespace {

constexpr double lambda = 0.5;

ElasticConstants constantsOf(ElasticModel model, double parameter) {
  return ElasticConstants::of({.name = "mode",
                               .model = model,
                               .viscosity = 3,
                               .relaxationTime = lambda,
                               .mobility = parameter,
                               .extensibility = parameter});
}

/// Simple shear, du_x/dy = rate [1/s].
template <int D>
Block<D> shear(double rate) {
  Block<D> L{};
  L(0, 1) = rate;
  return L;
}

template <int D>
SymmetricBlock<D> after(const ElasticConstants& mode, const Block<D>& L, double time, int steps) {
  auto c = SymmetricBlock<D>::identity();
  for (int k = 0; k < steps; ++k) c = mode.advanced(L, time / steps, c);
  return c;
}

/// Start-up of shear: with w = lambda gamma and s = t/lambda, c_xy = w (1 - e^-s), c_xx = 1 + 2 w^2 (1 - (1 + s)
/// e^-s).
TEST(ElasticConstants, OldroydBIsExactInShear) {
  const ElasticConstants mode = constantsOf(ElasticModel::OldroydB, 0);
  for (const double rate : {0.2, 4.0, 100.0})
    for (const double time : {0.01, 0.5, 20.0})
      for (const int steps : {1, 7}) {
        const double w = lambda * rate, s = time / lambda;
        const SymmetricBlock<2> c = after<2>(mode, shear<2>(rate), time, steps);
        const double xy = w * (1 - std::exp(-s)), xx = 1 + 2 * w * w * (1 - (1 + s) * std::exp(-s));
        EXPECT_NEAR(c(0, 1), xy, 1e-6 * xy) << rate << ' ' << time;
        EXPECT_NEAR(c(0, 0), xx, 1e-6 * xx);
        EXPECT_NEAR(c(1, 1), 1, 1e-6);
      }
}

/// Planar extension grows without bound above 1/(2 lambda), and is that of the formula.
TEST(ElasticConstants, OldroydBIsExactInExtension) {
  const ElasticConstants mode = constantsOf(ElasticModel::OldroydB, 0);
  Block<3> L{};
  L(0, 0) = 1.5, L(1, 1) = -1.5;
  const SymmetricBlock<3> c = after<3>(mode, L, 2, 4);
  const auto exact = [](double rate) {  // x' = 2 rate x - (x - 1)/lambda from 1
    const double a = 2 * rate - 1 / lambda;
    return std::exp(2 * a) + (std::exp(2 * a) - 1) / (a * lambda);
  };
  EXPECT_NEAR(c(0, 0) / exact(1.5), 1, 1e-6);
  EXPECT_NEAR(c(1, 1) / exact(-1.5), 1, 1e-6);
  EXPECT_NEAR(c(2, 2), 1, 1e-9);
}

/// Steady shear (H. Giesekus 1982): with L = lambda gamma, chi^2 = (sqrt(1 + 16 a (1-a) L^2) - 1) / (8 a (1-a)
/// L^2), f = (1 - chi) / (1 + (1 - 2 a) chi), the shear stress is eta gamma (1 - f)^2 / (1 + (1 - 2 a) f).
TEST(ElasticConstants, GiesekusHasItsViscosity) {
  for (const double a : {0.1, 0.3, 0.5}) {
    const ElasticConstants mode = constantsOf(ElasticModel::Giesekus, a);
    for (const double rate : {0.5, 5.0, 50.0}) {
      const double w = lambda * rate, k = 8 * a * (1 - a) * w * w;
      const double chi = std::sqrt((std::sqrt(1 + 2 * k) - 1) / k), f = (1 - chi) / (1 + (1 - 2 * a) * chi);
      const double viscosity = 3 * (1 - f) * (1 - f) / (1 + (1 - 2 * a) * f);
      const SymmetricBlock<2> c = after<2>(mode, shear<2>(rate), 20, 20 * 200);
      EXPECT_NEAR(mode.modulus * c(0, 1) / rate, viscosity, 1e-3 * viscosity) << a << ' ' << rate;
    }
  }
}

/// Start-up of shear against small explicit steps of the equation.
TEST(ElasticConstants, AllModelsFollowTheirEquations) {
  for (const auto& [model, parameter] :
       {std::pair(ElasticModel::Giesekus, 0.2), std::pair(ElasticModel::LinearPtt, 0.1),
        std::pair(ElasticModel::ExponentialPtt, 0.1)}) {
    const double rate = 6, time = 1;
    const bool giesekus = model == ElasticModel::Giesekus;
    double xx = 1, xy = 0, yy = 1;
    constexpr int steps = 1000000;
    for (int k = 0; k < steps; ++k) {
      const double h = time / steps, a = xx - 1, b = xy, d = yy - 1, trace = a + d;
      const double f = giesekus                           ? 1
                       : model == ElasticModel::LinearPtt ? 1 + parameter * trace
                                                          : std::exp(parameter * trace);
      const double alpha = giesekus ? parameter : 0;
      const double dxx = 2 * rate * xy - f / lambda * (a + alpha * (a * a + b * b)),
                   dxy = rate * yy - f / lambda * (b + alpha * b * (a + d)),
                   dyy = -f / lambda * (d + alpha * (b * b + d * d));
      xx += h * dxx, xy += h * dxy, yy += h * dyy;
    }
    const SymmetricBlock<2> c = after<2>(constantsOf(model, parameter), shear<2>(rate), time, 400);
    EXPECT_NEAR(c(0, 0), xx, 1e-3 * xx) << static_cast<int>(model);
    EXPECT_NEAR(c(0, 1), xy, 1e-3 * xy);
    EXPECT_NEAR(c(1, 1), yy, 1e-3);
  }
}

/// Steps in which the fluid is strained by up to twice their length, in a flow without symmetry.
TEST(ElasticConstants, StaysPositiveDefinite) {
  Block<3> L{};
  for (int k = 0; k < 9; ++k) L.a[k] = std::sin(3.0 * k + 1) * 20;
  L(2, 2) = -L(0, 0) - L(1, 1);
  for (const auto& mode :
       {constantsOf(ElasticModel::Giesekus, 0.3), constantsOf(ElasticModel::Giesekus, 1),
        constantsOf(ElasticModel::LinearPtt, 0.5), constantsOf(ElasticModel::ExponentialPtt, 0.5)})
    for (const double dt : {1e-3, 0.03, 0.1}) {
      auto c = SymmetricBlock<3>::identity();
      for (int k = 0; k < 5; ++k) {
        c = mode.advanced(L, dt, c);
        const double minor = c(0, 0) * c(1, 1) - c(0, 1) * c(0, 1);
        const double det = c(0, 0) * (c(1, 1) * c(2, 2) - c(1, 2) * c(1, 2)) -
                           c(0, 1) * (c(0, 1) * c(2, 2) - c(1, 2) * c(0, 2)) +
                           c(0, 2) * (c(0, 1) * c(1, 2) - c(1, 1) * c(0, 2));
        EXPECT_GT(c(0, 0), 0);
        EXPECT_GT(minor, 0);
        EXPECT_GT(det, 0) << dt;
      }
    }
}

/// A rotation turns what is stretched, and stretches nothing.
TEST(ElasticConstants, TurnsWithTheFluid) {
  const ElasticConstants mode = ElasticConstants::of({.name = "mode", .viscosity = 1, .relaxationTime = 1e9});
  Block<2> L{};
  L(0, 1) = -1, L(1, 0) = 1;
  SymmetricBlock<2> c{{4, 0, 1}};
  c = mode.advanced(L, 0.5, c);
  const double s = std::sin(0.5), k = std::cos(0.5);
  EXPECT_NEAR(c(0, 0), 4 * k * k + s * s, 1e-7);
  EXPECT_NEAR(c(0, 1), 3 * s * k, 1e-7);
  EXPECT_NEAR(c(1, 1), 4 * s * s + k * k, 1e-7);
}

/// In slow flow and long steps a mode is a viscosity.
TEST(ElasticConstants, IsAViscosityInLongSteps) {
  const ElasticConstants mode = constantsOf(ElasticModel::OldroydB, 0);
  EXPECT_NEAR(mode.implicitViscosity(100), 3, 1e-12);
  EXPECT_NEAR(mode.implicitViscosity(1e-6), 3e-6 / lambda, 1e-11);
  const SymmetricBlock<2> c = mode.advanced(shear<2>(1e-3), 100, SymmetricBlock<2>::identity());
  EXPECT_NEAR(mode.modulus * c(0, 1), 3e-3, 1e-9);
}

}  // namespace
}  // namespace treacle
