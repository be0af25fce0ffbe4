#include "support/scene.hpp"
#include "treacle/step/run/simulation.hpp"

#include <gtest/gtest.h>

namespace treacle::test {
namespace {

/// Distance of two particles that meet alone at 0.1 l, after each step.
template <int D>
std::vector<double> distances(double step, int steps) {
  Case c = sceneCase(D, false, SchemeKind::Accurate);
  c.time.step = step;
  c.solver.tolerance = 1e-20;
  c.materials[0].bulkViscosity = c.materials[0].bulkModulus = 0;  // else the pair's own divergence holds it back
  Particles<D> p;
  p.resize(2, 0);
  for (std::uint32_t i = 0; i < 2; ++i) {
    for (int k = 0; k < D; ++k) p.position[i][k] = 10.2e-3;
    p.position[i][0] += 0.08e-3 * i;
    p.position[i][1] += 0.06e-3 * i;
    p.velocity[i] = {};
    p.material[i] = p.body[i] = 0;
    p.pressure[i] = p.numberDensity[i] = 0;
    p.id[i] = i;
  }
  Simulation<D> s(c, std::move(p));
  std::vector<double> r;
  double first = 0;
  for (int n = 0; n < steps; ++n) {
    s.advance();
    r.push_back(norm(s.particles().position[1] - s.particles().position[0]) / c.spacing);
    const Vec<D> sum = s.particles().velocity[0] + s.particles().velocity[1];
    if (n == 0) first = norm(s.particles().velocity[0]);
    EXPECT_LE(norm(sum), 1e-9 * first);  // their momentum stays zero
  }
  return r;
}

template <int D>
void checkPair(double step) {
  const std::vector<double> r = distances<D>(step, 40);
  for (std::size_t n = 1; n < r.size(); ++n) EXPECT_GE(r[n], r[n - 1] - 1e-6) << "step " << n;
  EXPECT_GT(r[0], 0.1);
  EXPECT_GT(r.back(), 0.5);
  EXPECT_LT(r.back(), 1.5);  // their inertia carries them on until their viscosity stops them; measured: 1.2
}

TEST(Repulsion, BringsApartAPairThatMetWithoutThrowingIt) {
  for (const double step : {1e-4, 1e-3, 1e-2}) {
    checkPair<2>(step);
    checkPair<3>(step);
  }
}

}  // namespace
}  // namespace treacle::test
