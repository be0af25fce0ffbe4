#include "memory.hpp"

#include "machine.hpp"

#include "command.hpp"
#include "support/memory_cases.hpp"
#include "treacle/core/error.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <functional>
#include <string>
#include <vector>

namespace treacle {
namespace {

using testing::HasSubstr;

test::MemoryScene smallScene() { return test::MemoryScene({"dam-break-2d.toml", {}}); }

std::string refusal(const std::function<void()>& f) { return test::messageOf<RunError>(f); }

TEST(HostMemory, HoldsNoSolverWhereTheRunIsOnADevice) {
  const test::MemoryScene scene({"dam-break-3d.toml", {}});
  const MemoryEstimate onCpu = estimatedMemory(scene.c, scene.counts, false),
                       onDevice = estimatedMemory(scene.c, scene.counts, true);
  EXPECT_EQ(onCpu.device, 0u);
  EXPECT_EQ(onCpu.first, onDevice.first);
  EXPECT_EQ(onDevice.device, simulationBytes(scene.c, scene.counts, BackendKind::Cuda));
  // The solver's settings make no difference to the host then.
  Case assembled = scene.c;
  assembled.solver.operatorKind = OperatorKind::Assembled;
  EXPECT_EQ(estimatedMemory(assembled, scene.counts, true).host, onDevice.host);
  EXPECT_GT(estimatedMemory(assembled, scene.counts, false).host, onCpu.host);
}

TEST(HostMemory, ALargeDomainIsToldOf) {
  const test::MemoryScene scene = smallScene();
  MemoryCounts counts = scene.counts;
  std::vector<std::string> warnings;
  warnLargeDomain(scene.c, counts, warnings);
  counts.cells = 20'000'000;
  warnLargeDomain(scene.c, counts, warnings);
  EXPECT_TRUE(warnings.empty());
  counts.cells = 200'000'000;
  warnLargeDomain(scene.c, counts, warnings);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_THAT(warnings[0], HasSubstr("the domain takes 4.84 GiB for its 200000000 search cells"));
}

TEST(DeviceMemory, ARunThatDoesNotFitIsRefused) {
  const test::MemoryScene scene = smallScene();
  DeviceInfo device;
  device.name = "Some GPU";
  device.memory = std::size_t{1} << 40;
  const std::uint64_t estimate = estimatedMemory(scene.c, scene.counts, true).device;
  device.freeMemory = estimate * 9 / 10;  // it may be too large by so much
  EXPECT_NO_THROW(requireMemory(scene.c, scene.particles, &device));
  device.freeMemory = estimate * 8 / 10;
  EXPECT_NO_THROW(requireMemory(scene.c, scene.particles, nullptr));
  const auto refused = [&] { return refusal([&] { requireMemory(scene.c, scene.particles, &device); }); };
  EXPECT_THAT(refused(), HasSubstr("1300 particles need about "));
  EXPECT_THAT(refused(), HasSubstr(" of device memory, "));
  EXPECT_THAT(refused(), HasSubstr(" available on Some GPU"));
  device.freeMemory = 0;
  EXPECT_THAT(refused(), HasSubstr("Some GPU gives no device memory"));
}

TEST(DeviceMemory, OfSeveralProcessesIsThatOfAPart) {
  const test::MemoryScene scene = smallScene();
  const MemoryEstimate part = estimatedMemory(scene.c, scene.counts, true, 4);
  EXPECT_LT(part.device, estimatedMemory(scene.c, scene.counts, true).device);
  DeviceInfo device;
  device.name = "Some GPU";
  device.freeMemory = part.device;
  EXPECT_NO_THROW(requireMemory(scene.c, scene.counts, &device, 4, 4));
  device.freeMemory = part.device * 8 / 10;
  EXPECT_THAT(refusal([&] { requireMemory(scene.c, scene.counts, &device, 4, 4); }),
              HasSubstr("1300 particles, shared by 4 processes, need about "));
}

/// Each of several processes has a part, and the first one the whole state beside it.
TEST(HostMemory, OfSeveralProcessesIsTheirSum) {
  test::MemoryScene scene({"dam-break-3d.toml", {}});
  for (const bool onDevice : {false, true}) {
    const MemoryEstimate alone = estimatedMemory(scene.c, scene.counts, onDevice),
                         shared = estimatedMemory(scene.c, scene.counts, onDevice, 4);
    EXPECT_GE(shared.first, alone.first);
    if (!onDevice) {
      EXPECT_LT(shared.host, alone.host);
      EXPECT_GT(4 * shared.host, alone.host);
    }
    MemoryCounts many = scene.counts;
    many.particles.wall += 1'000'000'000;  // the places of so many do not fit into what the steps take
    EXPECT_GT(estimatedMemory(scene.c, many, onDevice, 4).host, shared.host + 24'000'000'000);
  }
}

TEST(HostMemory, WhatDoesNotFitIsRefusedForAllProcesses) {
  const test::MemoryScene scene = smallScene();
  EXPECT_NO_THROW(requireMemory(scene.c, scene.counts, nullptr, 2, 2));
  EXPECT_THAT(refusal([&] { requireMemory(scene.c, scene.counts, nullptr, 2, 1'000'000'000); }),
              HasSubstr("1300 particles, shared by 2 processes, need about "));
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
    const test::MemoryScene scene({file, {}});
    const MemoryEstimate needed = estimatedMemory(scene.c, scene.counts, false);
    const double estimate = static_cast<double>(needed.host + needed.first);
    const test::Workshop workshop;
    const test::Outcome outcome = workshop.call(fmt::format("run {}/{} -o run --backend cpu --quiet --end-time {}",
                                                            TREACLE_CASES, file, 2 * scene.c.time.step));
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    const double measured = nlohmann::json::parse(workshop.content("run/summary.json")).at("peak_memory_bytes");
    EXPECT_NEAR(estimate, measured, test::memoryShare * measured);
  }
}

TEST(HostMemory, OfParticlesIsLookedAtBeforeTheyAreMade) {
  Case c = test::MemoryCase{"dam-break-3d.toml", {}}.read();
  EXPECT_EQ(leastPoints(c), 44'000);
  EXPECT_NO_THROW(requireRoomForParticles(c));
  // Not even their fields have room, which are more than their places.
  EXPECT_NO_THROW(requireRoomForParticles(c, 1, 10 << 20));
  EXPECT_THROW(requireRoomForParticles(c, 1, 2 << 20), RunError);
  EXPECT_NO_THROW(requireRoomForParticles(c, 1000, 2 << 20));
  c.bodies[1].shape.max[2] = 10'000;  // [m]: 4e9 particles
  EXPECT_LT(leastPoints(c), maxParticles);
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
