#include "support/scene.hpp"
#include "treacle/step/run/simulation.hpp"

#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

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

/// The velocities and the xy of the conformations after some steps of a block in shear, with the constants of a
/// fluid times `constants` and a shift factor at its temperature.
template <int D>
std::vector<double> shearedBlock(double constants, double shift) {
  Case c = freeCase<D>();
  c.heat.emplace().viscousHeating = false;
  for (Material& each : c.materials) each.specificHeat = 1000, each.conductivity = 0.1;
  Material& m = c.materials[0];
  m.dynamicViscosity = 10 * constants;
  m.elastic[0].viscosity *= constants, m.elastic[0].relaxationTime *= constants;
  m.viscosityShift = ViscosityShift{.model = ShiftModel::Table, .temperatures = {300, 400}, .factors = {1, shift}};
  Particles<D> p = freeBlock<D>(c, 2);
  p.has.temperatures = true;
  p.temperature.resize(p.fluidCount);
  for (std::uint32_t i = 0; i < p.fluidCount; ++i) p.temperature[i] = 400, p.velocity[i][0] = 3 * p.position[i][1];
  Simulation<D> s(c, std::move(p));
  for (int k = 0; k < 3; ++k) s.advance();
  s.copyParticles(p);
  std::vector<double> found;
  for (std::uint32_t i = 0; i < p.fluidCount; ++i) {
    for (int k = 0; k < D; ++k) found.push_back(p.velocity[i][k]);
    found.push_back(p.conformation[0][i](0, 1));
  }
  return found;
}

/// A warm fluid with constants of a cold one flows as one with the constants times its shift factor.
template <int D>
void checkShift() {
  const std::vector<double> shifted = shearedBlock<D>(2, 0.25), given = shearedBlock<D>(0.5, 1);
  const std::vector<double> cold = shearedBlock<D>(2, 1);
  ASSERT_EQ(shifted.size(), given.size());
  double most = 0, error = 0, change = 0;
  for (std::size_t k = 0; k < given.size(); ++k) {
    most = std::max(most, std::abs(given[k]));
    error = std::max(error, std::abs(shifted[k] - given[k]));
    change = std::max(change, std::abs(cold[k] - given[k]));
  }
  EXPECT_LT(error, 1e-9 * most);
  EXPECT_GT(change, 0.01 * most);
}
TEST(ElasticSteps, ModesFollowTheTemperature) {
  checkShift<2>();
  checkShift<3>();
}

}  // namespace
}  // namespace treacle::test
