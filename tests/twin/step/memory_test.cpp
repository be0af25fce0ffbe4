#include "support/gpu.hpp"
#include "support/memory_cases.hpp"
#include "treacle/step/memory_plan.hpp"

#include <gtest/gtest.h>

namespace treacle::test {
namespace {

/// What is planned for the particles as they are made, against what the device's pool had in use at a time.
TEST(DeviceMemoryTwin, ThePlanIsWhatASimulationTakes) {
  TREACLE_SKIP_WITHOUT_GPU();
  for (const MemoryCase& memoryCase : memoryCases()) {
    SCOPED_TRACE(memoryCase.name());
    const Case c = memoryCase.read();
    std::vector<std::string> notes;
    AnyParticles particles = createParticles(c, notes);
    const MemoryCounts counts = countForMemory(c, particles, storesMatrix(c, BackendKind::Cuda));
    const MemoryPlan plan = planMemory(c, counts, BackendKind::Cuda);
    AnySimulation simulation(c, std::move(particles), BackendKind::Cuda);
    for (int k = 0; k < 2; ++k) simulation.advance();
    // The context's own room, and what allocations are rounded up by.
    constexpr double fixed = 5 << 17;
    const double held = static_cast<double>(simulation.bytes()),
                 peak = static_cast<double>(simulation.peakBytes());
    EXPECT_NEAR(static_cast<double>(plan.held), held, 0.05 * held + fixed);
    EXPECT_NEAR(static_cast<double>(plan.peak), peak, 0.05 * peak + fixed);
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
