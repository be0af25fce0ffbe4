#include "mpi/compare_simulations.hpp"
#include "support/memory_cases.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

namespace treacle::test {
namespace {

AnyParticles ownPart(const Case& c) {
  std::vector<std::string> notes;
  return createParticles(c, notes, nullptr,
                         {static_cast<std::uint32_t>(job().rank()), static_cast<std::uint32_t>(job().size())});
}

/// What is estimated for each process against the largest account of buffers that one of them has over some steps.
TEST(SharedMemory, IsWhatTheLargestProcessHas) {
  for (const MemoryCase& memoryCase :
       {MemoryCase{"dam-break-2d.toml", {"resolution=6", "solver.deflation=0"}},
        MemoryCase{"dam-break-3d.toml", {}}, MemoryCase{"published/dam-break-3d.toml", {}},
        MemoryCase{"isph-dam-break.toml", {}}}) {
    SCOPED_TRACE(memoryCase.name());
    const Case c = memoryCase.read();
    AnyParticles part = ownPart(c);
    const MemoryCounts share = countForMemory(c, part, &job()).share(c, static_cast<std::uint64_t>(job().size()));
    const std::size_t before = HostAccount::live() - stateBytes(c, part.numbers());
    part.visit([&]<int D>(Particles<D>& p) {
      Simulation<D> simulation(c, std::move(p), 0, 0, &job());
      HostAccount::startPeak();
      for (int k = 0; k < 2; ++k) simulation.advance();
    });
    const std::vector<std::uint64_t> peaks = job().all(std::uint64_t{HostAccount::peak() - before});
    EXPECT_NEAR(static_cast<double>(simulationBytes(c, share, BackendKind::Cpu)) /
                    static_cast<double>(*std::ranges::max_element(peaks)),
                1, memoryShare);
  }
}

/// What processes count that have a part each is what one counts that has all.
TEST(SharedMemory, IsKnownToAProcessThatIsAlone) {
  for (const MemoryCase& memoryCase :
       {MemoryCase{"dam-break-2d.toml", {}}, MemoryCase{"isph-dam-break.toml", {"width.factor=0.5"}}}) {
    const MemoryScene alone(memoryCase);
    const MemoryCounts all = countForMemory(alone.c, ownPart(alone.c), &job());
    EXPECT_EQ(all.particles, alone.counts.particles);
    EXPECT_EQ(all.nearWalls, alone.counts.nearWalls);
    EXPECT_EQ(all.activeWalls, alone.counts.activeWalls);
    EXPECT_EQ(all.filledCells, alone.counts.filledCells);
    EXPECT_EQ(all.nodes, alone.counts.nodes);
  }
}

}  // namespace
}  // namespace treacle::test
