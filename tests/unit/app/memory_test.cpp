#include "memory.hpp"

#include "support/memory_cases.hpp"
#include "treacle/core/error.hpp"
#include "treacle/model/case_keys.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace treacle {
namespace {

using testing::HasSubstr;

Case caseOf(int dimensions) {
  Case c;
  c.dimensions = dimensions;
  c.solver.preconditioner = PreconditionerKind::BucketMultigrid;
  return c;
}

constexpr ParticleNumbers some{1000, 500};

TEST(DeviceMemory, GrowsWithWhatTheSolverStores) {
  for (const int dimensions : {2, 3}) {
    Case ranges = caseOf(dimensions), lists = ranges, diagonal = ranges, assembled = ranges, products = ranges;
    ranges.solver.neighbours = NeighbourKind::Ranges;
    diagonal.solver.multigrid.particleDiagonal = SmootherDiagonal::ExtendedJacobi;
    assembled.solver.operatorKind = OperatorKind::Assembled;
    products.solver.multigrid.coarseOperators = CoarseKind::Spgemm;
    EXPECT_LT(estimatedDeviceMemory(ranges, some), estimatedDeviceMemory(lists, some));
    EXPECT_LT(estimatedDeviceMemory(lists, some), estimatedDeviceMemory(assembled, some));
    EXPECT_EQ(estimatedDeviceMemory(diagonal, some), estimatedDeviceMemory(assembled, some));
    EXPECT_LT(estimatedDeviceMemory(assembled, some), estimatedDeviceMemory(products, some));
  }
}

TEST(DeviceMemory, SettingsOfAMultigridThatIsNotUsedDoNotCount) {
  Case c = caseOf(3);
  const std::uint64_t plain = estimatedDeviceMemory(c, some);
  c.solver.preconditioner = PreconditionerKind::BlockJacobi;
  c.solver.multigrid.coarseOperators = CoarseKind::Spgemm;
  c.solver.multigrid.particleDiagonal = SmootherDiagonal::ExtendedJacobi;
  EXPECT_EQ(estimatedDeviceMemory(c, some), plain);
}

TEST(DeviceMemory, GrowsInProportionToTheNumbersAndLessForWalls) {
  const Case c = caseOf(3);
  const std::uint64_t fixed = estimatedDeviceMemory(c, {0, 0});
  const std::uint64_t fluid = estimatedDeviceMemory(c, {1, 0}) - fixed,
                      wall = estimatedDeviceMemory(c, {0, 1}) - fixed;
  EXPECT_GT(wall, 0u);
  EXPECT_LT(wall, fluid);
  constexpr std::uint64_t many = std::uint64_t{1} << 27;  // more than 32 bits hold
  EXPECT_EQ(estimatedDeviceMemory(c, {many, many}), fixed + many * (fluid + wall));
}

TEST(Memory, OfTheBalanceCountsWhereItIsMade) {
  for (const int dimensions : {2, 3}) {
    Case c = caseOf(dimensions), with = c;
    with.output.balance = true;
    EXPECT_GT(estimatedDeviceMemory(with, some), estimatedDeviceMemory(c, some));
    EXPECT_GT(estimatedMemory(with, some, false), estimatedMemory(c, some, false));
    EXPECT_EQ(estimatedMemory(with, some, true), estimatedMemory(c, some, true));
  }
}

TEST(HostMemory, HoldsNoSolverWhereTheRunIsOnADevice) {
  constexpr ParticleNumbers many{1'000'000, 1'000'000};
  Case c = caseOf(3);
  const std::uint64_t onDevice = estimatedMemory(c, many, true), matrixFree = estimatedMemory(c, many, false);
  EXPECT_LT(onDevice, matrixFree);
  // What lies on a device only makes no difference to the CPU.
  c.solver.neighbours = NeighbourKind::Ranges;
  EXPECT_EQ(estimatedMemory(c, many, false), matrixFree);
  c.solver.operatorKind = OperatorKind::Assembled;
  EXPECT_GT(estimatedMemory(c, many, false), matrixFree);
  EXPECT_EQ(estimatedMemory(c, many, true), onDevice);
}

TEST(HostMemory, ProjectedMultigridTakesMoreAndMostBesideAMatrix) {
  for (const int dimensions : {2, 3}) {
    Case bucket = caseOf(dimensions), projected = bucket;
    projected.solver.preconditioner = PreconditionerKind::ProjectedMultigrid;
    const auto more = [&] {
      return estimatedMemory(projected, some, false) - estimatedMemory(bucket, some, false);
    };
    const std::uint64_t besideLists = more();
    EXPECT_GT(besideLists, 0u);
    bucket.solver.operatorKind = projected.solver.operatorKind = OperatorKind::Assembled;
    EXPECT_GT(more(), besideLists);
    projected.solver.deflation = 0;
    EXPECT_EQ(estimatedMemory(projected, some, true), estimatedMemory(bucket, some, true));
  }
}

TEST(HostMemory, HoldsModesWhereTheSolverHasSome) {
  Case none = caseOf(2);
  none.solver.preconditioner = PreconditionerKind::ProjectedMultigrid;
  none.solver.deflation = 0;
  Case few = none, many = none;
  few.solver.deflation = 8, many.solver.deflation = 16;
  for (const bool onDevice : {false, true}) {
    EXPECT_GT(estimatedMemory(few, some, onDevice), estimatedMemory(none, some, onDevice));
    EXPECT_GT(estimatedMemory(many, some, onDevice), estimatedMemory(few, some, onDevice));
  }
  EXPECT_GT(estimatedDeviceMemory(few, some), estimatedDeviceMemory(none, some));
  many.solver.krylov = KrylovKind::Cr;
  EXPECT_EQ(estimatedDeviceMemory(many, some), estimatedDeviceMemory(none, some));
}

TEST(DeviceMemory, ARunThatDoesNotFitIsRefused) {
  const Case c = caseOf(2);
  DeviceInfo device;
  device.name = "Some GPU";
  device.memory = std::size_t{1} << 40;
  device.freeMemory = estimatedDeviceMemory(c, some);
  EXPECT_NO_THROW(requireMemory(c, some, &device));
  --device.freeMemory;
  EXPECT_NO_THROW(requireMemory(c, some, nullptr));
  try {
    requireMemory(c, some, &device);
    FAIL() << "a run that does not fit was let through";
  } catch (const RunError& error) {
    EXPECT_THAT(error.what(), HasSubstr("1500 particles need about "));
    EXPECT_THAT(error.what(), HasSubstr(" of device memory, "));
    EXPECT_THAT(error.what(), HasSubstr(" available on Some GPU"));
  }
}

TEST(DeviceMemory, ADeviceThatGivesNoneIsNamed) {
  DeviceInfo device;
  device.name = "Some GPU";
  device.memory = std::size_t{1} << 40;
  device.freeMemory = 0;
  try {
    requireMemory(caseOf(2), some, &device);
    FAIL() << "a run without device memory was let through";
  } catch (const RunError& error) {
    EXPECT_THAT(error.what(), HasSubstr("Some GPU gives no device memory"));
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

TEST(HostMemory, OfTheSimulationIsWhatASimulationHolds) {
  for (const test::MemoryCase& memoryCase : test::memoryCases()) {
    SCOPED_TRACE(memoryCase.name());
    const Case c = memoryCase.read();
    const AnySimulation simulation = test::advanced(c, BackendKind::Cpu);
    // On a device the host holds neither state nor solver, but what CUDA takes of it.
    constexpr double driver = 300 << 20;
    const double estimate = static_cast<double>(estimatedMemory(c, simulation.numbers(), false)) -
                            (static_cast<double>(estimatedMemory(c, simulation.numbers(), true)) - driver);
    // Estimates are of peaks of runs, temporary memory included, and of walls that are wet all over.
    const double held = static_cast<double>(simulation.bytes());
    EXPECT_GE(estimate, 0.8 * held);
    EXPECT_LE(estimate, 1.35 * held);
  }
}

/// Peaks of short runs of the dam breaks on one CPU; later a run may keep modes, which estimates count in 2D.
TEST(HostMemory, OfEitherSchemeIsNearWhatRunsTook) {
  const auto expectNear = [](const char* file, ParticleNumbers n, double measured) {
    const double estimate = static_cast<double>(estimatedMemory(test::MemoryCase{file, {}}.read(), n, false));
    EXPECT_GE(estimate, measured) << file;
    EXPECT_LE(estimate, 1.16 * measured) << file;
  };
  expectNear("dam-break-2d.toml", {25'600, 57'600}, 126.4e6);
  expectNear("dam-break-2d.toml", {102'400, 230'400}, 417.9e6);
  expectNear("dam-break-3d.toml", {8'000, 36'000}, 117.4e6);
  expectNear("dam-break-3d.toml", {64'000, 288'000}, 768.3e6);
  expectNear("published/dam-break-2d.toml", {25'600, 57'600}, 113.3e6);
  expectNear("published/dam-break-2d.toml", {102'400, 230'400}, 364.3e6);
  expectNear("published/dam-break-3d.toml", {8'000, 36'000}, 101.6e6);
  expectNear("published/dam-break-3d.toml", {64'000, 288'000}, 620.0e6);
}

/// Peaks of runs of the ISPH dam breaks, on an H200 and on one CPU.
TEST(Memory, OfIsphIsNearWhatRunsTook) {
  Case c;
  c.method.kind = MethodKind::Isph;
  c.solver.preconditioner = PreconditionerKind::HatMultigrid;
  const auto expectNear = [](std::uint64_t estimate, double measured) {
    EXPECT_NEAR(static_cast<double>(estimate), measured, 0.12 * measured);
  };
  c.dimensions = 2;
  expectNear(estimatedDeviceMemory(c, {819'200, 909'312}), 741.4e6);
  expectNear(estimatedMemory(c, {51'200, 56'832}, false), 96.8e6);
  c.dimensions = 3;
  expectNear(estimatedDeviceMemory(c, {3'751'744, 2'695'656}), 5060.8e6);
  expectNear(estimatedDeviceMemory(c, {937'936, 722'568}), 1286.5e6);
  expectNear(estimatedMemory(c, {175'863, 188'190}, false), 317.3e6);
}

/// What runs of 250 particles took at 20 m by 20 m and at 1 m by 1 m by 1 m, on one CPU.
TEST(HostMemory, OfCellsCountsWhereTheDomainIsLarge) {
  Case c;
  c.spacing = 1e-3;
  c.method = defaultMethod(SchemeKind::Published);
  constexpr ParticleNumbers few{100, 150};
  const auto expectNear = [&](const Vec<3>& extents, double measured) {
    c.domain.max = extents;
    EXPECT_NEAR(static_cast<double>(estimatedMemory(c, few, false)), measured, 0.1 * measured);
  };
  expectNear({20, 20, 0}, 872.4e6);
  c.method.scheme = SchemeKind::Accurate, c.method.pressureRadius = 3;
  expectNear({20, 20, 0}, 324.3e6);
  c.method = defaultMethod(SchemeKind::Published);
  c.solver.preconditioner = PreconditionerKind::BucketMultigrid;
  expectNear({20, 20, 0}, 582.1e6);
  c.solver.preconditioner = PreconditionerKind::HatMultigrid;
  c.method.kind = MethodKind::Isph;
  expectNear({20, 20, 0}, 1822.0e6);
  c.dimensions = 3;
  expectNear({1, 1, 1}, 1893.5e6);
  c.method = defaultMethod(SchemeKind::Published);
  c.solver = {};
  expectNear({1, 1, 1}, 653.7e6);

  const std::uint64_t device = estimatedDeviceMemory(c, few);
  c.domain.max = {2, 1, 1};
  EXPECT_GT(estimatedDeviceMemory(c, few), device + (500 << 20));
  const std::uint64_t host = estimatedMemory(c, few, true);
  c.domain = {};
  EXPECT_EQ(estimatedMemory(c, few, true), host);
}

}  // namespace
}  // namespace treacle
