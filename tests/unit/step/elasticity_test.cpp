#include "support/scene.hpp"
#include "treacle/step/run/simulation.hpp"

#include <gtest/gtest.h>
#include <cmath>
#include <utility>

namespace treacle::test {
namespace {

/// A block of an elastic fluid without walls and gravity, in stretch, among particles that are off their lattice.
template <int D>
Case freeCase() {
  Case c = sceneCase(D, false, SchemeKind::Accurate);
  c.domain.periodic = {};
  c.gravity = {};
  c.solver.tolerance = 1e-24;
  c.materials[0].elastic = {
      {.name = "polymer", .model = ElasticModel::OldroydB, .viscosity = 20, .relaxationTime = 0.05}};
  return c;
}

template <int D>
Particles<D> freeBlock(const Case& c, double stretch) {
  const double l = c.spacing;
  Particles<D> p = jitteredLattice<D>(
      c, 0.3, 5,
      [=](const Vec<D>& x) {
        for (int k = 0; k < D; ++k)
          if (x[k] < 5 * l || x[k] > 11 * l) return false;
        return true;
      },
      [](const Vec<D>&) { return false; });
  p.has.elasticModes = 1;
  p.conformation[0].resize(p.fluidCount);
  for (std::uint32_t i = 0; i < p.fluidCount; ++i) {
    p.velocity[i] = {};
    p.conformation[0][i] = SymmetricBlock<D>::identity();
    p.conformation[0][i](0, 0) = stretch;
  }
  return p;
}

/// Forces of pairs of particles cancel, so that neither momentum nor the centre of mass changes; what is stretched
/// along x draws together along x.
template <int D>
void checkFreeBlock() {
  const Case c = freeCase<D>();
  Simulation<D> s(c, freeBlock<D>(c, 3));
  for (int k = 0; k < 5; ++k) s.advance();
  Particles<D> p;
  s.copyParticles(p);
  Vec<D> sum{}, middle{};
  double most = 0, along = 0;
  for (std::uint32_t i = 0; i < p.fluidCount; ++i) middle += (1.0 / p.fluidCount) * p.position[i];
  for (std::uint32_t i = 0; i < p.fluidCount; ++i) {
    sum += p.velocity[i];
    most = std::max(most, norm(p.velocity[i]));
    along += (p.position[i] - middle)[0] * p.velocity[i][0];
  }
  EXPECT_GT(most, 0);
  EXPECT_LT(along, 0);
  EXPECT_LT(norm(sum), 1e-8 * most * p.fluidCount);
}
TEST(ElasticSteps, KeepMomentum) {
  checkFreeBlock<2>();
  checkFreeBlock<3>();
}

}  // namespace
}  // namespace treacle::test
