#include "mpi/compare_simulations.hpp"
#include "support/passing_body.hpp"
#include "support/rigid_cases.hpp"
#include "treacle/isph/isph_pairs.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace treacle::test {
namespace {

/// In a solve dot products and what is on grids are rounded otherwise than in one process; what its tolerance
/// leaves open hardly changes while the iterations are as many. Where they are not sure to be, the tolerance is
/// smaller.
TEST(SharedIsph, DamBreak) {
  compare<2>({"isph-dam-break-2d.toml", 20, {}});
  compare<2>({"isph-dam-break-2d.toml", 10, {"solver.precision=double"}});
  compare<2>({"isph-dam-break-2d.toml", 3, {"solver.preconditioner=jacobi", "solver.tolerance=1e-18"}});
  compare<2>({"isph-dam-break-2d.toml", 3, {"solver.preconditioner=none", "solver.tolerance=1e-18"}});
}

/// [O23]'s, of the matrix of all processes.
TEST(SharedIsph, CellMultigrid) {
  const std::string cells = "solver.preconditioner=cell-multigrid", exact = "solver.tolerance=1e-18";
  compare<2>({"isph-dam-break-2d.toml", 5, {cells, exact}});
  compare<3>({"isph-dam-break.toml", 2, {cells, exact, "resolution=0.4", "solver.cells.levels=2"}});
  compare<2>({"../tests/validation/cases/isph-taylor-green.toml", 3, {cells, exact}});
}

TEST(SharedIsph, ThreeDimensions) { compare<3>({"isph-dam-break.toml", 4, {"resolution=0.4"}}); }

TEST(SharedIsph, MovingWalls) { compare<2>({"isph-sloshing.toml", 10, {}}); }

/// A channel that is full, between a plate at rest and one that moves, with implicit viscosity: the level of the
/// pressure is that of all processes.
TEST(SharedIsph, ImplicitViscosityWithoutSurface) {
  compare<2>({"../tests/validation/cases/isph-couette.toml", 10, {"solver.tolerance=1e-18"}});
}

/// Each full tank has a level of its own, which all processes with a part of it must find.
TEST(SharedIsph, FullTanksBesideAnOpenOne) {
  compare<2>({"../tests/mpi/tanks.toml", 10, {"solver.tolerance=1e-18"}});
}

/// Shifted particles that go around periodic ends; pressures of either sign.
TEST(SharedIsph, ShiftingWithoutSurface) {
  compare<2>({"../tests/validation/cases/isph-taylor-green.toml", 10, {"solver.tolerance=1e-18"}});
}

TEST(SharedIsph, DividedGrids) {
  if (job().size() == 1) return;
  compare<2>({"isph-dam-break-2d.toml",
              5,
              {"resolution=2", "solver.divided_nodes=0", "solver.tolerance=1e-16", "solver.precision=double"}});
  compare<3>({"isph-dam-break.toml",
              2,
              {"resolution=0.4", "solver.divided_nodes=0", "solver.tolerance=1e-16", "solver.precision=double"}});
}

TEST(SharedIsph, WallsComeAndGo) {
  Case c = passingBody(2, MethodKind::Isph);
  c.solver.tolerance = 1e-18;
  compareWallsThatComeAndGo(c);
}

/// The velocities of bodies are found to a tolerance, in as many solves as roundings let it take.
void compareBodies(const Case& c, int steps, double scale) {
  Simulation<2> shared(c, partOf<2>(c), 0, 0, &job()), alone(c, made<2>(c));
  for (int k = 0; k < steps; ++k) {
    const auto a = shared.advance().rigid, b = alone.advance().rigid;
    for (std::size_t n = 0; n < a.size(); ++n) {
      EXPECT_EQ(a[n].mass, b[n].mass);
      EXPECT_LT(norm(a[n].velocity - b[n].velocity), scale);
      EXPECT_LT(norm(a[n].center - b[n].center), scale * c.time.step * steps);
    }
  }
}

TEST(SharedIsph, RigidBodies) {
  compareBodies(Settings{"isph-floating-block-2d.toml", 0, {}}.read(), 5, 1e-8);
  for (const double viscosity : {1e-3, 5.0}) {
    Case c = withIsph(blockCase(2, 300), viscosity);
    c.gravity = {1, -10, 0};
    c.bodies[1].rigid.angularVelocity = {0, 0, 5};
    compareBodies(c, 5, 1e-6);
  }
}

TEST(SharedIsph, RigidBodiesThatTouch) { compareBodies(withIsph(fallingBlockCase(2, 30), 5), 20, 1e-3 * 0.6); }

TEST(SharedIsph, SameBitsFromRunToRun) { expectSameBitsAgain("isph-dam-break-2d.toml"); }

TEST(SharedIsph, FallsBack) {
  const Case c = Settings{"isph-dam-break-2d.toml", 0, {"solver.hats.iteration_bound=2"}}.read();
  Simulation<2> shared(c, partOf<2>(c), 0, 0, &job());
  const StepReport report = shared.advance();
  EXPECT_EQ(report.fallbacks, 2);
  EXPECT_LE(report.residual, c.solver.tolerance);
}

/// A drop, in the corners of four cells at first, falls through cells that have room for all of it: then there is
/// nothing left to do for other processes.
TEST(SharedIsph, ProcessesWithoutFluid) {
  const std::vector<std::string> keys = {"method.viscosity=implicit", "water.dynamic_viscosity=1",
                                         "solver.tolerance=1e-18"};
  Case c = Settings{"isph-dam-break-2d.toml", 0, keys}.read();
  c.bodies.resize(1);
  const CellGrid<2> grid = makeIsphPairs<2>(c).grid;
  Shape& drop = c.bodies[0].shape;
  drop.kind = ShapeKind::Sphere;
  drop.radius = 1.5 * c.spacing;
  drop.center = {grid.origin[0] + 50 * grid.edge[0], grid.origin[1] + 80 * grid.edge[1], 0};
  c.gravity = {-200, -200, 0};
  Simulation<2> shared(c, partOf<2>(c), 0, 0, &job()), alone(c, made<2>(c));
  bool someHadNone = false;
  for (int k = 0; k < 40; ++k) {
    const StepReport a = shared.advance(), b = alone.advance();
    expectSame(c, a, b, job().size() == 1);
    for (std::uint32_t own : job().all(shared.particles().fluidCount)) someHadNone = someHadNone || own == 0;
  }
  EXPECT_EQ(someHadNone, job().size() > 1);
}

}  // namespace
}  // namespace treacle::test
