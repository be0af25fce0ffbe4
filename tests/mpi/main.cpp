#include "job.hpp"

#include "treacle/core/device.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <optional>

namespace treacle::test {
namespace {

std::optional<Communicator> theJob;

}  // namespace

const Communicator& job() { return *theJob; }

void useOwnDevice() { useDevice(job().localRank() % cudaDevices().size()); }

std::string casesDirectory() {
  const char* elsewhere = std::getenv("TREACLE_CASES");
  return elsewhere ? elsewhere : TREACLE_CASES;
}

}  // namespace treacle::test

/// Fails at all processes where it fails at one. Only the first one says what it runs.
int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  treacle::test::theJob.emplace(treacle::Communicator::ofJob());
  const treacle::Communicator& job = treacle::test::job();
  if (job.rank() > 0) testing::GTEST_FLAG(brief) = true;
  int failed = RUN_ALL_TESTS();
  for (int other : job.all(failed)) failed |= other;
  treacle::test::theJob.reset();
  return failed;
}
