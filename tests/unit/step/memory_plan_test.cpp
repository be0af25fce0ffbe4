#include "treacle/step/run/memory_plan.hpp"

#include "support/memory_cases.hpp"
#include "treacle/core/buffer.hpp"

#include <gtest/gtest.h>

namespace treacle::test {
namespace {

/// Modes, which estimates have room for, are taken in some runs and not before the third step.
const MemoryCase flat{"dam-break-2d.toml", {"resolution=4", "solver.deflation=0"}},
    flatPublished{"published/dam-break-2d.toml", {"resolution=4", "solver.deflation=0"}},
    solid{"dam-break-3d.toml", {}}, solidPublished{"published/dam-break-3d.toml", {}};

MemoryCase with(MemoryCase memoryCase, std::initializer_list<const char*> settings) {
  memoryCase.settings.insert(memoryCase.settings.end(), settings.begin(), settings.end());
  return memoryCase;
}

/// What is estimated for the particles as they are made, over the peak of the account of all host buffers in two
/// steps.
double estimatedOverMeasured(const MemoryCase& memoryCase) {
  MemoryScene scene(memoryCase);
  const auto estimate = static_cast<double>(simulationBytes(scene.c, scene.counts, BackendKind::Cpu));
  const std::size_t before = HostAccount::live() - stateBytes(scene.c, scene.particles.numbers());
  AnySimulation simulation(scene.c, std::move(scene.particles));
  HostAccount::startPeak();
  for (int k = 0; k < 2; ++k) simulation.advance();
  return estimate / static_cast<double>(HostAccount::peak() - before);
}

void expectEstimated(std::initializer_list<MemoryCase> cases) {
  for (const MemoryCase& memoryCase : cases)
    EXPECT_NEAR(estimatedOverMeasured(memoryCase), 1, memoryShare) << memoryCase.name();
}

TEST(MemoryPlan, IsWhatSimulationsHaveOnTheCpu) {
  expectEstimated({flat,
                   flatPublished,
                   solid,
                   solidPublished,
                   {"isph-dam-break-2d.toml", {"resolution=2"}},
                   {"isph-dam-break.toml", {"width.factor=0.5"}}});
}

TEST(MemoryPlan, KnowsPrecisionAndPreconditioners) {
  for (const MemoryCase& base : {flat, flatPublished})
    expectEstimated(
        {with(base, {"solver.precision=double"}), with(base, {"solver.preconditioner=bucket-multigrid"}),
         with(base, {"solver.preconditioner=block-jacobi"}), with(base, {"solver.operator=assembled"}),
         with(base, {"solver.preconditioner=bucket-multigrid", "solver.operator=assembled"}),
         with(base,
              {"solver.preconditioner=bucket-multigrid", "solver.multigrid.particle_diagonal=extended-jacobi"})});
  expectEstimated({with(solid, {"solver.precision=double"}),
                   with(solidPublished, {"solver.preconditioner=bucket-multigrid"})});
  expectEstimated(
      {{"isph-dam-break-2d.toml", {"resolution=2", "solver.preconditioner=cell-multigrid"}},
       {"isph-dam-break-2d.toml", {"resolution=2", "method.viscosity=implicit", "water.dynamic_viscosity=1"}}});
}

TEST(MemoryPlan, KnowsWhatCasesHaveBesideFlow) {
  expectEstimated({{"glass-gob-2d.toml", {"resolution=2", "solver.deflation=0"}},
                   {"honey-and-syrup-2d.toml", {"resolution=2", "solver.deflation=0"}},
                   {"merging-drops-2d.toml", {"solver.deflation=0"}},
                   {"floating-block-2d.toml", {"resolution=2", "solver.deflation=0"}},
                   {"isph-floating-block-2d.toml", {}}});
}

TEST(MemoryPlan, OfADeviceGrowsWithWhatTheSolverStores) {
  const MemoryScene scene(flat);
  const auto bytes = [&](std::initializer_list<const char*> settings) {
    return simulationBytes(with(flat, settings).read(), scene.counts, BackendKind::Cuda);
  };
  const char* buckets = "solver.preconditioner=bucket-multigrid";
  EXPECT_LT(bytes({buckets, "solver.neighbours=ranges"}), bytes({buckets}));
  EXPECT_LT(bytes({buckets}), bytes({}));
  EXPECT_LT(bytes({}), bytes({"output.balance=false", "solver.deflation=8"}));
  EXPECT_LT(bytes({buckets}), bytes({buckets, "solver.operator=assembled"}));
  EXPECT_LT(bytes({buckets, "solver.operator=assembled"}),
            bytes({buckets, "solver.multigrid.coarse_operators=spgemm"}));
}

/// 64 million particles with their walls: numbers that 32 bits do not hold.
TEST(MemoryPlan, OfADeviceGrowsInProportion) {
  const MemoryScene scene(solid);
  constexpr std::uint64_t factor = 8000;
  MemoryCounts many = scene.counts;
  for (std::uint64_t* n : {&many.particles.fluid, &many.particles.wall, &many.particles.surfaces, &many.nearWalls,
                           &many.activeWalls, &many.cells, &many.nodes})
    *n *= factor;
  const double small = static_cast<double>(simulationBytes(scene.c, scene.counts, BackendKind::Cuda)),
               large = static_cast<double>(simulationBytes(scene.c, many, BackendKind::Cuda));
  EXPECT_GT(large, 0.7 * factor * small);  // without the constant part
  EXPECT_LT(large, factor * small);
}

TEST(MemoryPlan, DistantWallsAreTheHosts) {
  const MemoryScene scene(solid);
  MemoryCounts more = scene.counts;
  more.particles.wall += 1000;
  EXPECT_EQ(simulationBytes(scene.c, more, BackendKind::Cuda),
            simulationBytes(scene.c, scene.counts, BackendKind::Cuda));
  EXPECT_EQ(distantWallBytes(scene.c, more), distantWallBytes(scene.c, scene.counts) + 54'000);
}

TEST(MemoryPlan, SharesAreEqualPartsWithGhosts) {
  const MemoryScene scene(solid);
  const MemoryCounts& all = scene.counts;
  EXPECT_EQ(all.particles.fluid, 8000u);
  EXPECT_EQ(all.filledCells, 64u);
  EXPECT_EQ(all.share(scene.c, 1).particles, all.particles);
  for (const std::uint64_t processes : {2u, 4u, 64u}) {
    const MemoryCounts one = all.share(scene.c, processes);
    EXPECT_EQ(one.particles.fluid, 8000 / processes);
    EXPECT_GT(one.particles.ghosts, 0u);
    EXPECT_LE(one.particles.fluid + one.particles.ghosts, 8000u);
    EXPECT_EQ(one.nearWalls, all.nearWalls);
    EXPECT_LT(simulationBytes(scene.c, one, BackendKind::Cpu), simulationBytes(scene.c, all, BackendKind::Cpu));
  }
  EXPECT_EQ(all.share(scene.c, 3).particles.fluid, 22 * 125u) << "of 64 cells one process has 22";
}

}  // namespace
}  // namespace treacle::test
