#include "memory.hpp"

#include "support/gpu.hpp"
#include "support/memory_cases.hpp"

#include <gtest/gtest.h>

namespace treacle::test {
namespace {

TEST(DeviceMemoryTwin, EstimateIsWhatASimulationTakes) {
  TREACLE_SKIP_WITHOUT_GPU();
  for (const MemoryCase& memoryCase : memoryCases()) {
    SCOPED_TRACE(memoryCase.name());
    const Case c = memoryCase.read();
    const AnySimulation simulation = advanced(c, BackendKind::Cuda);
    // Buffers of fixed size, which make most of what small runs take, are counted by the numbers of none.
    const auto ofParticles = [&](double bytes) {
      return bytes - static_cast<double>(estimatedDeviceMemory(c, {}));
    };
    const double estimate = static_cast<double>(estimatedDeviceMemory(c, simulation.numbers()));
    const double held = static_cast<double>(simulation.bytes()),
                 peak = static_cast<double>(simulation.peakBytes());
    EXPECT_GE(estimate, 0.9 * held);
    EXPECT_GE(estimate, 0.9 * peak);
    EXPECT_LE(ofParticles(estimate), 1.5 * held);
  }
}

}  // namespace
}  // namespace treacle::test
