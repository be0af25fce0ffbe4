#include "output_thread.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <future>
#include <new>
#include <stdexcept>
#include <vector>

namespace treacle {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;

void handOver(OutputThread& thread, std::int64_t step) {
  thread.next().step = step;
  thread.handOver();
}

TEST(OutputThread, WritesInOrderWhatWasHandedOver) {
  std::vector<std::int64_t> steps;
  OutputThread thread([&](const Snapshot& s) { steps.push_back(s.step); });
  std::vector<std::int64_t> expected;
  for (std::int64_t k = 0; k < 1000; ++k) {
    handOver(thread, k);
    expected.push_back(k);
  }
  thread.wait();
  EXPECT_EQ(steps, expected);
}

TEST(OutputThread, ASecondSnapshotIsFilledWhileTheFirstIsWrittenAndAThirdWaits) {
  std::promise<void> gate;
  std::shared_future<void> open(gate.get_future());
  std::vector<const void*> written;
  OutputThread thread([&](const Snapshot& s) {
    open.wait();
    written.push_back(&s);
  });
  handOver(thread, 1);
  handOver(thread, 2);
  auto third = std::async(std::launch::async, [&] { return &thread.next(); });
  EXPECT_EQ(third.wait_for(100ms), std::future_status::timeout);
  gate.set_value();
  const void* free = third.get();
  thread.wait();
  ASSERT_EQ(written.size(), 2u);
  EXPECT_NE(written[0], written[1]);
  EXPECT_EQ(free, written[0]);
}

TEST(OutputThread, OneSnapshotIsEnoughWhereWritingIsFast) {
  std::vector<const void*> written;
  OutputThread thread([&](const Snapshot& s) { written.push_back(&s); });
  for (std::int64_t k = 0; k < 3; ++k) {
    handOver(thread, k);
    thread.wait();
  }
  EXPECT_THAT(written, ElementsAre(written[0], written[0], written[0]));
}

TEST(OutputThread, TheLastSnapshotCanBeHandedOverAgain) {
  std::vector<std::int64_t> steps;
  OutputThread thread([&](const Snapshot& s) { steps.push_back(s.step); });
  std::vector<std::int64_t> expected;
  for (std::int64_t k = 0; k < 100; ++k) {
    handOver(thread, 2 * k);
    handOver(thread, 2 * k + 1);
    const Snapshot& last = thread.last();
    EXPECT_EQ(last.step, 2 * k + 1);
    thread.handOver();
    for (const std::int64_t step : {2 * k, 2 * k + 1, 2 * k + 1}) expected.push_back(step);
  }
  thread.wait();
  EXPECT_EQ(steps, expected);
}

TEST(OutputThread, ErrorsAreThrownOnceAndLaterSnapshotsAreWritten) {
  std::vector<std::int64_t> steps;
  std::promise<void> gate;
  std::shared_future<void> open(gate.get_future());
  OutputThread thread([&](const Snapshot& s) {
    open.wait();
    if (s.step < 2) throw std::runtime_error("disk full");
    steps.push_back(s.step);
  });
  handOver(thread, 1);
  handOver(thread, 2);
  gate.set_value();
  EXPECT_THROW(thread.wait(), std::runtime_error);
  EXPECT_THAT(steps, ElementsAre(2));
  EXPECT_NO_THROW(thread.wait());
  handOver(thread, 0);
  // As soon as the error is there, the next snapshot is refused with it.
  EXPECT_THROW(while (true) thread.next(), std::runtime_error);
  handOver(thread, 3);
  thread.wait();
  EXPECT_THAT(steps, ElementsAre(2, 3));
}

TEST(OutputThread, KeepsTheTypeOfErrors) {
  OutputThread thread([](const Snapshot&) { throw std::bad_alloc(); });
  handOver(thread, 1);
  EXPECT_THROW(thread.wait(), std::bad_alloc);
}

TEST(OutputThread, EndsAfterTheLastSnapshot) {
  std::vector<std::int64_t> steps;
  {
    OutputThread thread([&](const Snapshot& s) {
      std::this_thread::sleep_for(20ms);
      steps.push_back(s.step);
      throw std::runtime_error("lost");
    });
    handOver(thread, 1);
    handOver(thread, 2);
  }
  EXPECT_THAT(steps, ElementsAre(1, 2));
}

TEST(OutputThread, CountsTheTimeSpentWriting) {
  OutputThread thread([](const Snapshot&) { std::this_thread::sleep_for(20ms); });
  EXPECT_EQ(thread.busySeconds(), 0);
  handOver(thread, 1);
  handOver(thread, 2);
  thread.wait();
  EXPECT_GE(thread.busySeconds(), 0.04);
  EXPECT_LT(thread.busySeconds(), 10);
}

}  // namespace
}  // namespace treacle
