#include "treacle/core/team.hpp"

#include "treacle/core/parallel.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <numeric>
#include <stdexcept>
#include <thread>
#include <vector>

namespace treacle {
namespace {

/// So many threads until the end of a test.
class Threads {
 public:
  explicit Threads(int count) : before_(omp_get_max_threads()) { omp_set_num_threads(count); }
  ~Threads() { omp_set_num_threads(before_); }
  Threads(const Threads&) = delete;

 private:
  int before_;
};

/// On a thread that has not led a team yet, and so has not waited for one.
template <class F>
void leadAnew(int threads, F&& body) {
  std::thread([&] {
    const Threads limit(threads);
    Team::lead(body);
  }).join();
}

TEST(Team, SharesLoopsOfAllLengthsOncePerIteration) {
  for (const int threads : {1, 2, 3, 5}) {
    const Threads limit(threads);
    Team::lead([&] {
      ASSERT_EQ(Team::led() != nullptr, threads > 1);
      for (const std::size_t n : {0, 1, 2, 7, 63, 64, 1000}) {
        std::vector<int> visits(n), dynamic(n);
        parallelFor(n, 2, [&](std::size_t i) { ++visits[i]; });
        parallelForDynamic(n, 2, 3, [&](std::size_t i) { ++dynamic[i]; });
        EXPECT_EQ(visits, std::vector<int>(n, 1)) << threads << " threads";
        EXPECT_EQ(dynamic, std::vector<int>(n, 1)) << threads << " threads";
      }
    });
    EXPECT_EQ(Team::led(), nullptr);
  }
}

TEST(Team, FitsItsWorkWhereItIsToldTo) {
  const Threads limit(4);
  const auto sizeFor = [](std::size_t work) {
    int size = 0;
    Team::lead([&] { size = Team::led() ? Team::led()->size() : omp_get_max_threads(); }, work);
    return size;
  };
  EXPECT_EQ(sizeFor(314), 4);
  Team::fitToWork(true);
  EXPECT_EQ(sizeFor(0), 1);
  EXPECT_EQ(sizeFor(314), 1);
  EXPECT_EQ(sizeFor(600), 2);
  EXPECT_EQ(sizeFor(1'000'000), 4);
  Team::fitToWork(false);
}

TEST(Team, HasAShareForEveryThread) {
  leadAnew(3, [] {
    std::vector<int> threads(3, -1);
    auto job = [&](int thread) { threads[static_cast<std::size_t>(thread)] = omp_get_thread_num(); };
    Team::led()->run(job);
    EXPECT_EQ(threads, (std::vector<int>{0, 1, 2}));
  });
}

TEST(Team, LetsEveryLoopSeeWhatTheOneBeforeItWrote) {
  const Threads limit(4);
  std::vector<long> a(500), b(500);
  std::iota(a.begin(), a.end(), 0);
  Team::lead([&] {
    for (int k = 0; k < 2000; ++k) {
      parallelFor(a.size(), 2, [&](std::size_t i) { b[i] = a[a.size() - 1 - i] + 1; });
      std::swap(a, b);
    }
  });
  for (std::size_t i = 0; i < a.size(); ++i) ASSERT_EQ(a[i], static_cast<long>(i) + 2000);
}

TEST(Team, ALoopInsideALoopIsComplete) {
  const Threads limit(2);
  std::vector<std::vector<int>> visits(8, std::vector<int>(100));
  Team::lead([&] {
    parallelFor(visits.size(), 2, [&](std::size_t row) {
      EXPECT_EQ(Team::led(), nullptr);
      parallelFor(visits[row].size(), 2, [&](std::size_t i) { ++visits[row][i]; });
    });
    EXPECT_NE(Team::led(), nullptr);
  });
  for (const std::vector<int>& row : visits) EXPECT_EQ(row, std::vector<int>(100, 1));
}

/// Where the others come late the leader does some loops alone, and asks them again.
TEST(Team, DoesNotWaitAgainAndAgainForThreadsThatAreLate) {
  int byOthers = 0, shares = 0;
  leadAnew(2, [&] {
    const auto leader = std::this_thread::get_id();
    auto job = [&](int thread) {
      if (thread == 0) return;
      ++shares;
      if (std::this_thread::get_id() == leader) return;
      ++byOthers;
      std::this_thread::sleep_for(std::chrono::milliseconds(3));  // as if another program had the core
    };
    for (int k = 0; k < 1000; ++k) Team::led()->run(job);
  });
  EXPECT_EQ(shares, 1000);
  EXPECT_GE(byOthers, 4);  // after 16, 32, 64, ... loops
  EXPECT_LE(byOthers, 8);
}

TEST(Team, HandsOnWhatIsThrownAndCanLeadAgain) {
  const Threads limit(2);
  EXPECT_THROW(Team::lead([] { throw std::runtime_error("a step failed"); }), std::runtime_error);
  EXPECT_EQ(Team::led(), nullptr);
  // In the leader's share of a loop, whose other share is finished first.
  std::vector<int> visits(1000);
  const auto fail = [&] {
    parallelFor(visits.size(), 2, [&](std::size_t i) {
      if (i == 10) throw std::bad_alloc();
      ++visits[i];
    });
  };
  EXPECT_THROW(Team::lead(fail), std::bad_alloc);
  EXPECT_EQ(std::accumulate(visits.begin(), visits.end(), 0), 10 + 500);
  int sum = 0;
  Team::lead([&] { sum = 1; });
  EXPECT_EQ(sum, 1);
}

}  // namespace
}  // namespace treacle
