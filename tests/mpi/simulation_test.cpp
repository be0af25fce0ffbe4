#include "mpi/compare_simulations.hpp"
#include "support/gas_case.hpp"
#include "support/passing_body.hpp"
#include "support/rigid_cases.hpp"
#include "treacle/mph/mph_pairs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace treacle::test {
namespace {

/// What the tolerance of a solve leaves open depends on its iterations, whose number and, with deflation, whose
/// modes may change with a rounding: where that shows the tolerance is smaller, or nothing is deflated.
TEST(SharedSimulation, BlockJacobi) {
  compare<2>({"dam-break-2d.toml", 4, {"solver.preconditioner=block-jacobi", "solver.tolerance=1e-18"}});
  compare<2>({"published/dam-break-2d.toml", 4, {"solver.preconditioner=block-jacobi", "solver.tolerance=1e-18"}});
}

TEST(SharedSimulation, ProjectedMultigrid) {
  compare<2>({"dam-break-2d.toml", 20, {}});
  compare<2>({"published/dam-break-2d.toml", 20, {}});
  compare<2>({"dam-break-2d.toml", 20, {"solver.precision=double", "solver.deflation=0"}});
  compare<2>({"dam-break-2d.toml", 20, {"resolution=2", "output.balance=true", "solver.tolerance=1e-16"}});
}

/// Steps in which the pressure moves particles by more than half a spacing, of one fluid and of one that flows on
/// a rheology.
TEST(SharedSimulation, LongSteps) {
  const std::string longer = "time.step=5e-3", weight = "gravity.acceleration=[0,-100]",
                    softer = "material.fluid.bulk_modulus=1e5", exact = "solver.tolerance=1e-18",
                    plain = "solver.deflation=0";
  compare<2>({"dam-break-2d.toml", 8, {longer, weight, softer, exact, plain}});
  compare<2>({"grease-dam-break-2d.toml", 5, {"resolution=0.5", longer, weight, exact, plain}});
}

TEST(SharedSimulation, ThreeDimensions) {
  compare<3>({"dam-break-3d.toml", 3, {"resolution=0.7", "solver.tolerance=1e-16"}});
  compare<3>({"published/dam-break-3d.toml", 3, {"resolution=0.7", "solver.tolerance=1e-16"}});
}

/// [K23]'s: a process has the buckets of its search cells and their neighbours, all have the coarser ones.
TEST(SharedSimulation, BucketMultigrid) {
  const std::string buckets = "solver.preconditioner=bucket-multigrid", exact = "solver.tolerance=1e-18";
  compare<2>({"published/dam-break-2d.toml", 5, {buckets, exact}});
  compare<2>({"dam-break-2d.toml", 3, {buckets, exact, "solver.precision=mixed"}});
  compare<3>({"dam-break-3d.toml", 2, {buckets, exact, "resolution=0.7"}});
  compare<2>({"../tests/validation/cases/couette.toml", 5, {buckets, exact}});
}

/// Grids whose nodes the processes divide: the two finest of the first case; those below stand whole at every
/// process.
TEST(SharedSimulation, DividedGrids) {
  if (job().size() == 1) return;  // there is nothing to divide
  const std::string divided = "solver.divided_nodes=0", exact = "solver.tolerance=1e-16",
                    plain = "solver.deflation=0";
  compare<2>({"dam-break-2d.toml", 2, {"resolution=4", divided, exact, plain}});
  compare<3>({"dam-break-3d.toml", 2, {"resolution=0.6", divided, exact, plain}});
  compare<2>({"../tests/validation/cases/couette.toml", 10, {divided, exact, plain, "solver.precision=double"}});
}

/// Fluid that goes around periodic ends, and a plate that moves. (By a preconditioner in single precision a step
/// takes 9 to 11 iterations to this tolerance, as its roundings fall.)
TEST(SharedSimulation, PeriodicFlowAndMovingWalls) {
  compare<2>({"../tests/validation/cases/couette.toml",
              20,
              {"solver.tolerance=1e-16", "solver.deflation=0", "solver.precision=double"}});
}

TEST(SharedSimulation, TurningWalls) {
  compare<2>(
      {"../tests/validation/cases/taylor-couette.toml", 10, {"solver.tolerance=1e-20", "solver.deflation=0"}});
}

TEST(SharedSimulation, FluidWithARheology) {
  compare<2>({"grease-dam-break-2d.toml", 5, {"resolution=0.5", "solver.tolerance=1e-18", "solver.deflation=0"}});
}

/// Temperatures from plates, from what the viscosity and elastic stresses take, and of a gob that a wall and its
/// surroundings cool.
TEST(SharedSimulation, FluidWithHeat) {
  compare<2>({"../tests/validation/cases/heated-couette.toml",
              10,
              {"solver.tolerance=1e-18", "solver.deflation=0", "heat.tolerance=1e-20"}});
  compare<2>({"../tests/validation/cases/heated-couette-elastic.toml",
              10,
              {"solver.tolerance=1e-18", "solver.deflation=0", "heat.tolerance=1e-20"}});
  compare<2>({"glass-gob-2d.toml", 5, {"solver.tolerance=1e-18", "solver.deflation=0", "heat.tolerance=1e-20"}});
}

/// Oil in a tank that takes more volume.
TEST(SharedSimulation, FluidThatExpands) {
  compare<2>({"../tests/validation/cases/expanding-tank.toml",
              20,
              {"solver.tolerance=1e-20", "solver.deflation=0", "material.oil.volume_factor=1 + t"}});
}

/// What particles remember: a resin that cures, and a drop of an elastic fluid that hits a plate.
TEST(SharedSimulation, FluidWithAMemory) {
  compare<2>({"../tests/validation/cases/cure.toml",
              5,
              {"solver.tolerance=1e-20", "solver.deflation=0", "heat.tolerance=1e-20"}});
  compare<2>({"elastic-drop-2d.toml",
              10,
              {"solver.tolerance=1e-18", "solver.deflation=0", "drop.center=[0,0.0102]", "resolution=0.5"}});
}

/// A drop that freezes on a cold plate, and rises where it is warm.
TEST(SharedSimulation, FluidThatFreezesAndRises) {
  compare<2>({"freezing-drop-2d.toml",
              10,
              {"solver.tolerance=1e-18", "solver.deflation=0", "heat.tolerance=1e-20", "drop.temperature=331.5",
               "polymer.thermal_expansion=6e-3"}});
}

/// A nozzle pours into a mould, which overflows into a drain.
TEST(SharedSimulation, FluidThatComesAndGoes) {
  const std::string exact = "solver.tolerance=1e-22", plain = "solver.deflation=0";
  compare<2>({"filling-2d.toml", 40, {exact, plain, "resolution=4"}});
  compare<2>(
      {"filling-2d.toml", 60, {exact, plain, "resolution=4", "drain.min=[-0.02,0]", "drain.max=[0.065,0.0595]"}});
  compare<2>({"filling-2d.toml",
              30,
              {exact, plain, "resolution=4", "drain.min=[-0.02,0]", "drain.max=[0.065,0.0595]",
               "nozzle.rotation={center=[0.002,0.062],angle='20*t'}"}});
  compare<2>({"filling-2d.toml", 40, {exact, plain, "resolution=4", "nozzle.profile=parabolic"}});
}

/// Every process knows on which side of a thin sheet its particles and its ghosts are.
TEST(SharedSimulation, ThinSheets) {
  compare<2>({"thin-cup-2d.toml", 15, {"solver.tolerance=1e-22", "solver.deflation=0", "time.step=2e-3"}});
}

/// Through openings, to and fro.
TEST(SharedSimulation, FluidThatAPressureDrives) {
  compare<2>({"pumped-channel-2d.toml", 40, {"solver.tolerance=1e-22", "solver.deflation=0", "resolution=2"}});
}

/// A nozzle narrower than a search cell: what it begins with is too little to be divided, and what comes is given
/// to processes that had nothing, even if those that had some were as uneven before.
TEST(SharedSimulation, BeginsWithALayerOfAnInflow) {
  const Settings jet{"buckling-jet-2d.toml",
                     60,
                     {"nozzle.nozzle.width=0.003", "nozzle.speed=1", "solver.tolerance=1e-22",
                      "solver.deflation=0", "solver.precision=double"}};
  compare<2>(jet);
  const auto processesWithFluid = [](const Simulation<2>& shared) {
    const std::vector<std::uint32_t> own = job().all(shared.particles().fluidCount);
    return static_cast<int>(own.size() - static_cast<std::size_t>(std::ranges::count(own, 0u)));
  };
  const Case c = jet.read();
  Simulation<2> shared(c, partOf<2>(c), 0, 0, &job());
  EXPECT_LE(processesWithFluid(shared), 2);
  for (int k = 0; k < jet.steps; ++k) shared.advance();
  EXPECT_EQ(processesWithFluid(shared), job().size());
}

/// Where nothing comes in a process without a cell would never have anything to do.
TEST(SharedSimulation, HasNoMoreProcessesThanCells) {
  Case c = Settings{"dam-break-2d.toml", 0, {}}.read();
  const CellGrid<2> grid = makeMphPairs<2>(c).grid;
  c.bodies.resize(1);
  c.bodies[0].shape.kind = ShapeKind::Sphere;
  c.bodies[0].shape.radius = 1.2 * c.spacing;
  c.bodies[0].shape.center = {grid.origin[0] + 2.5 * grid.edge[0], grid.origin[1] + 2.5 * grid.edge[1], 0};
  bool refused = false;
  try {
    Simulation<2>(c, partOf<2>(c), 0, 0, &job());
  } catch (const InputError&) {
    refused = true;
  }
  EXPECT_EQ(refused, job().size() > 1);
}

/// Sums are over all, and the first process gets all particles that are near, each once, walls too.
TEST(SharedSimulation, ProbesReadTheSame) {
  Case c = Settings{"dam-break-2d.toml", 0, {"solver.tolerance=1e-18", "solver.deflation=0"}}.read();
  const auto probe = [&](ProbeKind kind, Vec<3> point, Vec<3> normal) {
    Probe p;
    p.name = std::to_string(c.probes.size()), p.kind = kind, p.point = point, p.normal = normal;
    c.probes.push_back(p);
  };
  probe(ProbeKind::Region, {}, {});
  probe(ProbeKind::Region, {0, 7.3e-3, 0}, {0.1, 1, 0});
  probe(ProbeKind::Flow, {12e-3, 0, 0}, {1, 0, 0});
  Probe line;
  line.name = "line", line.kind = ProbeKind::Line, line.to = {20e-3, 20e-3, 0};
  c.probes.push_back(line);
  Simulation<2> shared(c, partOf<2>(c), 0, 0, &job()), alone(c, made<2>(c));
  for (int k = 0; k < 5; ++k) shared.advance(), alone.advance();
  const std::vector<ProbeReading> a = shared.measure(0b1111), b = alone.measure(0b1111);
  ASSERT_EQ(a.size(), 4u);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(a[k].sums.volume, b[k].sums.volume, 1e-9 * b[k].sums.volume);
    EXPECT_NEAR(a[k].sums.flow[0], b[k].sums.flow[0], 1e-9 * b[k].sums.volume);
    EXPECT_NEAR(a[k].sums.moment[1], b[k].sums.moment[1], 1e-9 * b[k].sums.moment[1]);
  }
  if (job().rank() > 0) return;
  const auto ids = [](const ProbeReading& reading) {
    const Particles<2>& p = reading.particles.of<2>();
    std::vector<std::uint32_t> sorted(p.id.begin(), p.id.end());
    std::ranges::sort(sorted);
    return std::pair(p.fluidCount, sorted);
  };
  EXPECT_GT(b[3].particles.of<2>().wallCount(), 10u);
  EXPECT_EQ(ids(a[3]), ids(b[3]));
}

/// The velocities of bodies are found to a tolerance, in as many solves as roundings let it take.
TEST(SharedSimulation, RigidBodies) {
  const Case c = Settings{"floating-block-2d.toml", 0, {"solver.deflation=0"}}.read();
  Simulation<2> shared(c, partOf<2>(c), 0, 0, &job()), alone(c, made<2>(c));
  for (int k = 0; k < 5; ++k) {
    const RigidBody a = shared.advance().rigid[0], b = alone.advance().rigid[0];
    EXPECT_EQ(a.mass, b.mass);
    EXPECT_LT(norm(a.velocity - b.velocity), 1e-6 * norm(b.velocity));
    EXPECT_LT(norm(a.center - b.center), 1e-9 * c.spacing);
  }
}

/// Until a block has landed on its corner and its side, beside fluid and far from it.
TEST(SharedSimulation, RigidBodiesThatTouch) {
  for (Case c : {fallingBlockCase(2, 30), withDistantFluid(fallingBlockCase(2, 30))}) {
    c.solver.deflation = 0;
    c.bodies[1].friction = c.bodies[2].friction = 0.5;
    Simulation<2> shared(c, partOf<2>(c), 0, 0, &job()), alone(c, made<2>(c));
    for (int k = 0; k < 20; ++k) {
      const RigidBody a = shared.advance().rigid[1], b = alone.advance().rigid[1];
      EXPECT_LT(norm(a.velocity - b.velocity), 1e-3 * 0.6);
      EXPECT_LT(norm(a.center - b.center), 1e-3 * c.spacing);
    }
  }
}

/// Gas whose pockets reach over all processes, and one that carries a rigid body.
TEST(SharedSimulation, TrappedGas) {
  const auto expectSameGas = [](const Case& c, const StepReport& a, const StepReport& b) {
    ASSERT_EQ(b.gas->pockets, 1u);
    ASSERT_EQ(a.gas->pockets, 1u);
    EXPECT_NEAR(a.gas->volume, b.gas->volume, 10 * roundingOf(c) * b.gas->volume);
    EXPECT_NEAR(a.gas->pressure, b.gas->pressure, 1000 * roundingOf(c) * c.gas->pressure);
  };
  const auto compareGas = [&]<int D>(const Case& c, int steps) {
    Simulation<D> shared(c, partOf<D>(c), 0, 0, &job()), alone(c, made<D>(c));
    for (int k = 0; k < steps; ++k) {
      const StepReport a = shared.advance(), b = alone.advance();
      expectSameGas(c, a, b);
      for (std::size_t body = 0; body < b.rigid.size(); ++body)
        EXPECT_LT(norm(a.rigid[body].center - b.rigid[body].center), 1e-6 * c.spacing);
    }
    EXPECT_EQ(shared.particles().gas.cells, alone.particles().gas.cells);
  };
  for (const int dimensions : {2, 3}) {
    Case c = plugOnGas(dimensions);
    c.solver.tolerance = 1e-22, c.solver.deflation = 0;
    dimensions == 2 ? compareGas.operator()<2>(c, 10) : compareGas.operator()<3>(c, 3);
  }
  Case bell = bellInHoney(400);
  bell.solver.deflation = 0;
  compareGas.operator()<2>(bell, 5);
  Case isph = withIsph(bellInHoney(400), 0.5);
  isph.time.step = 5e-4;
  compareGas.operator()<2>(isph, 5);
}

TEST(SharedSimulation, SeveralFluids) {
  compare<2>({"honey-and-syrup-2d.toml", 10, {"solver.tolerance=1e-18", "solver.deflation=0"}});
  compare<2>(
      {"../tests/validation/cases/two-layer-couette.toml", 3, {"solver.tolerance=1e-18", "solver.deflation=0"}});
}

TEST(SharedSimulation, FluidWithASurfaceTension) {
  compare<2>(
      {"dam-break-2d.toml",
       5,
       {"fluid.surface_tension=1", "fluid.contact_angle=60", "solver.tolerance=1e-18", "solver.deflation=0"}});
  compare<3>({"dam-break-3d.toml",
              3,
              {"fluid.surface_tension=1", "resolution=0.5", "solver.tolerance=1e-18", "solver.deflation=0"}});
}

TEST(SharedSimulation, AutomaticSteps) {
  compare<2>({"dam-break-2d.toml", 20, {"time.step=auto", "solver.tolerance=1e-18"}});
}

TEST(SharedSimulation, WallsComeAndGo) {
  Case c = passingBody(2, MethodKind::MphI);
  c.solver.tolerance = 1e-22;
  c.solver.deflation = 0;
  compareWallsThatComeAndGo(c);
}

TEST(SharedSimulation, SameBitsFromRunToRun) { expectSameBitsAgain("dam-break-2d.toml"); }

/// A way to solve that gives up is followed by the next one at all processes, to the last resort.
TEST(SharedSimulation, FallsBack) {
  const Case c = Settings{"dam-break-2d.toml", 0, {"solver.projected.iteration_bound=2"}}.read();
  Simulation<2> shared(c, partOf<2>(c), 0, 0, &job());
  const StepReport report = shared.advance();
  EXPECT_EQ(report.fallbacks, 2);
  EXPECT_LE(report.residual, c.solver.tolerance);
}

/// A drop in the corners of four cells, `up` cells above the lower end, falls out of some of them: there is
/// nothing left to do for other processes.
void followDrop(const Vec<3>& gravity, int up, bool walls, const std::string& preconditioner) {
  const std::string key = "solver.preconditioner=" + preconditioner;
  Case c = Settings{"dam-break-2d.toml", 0, {"solver.tolerance=1e-16", key}}.read();
  const CellGrid<2> grid = makeMphPairs<2>(c).grid;
  if (!walls) c.bodies.resize(1);
  Shape& drop = c.bodies[0].shape;
  drop.kind = ShapeKind::Sphere;
  drop.radius = 2.2 * c.spacing;
  drop.center = {grid.origin[0] + 4 * grid.edge[0], grid.origin[1] + up * grid.edge[1], 0};
  c.gravity = gravity;
  Simulation<2> shared(c, partOf<2>(c), 0, 0, &job()), alone(c, made<2>(c));
  bool someHadNone = false;
  for (int k = 0; k < 25; ++k) {
    const StepReport a = shared.advance(), b = alone.advance();
    EXPECT_NEAR(a.iterations, b.iterations, 10);  // near the limit of rounding; measured: 8
    EXPECT_NEAR(a.diagnostics.top, b.diagnostics.top, 1e-10);
    EXPECT_NEAR(a.diagnostics.frontX, b.diagnostics.frontX, 1e-10);
    for (std::uint32_t own : job().all(shared.particles().fluidCount)) someHadNone = someHadNone || own == 0;
  }
  EXPECT_EQ(someHadNone, job().size() > (walls ? 2 : 1));
  Particles<2> whole, expected;
  shared.copyParticles(whole);
  alone.copyParticles(expected);
  expectOwnParticles(c, shared, whole);
  if (job().rank() > 0) return;
  ASSERT_EQ(whole.fluidCount, expected.fluidCount);
  const std::vector<std::uint32_t> here = placeOfId(whole), there = placeOfId(expected);
  for (std::uint32_t id = 0; id < whole.fluidCount; ++id)
    ASSERT_LT(norm(whole.position[here[id]] - expected.position[there[id]]), 1e-7 * c.spacing);
}

TEST(SharedSimulation, ProcessesWithoutFluid) {
  for (const char* preconditioner : {"projected-multigrid", "bucket-multigrid"})
    followDrop({-20, -20, 0}, 4, false, preconditioner);
}
TEST(SharedSimulation, ProcessesWithWallsAlone) { followDrop({0, -20, 0}, 3, true, "projected-multigrid"); }

TEST(SharedSimulation, AgreesOnAParticleThatLeaves) { expectAgreementOnAParticleThatLeaves(); }

TEST(SharedSimulation, RefusesWhatCannotBeShared) {
  if (job().size() == 1) return;
  const std::string buckets = "solver.preconditioner=bucket-multigrid";
  for (const char* key : {"solver.multigrid.particle_diagonal=extended-jacobi", "solver.operator=assembled"}) {
    const Case c = Settings{"dam-break-2d.toml", 0, {buckets, key}}.read();
    EXPECT_THROW(Simulation<2>(c, partOf<2>(c), 0, 0, &job()), InputError) << key;
  }
}

}  // namespace
}  // namespace treacle::test
