#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "command.hpp"
#include "machine.hpp"
#include "support/gpu.hpp"

namespace treacle::test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

nlohmann::json summaryOf(const Workshop& shop, const std::string& run) {
  return nlohmann::json::parse(shop.content(run + "/summary.json"));
}

TEST(backend, cudaIsRefusedWhereItIsNotWithWhatIsMissing) {
  if (!cudaDevices().empty()) GTEST_SKIP() << "this machine has a CUDA device";
  Workshop shop;
  const bool compiled = shop.call("info").out.find("CUDA        compiled") != std::string::npos;
  const Outcome outcome = withSmallCase(shop).call("run small.toml --backend cuda");
  EXPECT_EQ(outcome.exitCode, 2);
  EXPECT_EQ(outcome.err,
            std::string("treacle: error: --backend cuda: ") +
                (compiled ? "no CUDA device on this machine" : "this program was built without CUDA") +
                "; expected 'auto' or 'cpu'\n");
  EXPECT_THAT(outcome.out, IsEmpty());
  EXPECT_FALSE(std::filesystem::exists(shop / "small-run"));
}

TEST(backend, aDeviceWithoutCodeIsNamedWithWhatToBuild) {
  EXPECT_EQ(noCodeText({.name = "NVIDIA A40", .computeMajor = 8, .computeMinor = 6, .hasCode = false}, "90 100"),
            "NVIDIA A40 needs code for sm_86, and this program was built for 90 100; configure with "
            "-DCMAKE_CUDA_ARCHITECTURES=86, or 'native' where the device is");
}

TEST(backend, cpuIsTakenWhereItIsAskedForOrAllThereIs) {
  Workshop shop;
  withSmallCase(shop);
  ASSERT_EQ(shop.call("run small.toml --backend cpu --threads 1 --quiet").exitCode, 0);
  const auto summary = summaryOf(shop, "small-run");
  EXPECT_EQ(summary["backend"], "cpu");
  EXPECT_EQ(summary["peak_device_memory_bytes"], 0);
  if (!cudaDevices().empty()) return;
  ASSERT_EQ(shop.call("run small.toml --threads 1 --quiet -o auto").exitCode, 0);
  EXPECT_EQ(summaryOf(shop, "auto")["backend"], "cpu");
}

TEST(backend, settingsForGpusAreNotedOnTheCpu) {
  Workshop shop;
  withSmallCase(shop);
  const std::string run = "run small.toml --backend cpu --threads 1 --set solver.preconditioner=bucket-multigrid ";
  const Outcome ranges = shop.call(run + "--set solver.neighbours=ranges -o ranges");
  EXPECT_EQ(ranges.exitCode, 0);
  EXPECT_EQ(ranges.err,
            "treacle: warning: solver.neighbours = 'ranges' is for GPUs and has no effect here: the CPU uses "
            "lists\n");
  EXPECT_THAT(shop.content("ranges/run.log"), HasSubstr("warning: solver.neighbours = 'ranges'"));
  const Outcome products = shop.call(run + "--set solver.multigrid.coarse_operators=spgemm -o products");
  EXPECT_EQ(products.exitCode, 0);
  EXPECT_THAT(products.err, HasSubstr("warning: solver.multigrid.coarse_operators = 'spgemm'"));
  EXPECT_THAT(products.err, Not(HasSubstr("neighbours")));
  EXPECT_EQ(shop.call("compare ranges products --quiet --bound 0").exitCode, 0);
}

/// What the command line adds to a run on the GPU. The CPU's run has it too, where it knows it.
class OnDevice : public testing::TestWithParam<const char*> {};

TEST_P(OnDevice, agreesWithTheCpu) {
  TREACLE_SKIP_WITHOUT_GPU();
  Workshop shop;
  withSmallCase(shop);
  const std::string run = std::string("run small.toml --quiet --set output.precision=double ") + GetParam();
  ASSERT_EQ(shop.call(run + " --backend cpu -o cpu").exitCode, 0);
  const Outcome outcome = shop.call(run + " --backend cuda -o cuda");
  ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
  EXPECT_THAT(outcome.err, IsEmpty());
  const Outcome compared = shop.call("compare cuda cpu");
  EXPECT_EQ(compared.exitCode, 0) << compared.out;
  const auto summary = summaryOf(shop, "cuda");
  EXPECT_EQ(summary["backend"], "cuda");
  EXPECT_THAT(summary["device"].get<std::string>(), HasSubstr("(sm_"));
  EXPECT_GT(summary["peak_device_memory_bytes"], 0);
  EXPECT_GT(summary["seconds_per_phase"]["solve"], 0.0);
}

#define BUCKETS "--set solver.preconditioner=bucket-multigrid "
INSTANTIATE_TEST_SUITE_P(Run, OnDevice,
                         testing::Values("", "--precision double", "--set solver.operator=assembled", BUCKETS,
                                         BUCKETS "--precision mixed", BUCKETS "--set solver.neighbours=ranges",
                                         BUCKETS "--set solver.multigrid.coarse_operators=spgemm",
                                         BUCKETS "--set solver.multigrid.particle_diagonal=extended-jacobi",
                                         "--set 'floor.velocity=[0.05, 0]' --set resolution=4"));

TEST(onDevice, autoTakesTheDevice) {
  TREACLE_SKIP_WITHOUT_GPU();
  Workshop shop;
  ASSERT_EQ(withSmallCase(shop).call("run small.toml --quiet").exitCode, 0);
  EXPECT_EQ(summaryOf(shop, "small-run")["backend"], "cuda");
}

TEST(onDevice, aResumedRunGivesTheSameBits) {
  TREACLE_SKIP_WITHOUT_GPU();
  Workshop shop;
  const std::string run = "run small.toml --quiet --backend cuda --set output.precision=double ";
  ASSERT_EQ(withSmallCase(shop).call(run + "-o whole --end-time 8e-3").exitCode, 0);
  ASSERT_EQ(shop.call(run + "-o half --end-time 4e-3").exitCode, 0);
  ASSERT_EQ(shop.call(run + "-o resumed --end-time 8e-3 --resume half/checkpoint.h5").exitCode, 0);
  EXPECT_EQ(shop.content("whole/checkpoint.h5"), shop.content("resumed/checkpoint.h5"));
}

}  // namespace
}  // namespace treacle::test
