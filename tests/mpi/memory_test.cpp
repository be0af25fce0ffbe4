#include "mpi/compare_simulations.hpp"
#include "support/memory_cases.hpp"
#include "treacle/step/memory_plan.hpp"
#include "treacle/step/shareable.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace treacle::test {
namespace {

bool isShareable(const Case& c) {
  try {
    requireShareable(c, BackendKind::Cpu);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

std::vector<MemoryCase> sharedCases() {
  std::vector<MemoryCase> all;
  for (const MemoryCase& memoryCase : memoryCases())
    if (isShareable(memoryCase.read())) all.push_back(memoryCase);
  all.push_back({"dam-break-3d.toml", {"resolution=0.8", "solver.deflation=0", "solver.divided_nodes=0"}});
  all.push_back({"isph-dam-break.toml", {"width.factor=0.5", "solver.divided_nodes=0"}});
  return all;
}

AnyParticles ownPart(const Case& c) {
  std::vector<std::string> notes;
  return createParticles(c, notes, nullptr,
                         {static_cast<std::uint32_t>(job().rank()), static_cast<std::uint32_t>(job().size())});
}

/// What is planned for a process against the account of its buffers over some steps.
TEST(SharedMemory, IsWhatEachProcessHas) {
  for (const MemoryCase& memoryCase : sharedCases()) {
    SCOPED_TRACE(memoryCase.name());
    const Case c = memoryCase.read();
    AnyParticles part = ownPart(c);
    const MemoryCounts counts = countForMemory(c, part, false, job());
    const MemoryPlan plan = planMemory(c, counts, BackendKind::Cpu);
    const std::size_t before = HostAccount::live() - stateBytes(c, part.numbers());
    part.visit([&]<int D>(Particles<D>& p) {
      Simulation<D> simulation(c, std::move(p), 0, 0, &job());
      HostAccount::startPeak();
      for (int k = 0; k < 2; ++k) simulation.advance();
      const auto live = static_cast<double>(HostAccount::live() - before),
                 peak = static_cast<double>(HostAccount::peak() - before);
      EXPECT_NEAR(static_cast<double>(plan.held) / live, 1, 0.1) << "rank " << job().rank();
      EXPECT_NEAR(static_cast<double>(plan.peak) / peak, 1, 0.1) << "rank " << job().rank();
    });
  }
}

/// What is counted of a process, and the peak of its plan.
struct Counted {
  std::uint64_t fluid, ghosts, active, ghostWalls, sentFluid, sentWalls, buckets, nodes, entries, peak;

  static Counted of(const Case& c, const MemoryCounts& n) {
    Counted counted{n.particles.fluid,
                    n.particles.ghosts,
                    n.active,
                    n.sharing.ghostWalls,
                    n.sharing.sentFluid,
                    n.sharing.sentWalls,
                    n.sharing.buckets,
                    0,
                    n.bucketEntries,
                    planMemory(c, n, BackendKind::Cpu).peak};
    for (const auto* grids : {&n.pressureGrids, &n.fluidGrids})
      for (const MemoryCounts::Grid& grid : *grids) counted.nodes += grid.nodes, counted.entries += grid.entries;
    return counted;
  }
  /// Lists are counted in windows, which begin elsewhere where ghosts are in another order.
  bool isButForLists(const Counted& other) const {
    Counted same = other;
    same.peak = peak;
    return std::memcmp(&same, this, sizeof same) == 0;
  }
};

/// What a process that is alone knows of several ones is what these find together.
TEST(SharedMemory, IsKnownToAProcessThatIsAlone) {
  for (const MemoryCase& memoryCase : sharedCases()) {
    SCOPED_TRACE(memoryCase.name());
    const Case c = memoryCase.read();
    const std::vector<Counted> found = job().all(Counted::of(c, countForMemory(c, ownPart(c), false, job())));
    std::vector<std::string> notes;
    const AnyParticles particles = createParticles(c, notes);
    const std::vector<MemoryCounts> told = countForProcesses(c, particles, false, job().size());
    ASSERT_EQ(told.size(), found.size());
    for (const MemoryCounts& counts : told) {
      const Counted n = Counted::of(c, counts);
      const auto same = std::ranges::find_if(found, [&](const Counted& f) { return n.isButForLists(f); });
      ASSERT_NE(same, found.end()) << n.fluid << " fluid particles, " << n.ghosts << " ghosts";
      EXPECT_NEAR(static_cast<double>(n.peak) / static_cast<double>(same->peak), 1, 0.02);
    }
    EXPECT_EQ(countForProcesses(c, particles, false, job().size(), 1).size(), 1u);
  }
}

TEST(SharedMemory, OfMoreProcessesThanCellsIsRefused) {
  const Case c = MemoryCase{"dam-break-2d.toml", {}}.read();
  std::vector<std::string> notes;
  const AnyParticles particles = createParticles(c, notes);
  EXPECT_THROW(countForProcesses(c, particles, false, 1000), InputError);
  EXPECT_NO_THROW(countForProcesses(c, particles, false, 4));
}

}  // namespace
}  // namespace treacle::test
