#include "memory.hpp"

#include "machine.hpp"

#include "command.hpp"
#include "support/memory_cases.hpp"
#include "treacle/core/error.hpp"
#include "treacle/model/case_keys.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace treacle {
namespace {

using testing::HasSubstr;

Case caseOf(int dimensions) {
  Case c;
  c.dimensions = dimensions;
  c.solver.preconditioner = PreconditionerKind::BucketMultigrid;
  return c;
}

/// As if a thousand fluid particles were there.
MemoryCounts countsOf(int dimensions, std::uint64_t thousands = 1) {
  const std::uint64_t n = thousands, near = dimensions == 2 ? 20 : 80;
  MemoryCounts counts;
  counts.particles = {1000 * n, 500 * n, 0, 500 * n};
  counts.nearWalls = 400 * n, counts.active = 1200 * n, counts.cells = 100 * n;
  counts.fluidLists = {125 * n, {10000 * n, 20000 * n, 1000 * n, 2000 * n}};
  counts.wallLists = counts.wallForceLists = {25 * n, {1000 * n, 0, 1000 * n, 0}};
  counts.nearEntries = counts.gradientEntries = 1000 * near * n;
  counts.rowEntries = 5000 * near * n;
  counts.pressureGrids = {{20000 * n, 30000 * n, 200000 * n}, {100, 200, 1000}};
  counts.fluidGrids = {{20000 * n, 30000 * n, 100000 * n}, {50, 200, 500}};
  counts.buckets = {10 * n, 1};
  counts.bucketEntries = 60 * n;
  counts.fluidOfFluid = 1000 * near * n;
  return counts;
}

std::uint64_t deviceMemory(const Case& c, std::uint64_t thousands = 1) {
  return estimatedDeviceMemory(c, countsOf(c.dimensions, thousands));
}
std::uint64_t hostMemory(const Case& c, bool onDevice) {
  return estimatedMemory(c, countsOf(c.dimensions, 1000), onDevice);
}

TEST(DeviceMemory, GrowsWithWhatTheSolverStores) {
  for (const int dimensions : {2, 3}) {
    Case ranges = caseOf(dimensions), lists = ranges, diagonal = ranges, assembled = ranges, products = ranges;
    ranges.solver.neighbours = NeighbourKind::Ranges;
    diagonal.solver.multigrid.particleDiagonal = SmootherDiagonal::ExtendedJacobi;
    assembled.solver.operatorKind = OperatorKind::Assembled;
    products.solver.multigrid.coarseOperators = CoarseKind::Spgemm;
    EXPECT_LT(deviceMemory(ranges), deviceMemory(lists));
    EXPECT_LT(deviceMemory(lists), deviceMemory(assembled));
    EXPECT_LT(deviceMemory(assembled), deviceMemory(diagonal));
    EXPECT_LT(deviceMemory(diagonal), deviceMemory(products));
  }
}

TEST(DeviceMemory, SettingsOfAMultigridThatIsNotUsedDoNotCount) {
  Case c = caseOf(3);
  c.solver.preconditioner = PreconditionerKind::BlockJacobi;
  const std::uint64_t plain = deviceMemory(c);
  c.solver.multigrid.coarseOperators = CoarseKind::Spgemm;
  c.solver.multigrid.particleDiagonal = SmootherDiagonal::ExtendedJacobi;
  EXPECT_EQ(deviceMemory(c), plain);
}

TEST(DeviceMemory, GrowsInProportionToTheNumbersAndLessForWalls) {
  const Case c = caseOf(3);
  MemoryCounts counts = countsOf(3);
  const std::uint64_t before = estimatedDeviceMemory(c, counts), onHost = estimatedMemory(c, counts, true);
  counts.particles.wall += 1000;
  EXPECT_EQ(estimatedDeviceMemory(c, counts), before) << "distant walls are the host's";
  EXPECT_GT(estimatedMemory(c, counts, true), onHost);
  counts.nearWalls += 1000;
  const std::uint64_t walls = estimatedDeviceMemory(c, counts) - before;
  counts.particles.wall -= 1000, counts.nearWalls -= 1000, counts.particles.fluid += 1000;
  const std::uint64_t fluid = estimatedDeviceMemory(c, counts) - before;
  EXPECT_GT(walls, 0u);
  EXPECT_LT(walls, fluid);
  EXPECT_GT(deviceMemory(c, 64'000), std::uint64_t{1} << 32);
}

TEST(Memory, OfTheBalanceCountsWhereItIsMade) {
  for (const int dimensions : {2, 3}) {
    Case c = caseOf(dimensions), with = c;
    with.output.balance = true;
    EXPECT_GT(deviceMemory(with), deviceMemory(c));
    EXPECT_GT(hostMemory(with, false), hostMemory(c, false));
    EXPECT_EQ(hostMemory(with, true), hostMemory(c, true));
  }
}

TEST(HostMemory, HoldsNoSolverWhereTheRunIsOnADevice) {
  Case c = caseOf(3);
  const std::uint64_t onDevice = hostMemory(c, true), matrixFree = hostMemory(c, false);
  EXPECT_LT(onDevice, matrixFree);
  // What lies on a device only makes no difference to the CPU.
  c.solver.neighbours = NeighbourKind::Ranges;
  EXPECT_EQ(hostMemory(c, false), matrixFree);
  c.solver.operatorKind = OperatorKind::Assembled;
  EXPECT_GT(hostMemory(c, false), matrixFree);
  EXPECT_EQ(hostMemory(c, true), onDevice);
}

TEST(HostMemory, ProjectedMultigridTakesMoreAndMostBesideAMatrix) {
  for (const int dimensions : {2, 3}) {
    Case bucket = caseOf(dimensions), projected = bucket;
    projected.solver.preconditioner = PreconditionerKind::ProjectedMultigrid;
    const auto more = [&] { return hostMemory(projected, false) - hostMemory(bucket, false); };
    const std::uint64_t besideLists = more();
    EXPECT_GT(besideLists, 0u);
    bucket.solver.operatorKind = projected.solver.operatorKind = OperatorKind::Assembled;
    EXPECT_GT(more(), besideLists);
    projected.solver.deflation = 0;
    EXPECT_EQ(hostMemory(projected, true), hostMemory(bucket, true));
  }
}

TEST(HostMemory, HoldsModesWhereTheSolverHasSome) {
  Case none = caseOf(2);
  none.solver.preconditioner = PreconditionerKind::ProjectedMultigrid;
  none.solver.deflation = 0;
  Case few = none, many = none;
  few.solver.deflation = 8, many.solver.deflation = 16;
  for (const bool onDevice : {false, true}) {
    EXPECT_GT(hostMemory(few, onDevice), hostMemory(none, onDevice));
    EXPECT_GT(hostMemory(many, onDevice), hostMemory(few, onDevice));
  }
  EXPECT_GT(deviceMemory(few), deviceMemory(none));
  many.solver.krylov = none.solver.krylov = KrylovKind::Cr;
  EXPECT_EQ(deviceMemory(many), deviceMemory(none));
}

TEST(DeviceMemory, ARunThatDoesNotFitIsRefused) {
  const Case c = test::MemoryCase{"dam-break-2d.toml", {}}.read();
  std::vector<std::string> notes;
  AnyParticles particles = createParticles(c, notes);
  DeviceInfo device;
  device.name = "Some GPU";
  device.memory = std::size_t{1} << 40;
  device.freeMemory = estimatedDeviceMemory(c, countsFor(c, particles, true));
  EXPECT_NO_THROW(requireMemory(c, particles, &device));
  --device.freeMemory;
  EXPECT_NO_THROW(requireMemory(c, particles, nullptr));
  const auto refusal = [&] {
    try {
      requireMemory(c, particles, &device);
    } catch (const RunError& error) {
      return std::string(error.what());
    }
    return std::string("a run that does not fit was let through");
  };
  EXPECT_THAT(refusal(), HasSubstr("1300 particles need about "));
  EXPECT_THAT(refusal(), HasSubstr(" of device memory, "));
  EXPECT_THAT(refusal(), HasSubstr(" available on Some GPU"));
  device.freeMemory = 0;
  EXPECT_THAT(refusal(), HasSubstr("Some GPU gives no device memory"));
}

TEST(DeviceMemory, OfSeveralProcessesIsThatOfAPart) {
  const Case c = test::MemoryCase{"dam-break-2d.toml", {}}.read();
  std::vector<std::string> notes;
  const AnyParticles particles = createParticles(c, notes);
  const ParticleNumbers all = particles.numbers();
  const MemoryCounts whole = countsFor(c, particles, true);
  const MemoryCounts part = countForProcesses(c, particles, false, 4).front();
  EXPECT_LT(part.particles.fluid, all.fluid / 2);
  EXPECT_GT(part.heldFluid(), part.particles.fluid);
  EXPECT_LT(estimatedDeviceMemory(c, part), estimatedDeviceMemory(c, whole));
  DeviceInfo device;
  device.name = "Some GPU";
  device.freeMemory = estimatedDeviceMemory(c, part);
  EXPECT_NO_THROW(requireMemory(c, part, &device, {4, all, 1}));
  device.freeMemory -= 1;
  try {
    requireMemory(c, part, &device, {4, all, 1});
    FAIL() << "a run that does not fit was let through";
  } catch (const RunError& error) {
    EXPECT_THAT(error.what(), HasSubstr("1300 particles, shared by 4 processes, need about "));
  }
}

/// A host has memory for its processes, those with the most, and for what the first one gathers.
TEST(HostMemory, OfSeveralProcessesIsTheirSum) {
  constexpr double mebibyte = 1 << 20;
  EXPECT_EQ(memoryOfHost({5, 9, 2, 7}, 4, 100), 123u);
  EXPECT_EQ(memoryOfHost({5, 9, 2, 7}, 2, 100), 116u);
  const Case c = caseOf(2);
  MemoryCounts part = countsOf(2, 1000);
  ParticleNumbers all = part.particles;
  all.fluid *= 4, all.wall *= 4, all.surfaces *= 4;
  EXPECT_NEAR(static_cast<double>(gatheredMemory(c, all)), 4.0 * gatheredMemory(c, part.particles), 50 * mebibyte);
  for (const bool onDevice : {false, true}) {
    const std::uint64_t alone = processMemory(c, part, onDevice, part.particles);
    part.sharing.processes = 4, part.particles.ghosts = 100'000, part.active += 100'000;
    const std::uint64_t shared = processMemory(c, part, onDevice, part.particles);
    EXPECT_GT(shared, alone);
    ParticleNumbers many = all;
    many.fluid *= 1000;  // the places of so many do not fit into what the steps take
    EXPECT_GT(processMemory(c, part, onDevice, many), shared + many.fluid);
    part.sharing = {}, part.particles.ghosts = 0, part.active -= 100'000;
  }
}

TEST(HostMemory, WhatDoesNotFitIsRefusedForAllProcesses) {
  const Case c = test::MemoryCase{"dam-break-2d.toml", {}}.read();
  std::vector<std::string> notes;
  const AnyParticles particles = createParticles(c, notes);
  const MemoryCounts part = countForProcesses(c, particles, false, 2).front();
  EXPECT_NO_THROW(requireMemory(c, part, nullptr, {2, particles.numbers(), 1}));
  try {
    requireMemory(c, part, nullptr, {2, particles.numbers(), std::uint64_t{1} << 60});
    FAIL() << "a run that does not fit was let through";
  } catch (const RunError& error) {
    EXPECT_THAT(error.what(), HasSubstr("1300 particles, shared by 2 processes, need about 1.07e+09 GiB"));
  }
}

TEST(DeviceMemory, WhatIsToldWhereItGivesOut) {
  const std::size_t mebibyte = std::size_t{1} << 20;
  EXPECT_THAT(
      exhaustedText({64 * mebibyte, 3 * mebibyte, 2048 * mebibyte, 500 * mebibyte}),
      HasSubstr("device memory exhausted: 64 MiB more needed, 3 MiB of 2 GiB free, the run itself had up to "
                "500 MiB; take a lower resolution"));
  EXPECT_THAT(exhaustedText({0, 3 * mebibyte, 2048 * mebibyte, 0}),
              HasSubstr("device memory exhausted: 3 MiB of 2 GiB free; take a lower resolution"));
}

/// The peak of a process that runs a case, by its own summary, against what `check` says; a thousand particles
/// would drown in what the program itself takes.
TEST(HostMemory, IsWhatARunTakes) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the address sanitizer takes memory of its own";
#endif
  for (const char* file : {"dam-break-3d.toml", "published/dam-break-3d.toml"}) {
    SCOPED_TRACE(file);
    const test::MemoryCase memoryCase{file, {}};
    const Case c = memoryCase.read();
    std::vector<std::string> notes;
    AnyParticles particles = createParticles(c, notes);
    const double estimate = static_cast<double>(estimatedMemory(c, countsFor(c, particles, false), false));
    const test::Workshop workshop;
    const test::Outcome outcome = workshop.call(
        fmt::format("run {}/{} -o run --backend cpu --quiet --end-time {}", TREACLE_CASES, file, 2 * c.time.step));
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    const double measured = nlohmann::json::parse(workshop.content("run/summary.json")).at("peak_memory_bytes");
    EXPECT_NEAR(estimate, measured, 0.1 * measured);
  }
}

TEST(HostMemory, OfParticlesIsLookedAtBeforeTheyAreMade) {
  Case c = test::MemoryCase{"dam-break-3d.toml", {}}.read();
  EXPECT_EQ(boxPoints(c), 44'000);
  EXPECT_NO_THROW(requireRoomForParticles(c));
  c.bodies[1].shape.max[2] = 10'000;  // [m]: 4e9 particles
  EXPECT_LT(boxPoints(c), maxParticles);
  if (availableMemory() > 100'000'000'000) GTEST_SKIP() << "this machine has room for 4e9 particles";
  try {
    requireRoomForParticles(c);
    FAIL() << "a case that does not fit was let through";
  } catch (const RunError& error) {
    EXPECT_THAT(error.what(), HasSubstr(" particles need about "));
  }
}

/// Cells of a domain that no machine holds are refused before anything is counted in them.
TEST(HostMemory, OfCellsCountsWhereTheDomainIsLarge) {
  Case c = test::MemoryCase{"dam-break-3d.toml", {"resolution=0.5"}}.read();
  std::vector<std::string> notes;
  AnyParticles particles = createParticles(c, notes);
  EXPECT_NO_THROW(requireMemory(c, particles, nullptr));
  c.domain.periodic = {false, false, false};
  c.domain.max = {60, 60, 60};
  try {
    requireMemory(c, particles, nullptr);
    FAIL() << "a run that does not fit was let through";
  } catch (const RunError& error) {
    EXPECT_THAT(error.what(), HasSubstr("search cells of the domain need about "));
  }
}

}  // namespace
}  // namespace treacle
