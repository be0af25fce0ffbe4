#include "support/gpu.hpp"
#include "support/memory_cases.hpp"

#include <gtest/gtest.h>

namespace treacle::test {
namespace {

/// What is estimated for the particles as they are made, over what the device's pool had in use at a time. Of
/// fewer particles the coarsest levels, which are inverted, would be most of it.
TEST(DeviceMemoryTwin, ThePlanIsWhatASimulationTakes) {
  TREACLE_SKIP_WITHOUT_GPU();
  const char* buckets = "solver.preconditioner=bucket-multigrid";
  for (const MemoryCase& memoryCase :
       {MemoryCase{"dam-break-2d.toml", {"resolution=32", "solver.deflation=0"}},
        MemoryCase{"published/dam-break-2d.toml", {"resolution=32", "solver.deflation=0"}},
        MemoryCase{"dam-break-3d.toml", {"resolution=2"}}, MemoryCase{"dam-break-3d.toml", {"resolution=4"}},
        MemoryCase{"published/dam-break-3d.toml", {"resolution=3"}},
        MemoryCase{"dam-break-3d.toml", {"resolution=3", "solver.precision=double"}},
        MemoryCase{"dam-break-3d.toml", {"resolution=3", buckets}},
        MemoryCase{"dam-break-3d.toml", {"resolution=3", buckets, "solver.neighbours=ranges"}},
        MemoryCase{"isph-dam-break.toml", {"width.factor=4"}}}) {
    SCOPED_TRACE(memoryCase.name());
    MemoryScene scene(memoryCase);
    const auto estimate = static_cast<double>(simulationBytes(scene.c, scene.counts, BackendKind::Cuda));
    AnySimulation simulation(scene.c, std::move(scene.particles), BackendKind::Cuda);
    for (int k = 0; k < 2; ++k) simulation.advance();
    EXPECT_NEAR(estimate / static_cast<double>(simulation.peakBytes()), 1, memoryShare);
  }
}

/// Of so many particles arrays give their memory up within a step, and others take their place (giveUp).
TEST(DeviceMemoryTwin, StepsOfMillionsOfParticlesSolve) {
  TREACLE_SKIP_WITHOUT_GPU();
  for (const MemoryCase& large : {MemoryCase{"isph-dam-break.toml", {"width.factor=64"}},
                                  MemoryCase{"dam-break-3d.toml", {"resolution=5"}}}) {
    SCOPED_TRACE(large.name());
    const Case c = large.read();
    std::vector<std::string> notes;
    AnySimulation simulation(c, createParticles(c, notes), BackendKind::Cuda);
    ASSERT_GT(simulation.bytes(), 8 * keptBytes);
    for (int k = 0; k < 3; ++k) {
      const StepReport report = simulation.advance();
      EXPECT_EQ(report.fallbacks, 0);
      EXPECT_GT(report.iterations, 1);
      EXPECT_LT(report.iterations, 40);
    }
  }
}

}  // namespace
}  // namespace treacle::test
