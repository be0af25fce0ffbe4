#include "treacle/step/run/simulation.hpp"

#include "support/gas_case.hpp"
#include "support/isph_cases.hpp"
#include "support/oracle.hpp"
#include "support/rigid_cases.hpp"
#include "support/state_of.hpp"

#include <gtest/gtest.h>

namespace treacle::test {
namespace {

/// Fluid and wall particles of a scene as a simulation takes them over.
template <int D>
struct Start {
  Scene<D> scene;
  explicit Start(Walls walls) : scene(makeScene<D>({.walls = walls})) {
    for (int k = 0; k < D; ++k) scene.c.gravity[k] = k == D - 1 ? -10 : 0;
  }
  Simulation<D> simulation() { return Simulation<D>(scene.c, std::move(scene.particles)); }
};

/// One step against the direct solution of [K23 eq. (16)] from the formulas.
template <int D>
void checkStep(OperatorKind operatorKind, PreconditionerKind preconditioner, KrylovKind krylov,
               Precision precision) {
  Start<D> start(Walls::Floor);
  Scene<D>& s = start.scene;
  s.c.solver.krylov = krylov;
  s.c.solver.preconditioner = preconditioner;
  s.c.solver.operatorKind = operatorKind;
  s.c.solver.precision = precision;
  s.c.solver.tolerance = 1e-20;
  const Oracle<D> oracle(s);
  const Vector elastic = oracle.elasticPressure();
  const Vector u = solve(oracle.matrix(), oracle.rightHandSide());
  const Vector divergence = oracle.gradientMatrix().transpose() * u;
  std::vector<Vec<D>> x(s.particles.position.begin(), s.particles.position.begin() + s.n());
  std::vector<std::uint32_t> id(s.particles.id.begin(), s.particles.id.end());
  std::vector<double> pressure(s.n());
  for (std::uint32_t i = 0; i < s.n(); ++i)
    pressure[i] = oracle.material(i).bulkViscosity * divergence[i] + elastic[i];

  const CellGrid<D> grid = s.pairs().grid;
  Simulation<D> simulation = start.simulation();
  const StepReport report = simulation.advance();
  EXPECT_LE(report.residual, s.c.solver.tolerance);
  EXPECT_EQ(report.step, 1);
  const double speed = u.cwiseAbs().maxCoeff(), stress = *std::max_element(pressure.begin(), pressure.end());
  for (std::uint32_t i = 0; i < s.n(); ++i) {
    const Particles<D>& p = simulation.particles();
    const std::uint32_t k = std::find(id.begin(), id.end(), p.id[i]) - id.begin();
    Vec<D> moved = x[k];
    for (int a = 0; a < D; ++a) {
      ASSERT_NEAR(p.velocity[i][a], u[D * k + a], 1e-7 * speed);
      moved[a] += s.c.time.step * u[D * k + a];
    }
    ASSERT_TRUE(grid.wrap(moved));
    for (int a = 0; a < D; ++a) ASSERT_NEAR(p.position[i][a], moved[a], 1e-7 * speed * s.c.time.step);
    ASSERT_NEAR(p.pressure[i], pressure[k], 5e-8 * stress);  // measured: 1e-8
  }
}

TEST(Simulation, StepEqualsTheDirectSolution) {
  using enum PreconditionerKind;
  for (OperatorKind a : {OperatorKind::MatrixFree, OperatorKind::Assembled})
    for (PreconditionerKind k : {None, Jacobi, BlockJacobi, BucketMultigrid, ProjectedMultigrid})
      for (KrylovKind krylov : {KrylovKind::Cg, KrylovKind::Cr}) checkStep<2>(a, k, krylov, Precision::Double);
  checkStep<3>(OperatorKind::MatrixFree, BucketMultigrid, KrylovKind::Cr, Precision::Double);
  checkStep<2>(OperatorKind::MatrixFree, BucketMultigrid, KrylovKind::Cg, Precision::Mixed);
  checkStep<2>(OperatorKind::MatrixFree, BucketMultigrid, KrylovKind::Cr, Precision::Mixed);
  checkStep<2>(OperatorKind::MatrixFree, BlockJacobi, KrylovKind::Cg, Precision::Mixed);
  checkStep<2>(OperatorKind::MatrixFree, ProjectedMultigrid, KrylovKind::Cg, Precision::Mixed);
  checkStep<3>(OperatorKind::MatrixFree, ProjectedMultigrid, KrylovKind::Cg, Precision::Mixed);
}

/// Without gravity and bulk modulus every step dissipates.
template <int D>
void checkEnergy() {
  Start<D> start(Walls::Floor);
  start.scene.c.gravity = {};
  for (Material& m : start.scene.c.materials) m.bulkModulus = 0;
  Simulation<D> simulation = start.simulation();
  double energy = simulation.diagnostics().kineticEnergy;
  ASSERT_GT(energy, 0);
  for (int k = 0; k < 20; ++k) {
    const double next = simulation.advance().diagnostics.kineticEnergy;
    EXPECT_LE(next, energy) << "step " << k + 1;
    energy = next;
  }
}

TEST(Simulation, KineticEnergyNeverGrowsWithoutGravityAndBulkModulus) {
  checkEnergy<2>();
  checkEnergy<3>();
}

TEST(Simulation, ConservesLinearMomentumWithoutWallsAndGravity) {
  Start<2> start(Walls::None);
  start.scene.c.gravity = {};
  start.scene.c.solver.tolerance = 1e-24;
  const auto momentum = [&](const Particles<2>& p) {
    Vec<2> sum{};
    for (std::uint32_t i = 0; i < p.fluidCount; ++i)
      sum += start.scene.c.materials[p.material[i]].density * p.velocity[i];
    return sum;
  };
  double scale = 0;
  for (const auto& u : start.scene.particles.velocity) scale += 1e3 * norm(u);
  const Vec<2> before = momentum(start.scene.particles);
  Simulation<2> simulation = start.simulation();
  for (int k = 0; k < 10; ++k) simulation.advance();
  EXPECT_LT(norm(momentum(simulation.particles()) - before), 1e-11 * scale);  // measured: 2e-12
}

TEST(Simulation, MovesWithItsWalls) {
  Start<2> start(Walls::Floor);
  start.scene.c.gravity = {};
  for (Material& m : start.scene.c.materials) m.bulkModulus = 0;
  const Vec<2> velocity{0.03, 0};
  for (auto& u : start.scene.particles.velocity) u = velocity;
  Simulation<2> simulation = start.simulation();
  for (int k = 0; k < 5; ++k) simulation.advance();
  // The first guess is the solution but for rounding.
  for (const auto& u : simulation.particles().velocity) ASSERT_LT(norm(u - velocity), 1e-15);
}

TEST(Simulation, MovingWallDragsFluidAlong) {
  Start<2> start(Walls::Floor);
  start.scene.c.gravity = {};
  auto& p = start.scene.particles;
  for (std::uint32_t i = 0; i < p.count; ++i) p.velocity[i] = i < p.fluidCount ? Vec<2>{} : Vec<2>{0.03, 0};
  Simulation<2> simulation = start.simulation();
  for (int k = 0; k < 200; ++k) simulation.advance();
  // So viscous a body that small rides with the wall after some l^2 rho / mu = 0.1 ms.
  Vec<2> mean{};
  for (std::uint32_t i = 0; i < simulation.particles().fluidCount; ++i) mean += simulation.particles().velocity[i];
  mean *= 1.0 / simulation.particles().fluidCount;
  EXPECT_NEAR(mean[0], 0.03, 3e-5);  // measured: 9e-6 less
}

TEST(Simulation, DiagnosticsAreTheSumsTheyAreCalled) {
  Start<2> start(Walls::Floor);
  const Scene<2>& s = start.scene;
  double kinetic = 0, potential = 0, front = -1, top = -1;
  for (std::uint32_t i = 0; i < s.n(); ++i) {
    const auto& x = s.particles.position[i];
    const double mass = s.c.materials[s.particles.material[i]].density * 1e-6;
    kinetic += 0.5 * mass * norm2(s.particles.velocity[i]);
    potential += mass * 10 * x[1];
    front = std::max(front, x[0]);
    top = std::max(top, x[1]);
  }
  const Diagnostics d = start.simulation().diagnostics();
  EXPECT_NEAR(d.kineticEnergy, kinetic, 1e-12 * kinetic);
  EXPECT_NEAR(d.potentialEnergy, potential, 1e-12 * potential);
  EXPECT_EQ(d.frontX, front);
  EXPECT_EQ(d.top, top);
}

/// Walls hold a fluid by its own viscosity, whatever they are made of, but for walls without any. Nor do they
/// change the velocity gradients that elastic stresses and the stiffness under pressure are made of.
TEST(Simulation, WallsOfAnotherMaterialHoldAFluidAsItsOwn) {
  enum Kind { Viscous, Elastic, Stiff, Isph };
  for (const Kind kind : {Viscous, Elastic, Stiff, Isph}) {
    const auto moved = [&](double viscosity) {
      Case c = plugOnGas(2);
      c.gas.reset();
      Material& honey = c.materials[0];
      honey.slipLength = 0;
      if (kind == Elastic) honey.elastic = {{"polymer", ElasticModel::OldroydB, 10, 0.05}};
      c.solver.tolerance = 1e-24;
      if (kind == Stiff) honey.dynamicViscosity = 0.1, c.gravity[1] = -100, c.time.step = 2e-3;
      if (kind == Isph) c = withIsph(c, 10);
      c.materials.push_back(c.materials[0]);
      c.materials[1].name = "steel", c.materials[1].dynamicViscosity *= viscosity, c.materials[1].elastic.clear();
      c.bodies[1].material = 1;
      Simulation<2> simulation(c, created<2>(c));
      for (int k = 0; k < 30; ++k) simulation.advance();
      return stateOf(simulation).position;
    };
    const auto own = moved(1), other = moved(0.01), none = moved(0);
    double most = 0, without = 0;
    for (std::size_t k = 0; k < 100; ++k)
      most = std::max(most, norm(own[k] - other[k])), without = std::max(without, norm(own[k] - none[k]));
    // Where fluid falls on the floor, its repulsion has the mean of both viscosities.
    EXPECT_LT(most, kind == Stiff ? 1e-6 : 1e-9) << kind;
    // Elastic stresses hold fluid at any wall.
    if (kind != Elastic) {
      EXPECT_GT(without, 1e-5) << kind;
    }
  }
}

}  // namespace
}  // namespace treacle::test
