#include "mpi/job.hpp"
#include "treacle/core/processes.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace treacle::test {
namespace {

/// Numbers whose sum depends on the order in which they are added.
double number(int rank, std::size_t k) { return 1.0 / (1.0 + 3.0 * rank + 7.0 * static_cast<double>(k)); }

/// Short arrays are gathered whole, long ones combined in parts: both must be the sums in the order of ranks.
TEST(Communicator, SumsInTheOrderOfRanks) {
  for (std::size_t n : {0, 1, 3, 511, 512, 513, 5000}) {
    std::vector<double> values(n), expected(n);
    for (std::size_t k = 0; k < n; ++k) {
      values[k] = number(job().rank(), k);
      expected[k] = number(0, k);
      for (int r = 1; r < job().size(); ++r) expected[k] += number(r, k);
    }
    job().sum(std::span(values));
    EXPECT_EQ(values, expected) << n;
  }
}

TEST(Communicator, AnyFlag) {
  std::vector<std::uint8_t> flags(10000);
  for (std::size_t k = 0; k < flags.size(); ++k) flags[k] = k % 7 == static_cast<std::size_t>(job().rank());
  job().anyOf(flags);
  for (std::size_t k = 0; k < flags.size(); ++k)
    ASSERT_EQ(flags[k], k % 7 < static_cast<std::size_t>(job().size())) << k;
}

TEST(Communicator, EverybodysValue) {
  const std::vector<int> all = job().all(10 + job().rank());
  ASSERT_EQ(all.size(), static_cast<std::size_t>(job().size()));
  for (int r = 0; r < job().size(); ++r) EXPECT_EQ(all[r], 10 + r);
}

TEST(Communicator, CollectsPartsOfUnequalLength) {
  const std::vector<int> own(job().rank() * 3, job().rank());  // the first has none
  const std::vector<int> whole = job().collect(std::span<const int>(own));
  std::vector<int> expected;
  for (int r = 0; r < job().size() && job().rank() == 0; ++r) expected.insert(expected.end(), r * 3, r);
  EXPECT_EQ(whole, expected);
}

TEST(Communicator, SwapsParts) {
  std::vector<std::vector<int>> to(job().size());
  for (int r = 0; r < job().size(); ++r) to[r].assign(r + 2 * job().rank(), 100 * job().rank() + r);
  const auto from = job().swap(to);
  for (int r = 0; r < job().size(); ++r)
    EXPECT_EQ(from[r], std::vector<int>(job().rank() + 2 * r, 100 * r + job().rank()));
}

TEST(Communicator, Broadcast) {
  double value = job().rank() == 0 ? 3.5 : 0;
  job().broadcast(value);
  EXPECT_EQ(value, 3.5);
}

/// An error of one process is everybody's, with the rank of the first that met one.
TEST(Communicator, AgreesOnErrors) {
  Processes processes;
  if (job().size() > 1) processes.communicator = &job();
  EXPECT_NO_THROW(agreed(processes, [] {}));
  const int last = job().size() - 1;
  try {
    agreed(processes, [&] {
      if (job().rank() == last) throw RunError("it went wrong");
    });
    ADD_FAILURE() << "nothing was thrown";
  } catch (const RunError& e) {
    EXPECT_EQ(std::string(e.what()),
              last == 0 ? "it went wrong" : "rank " + std::to_string(last) + ": it went wrong");
  }
  EXPECT_EQ(firstText(processes, job().rank() == last ? "found" : "", "nothing"), "found");
  EXPECT_EQ(firstText(processes, "", "nothing"), "nothing");
}

TEST(Communicator, SumsOverProcesses) {
  Processes processes;
  processes.communicator = &job();
  double expected = number(0, 0);
  for (int r = 1; r < job().size(); ++r) expected += number(r, 0);
  EXPECT_EQ(sumOverProcesses(processes, number(job().rank(), 0)), expected);
  EXPECT_EQ(sumOverProcesses(Processes{}, 2.5), 2.5);
}

}  // namespace
}  // namespace treacle::test
