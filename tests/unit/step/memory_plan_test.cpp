#include "treacle/step/memory_plan.hpp"

#include "support/memory_cases.hpp"
#include "treacle/core/buffer.hpp"

#include <gtest/gtest.h>

namespace treacle::test {
namespace {

/// By how much more than `measured` was planned.
double excess(std::uint64_t planned, std::size_t measured) {
  return static_cast<double>(planned) / static_cast<double>(measured) - 1;
}

/// What is planned for the particles as they are made, against the account of all host buffers over some steps.
struct Planned {
  MemoryPlan plan;
  std::size_t before;
  AnySimulation simulation;

  static Planned of(const Case& c) {
    std::vector<std::string> notes;
    AnyParticles particles = createParticles(c, notes);
    const MemoryCounts counts = countForMemory(c, particles, storesMatrix(c, BackendKind::Cpu));
    const std::size_t before = HostAccount::live() - stateBytes(c, particles.numbers());
    return {planMemory(c, counts, BackendKind::Cpu), before, AnySimulation(c, std::move(particles))};
  }
  std::size_t live() const { return HostAccount::live() - before; }
  std::size_t peak() const { return HostAccount::peak() - before; }
};

/// Over two steps, but for that share.
void expectPlanned(const MemoryCase& memoryCase, double share) {
  SCOPED_TRACE(memoryCase.name());
  Planned p = Planned::of(memoryCase.read());
  HostAccount::startPeak();
  for (int k = 0; k < 2; ++k) p.simulation.advance();
  EXPECT_EQ(p.live(), p.simulation.bytes());
  EXPECT_NEAR(excess(p.plan.held, p.live()), 0, share);
  EXPECT_NEAR(excess(p.plan.peak, p.peak()), 0, share);
}

TEST(MemoryPlan, IsWhatSimulationsHaveOnTheCpu) {
  for (const MemoryCase& memoryCase : memoryCases()) expectPlanned(memoryCase, 0.05);
}

/// What their walls bear, by itself and with surface tension.
TEST(MemoryPlan, KnowsWhatRigidBodiesTake) {
  const MemoryCase plain{"floating-block-2d.toml", {"solver.deflation=0"}};
  MemoryCase tense = plain;
  tense.settings.push_back("honey.surface_tension=0.07");
  for (const MemoryCase& memoryCase : {plain, tense}) expectPlanned(memoryCase, 0.01);
}

/// Large enough for arrays that are given up once their part of the step is done.
TEST(MemoryPlan, KnowsWhatIsGivenUp) {
  const MemoryCase large{
      "dam-break-3d.toml",
      {"resolution=2", "solver.deflation=0", "solver.precision=double", "solver.tolerance=0.01"}};
  Planned p = Planned::of(large.read());
  HostAccount::startPeak();
  p.simulation.advance();
  EXPECT_GT(p.plan.peak, p.plan.held + keptBytes);
  EXPECT_NEAR(excess(p.plan.held, p.live()), 0, 0.05);
  EXPECT_NEAR(excess(p.plan.peak, p.peak()), 0, 0.05);
}

/// 64 million particles with their walls: numbers that 32 bits do not hold.
TEST(MemoryPlan, OfADeviceGrowsInProportion) {
  const Case c = MemoryCase{"dam-break-3d.toml", {"resolution=0.5"}}.read();
  std::vector<std::string> notes;
  AnyParticles particles = createParticles(c, notes);
  const MemoryCounts some = countForMemory(c, particles, false);
  constexpr std::uint64_t factor = 64000;
  MemoryCounts many = some;
  many.particles.fluid *= factor, many.particles.wall *= factor, many.particles.surfaces *= factor;
  many.nearWalls *= factor, many.active *= factor, many.cells *= factor;
  many.nearEntries *= factor, many.stagedEntries *= factor;
  for (MemoryCounts::Lists* lists : {&many.fluidLists, &many.wallLists}) {
    lists->clusters *= factor;
    for (std::uint64_t& entries : lists->entries) entries *= factor;
  }
  const MemoryPlan small = planMemory(c, some, BackendKind::Cuda), large = planMemory(c, many, BackendKind::Cuda);
  ASSERT_EQ(many.particles.fluid, 64'000'000u);
  // Without the background grids, which stay as they are here.
  EXPECT_GT(large.held, 0.3 * factor * static_cast<double>(small.held));
  EXPECT_LT(large.held, factor * small.held);
  EXPECT_GT(large.peak, large.held);
}

}  // namespace
}  // namespace treacle::test
