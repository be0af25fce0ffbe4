#include "interval.hpp"
#include "progress.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace treacle {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// The times after which something with an interval of 0.1 s is due.
std::vector<double> dueTimes(const TimeSettings& settings, double start, const std::vector<double>& times) {
  Interval interval(0.1, settings, start);
  std::vector<double> due;
  for (const double time : times)
    if (interval.due(time)) due.push_back(time);
  return due;
}

TEST(Interval, IsDueAtTheStepNearestToAMultiple) {
  EXPECT_THAT(dueTimes({0.07, 1}, 0, {0.07, 0.14, 0.21, 0.28, 0.35}), ElementsAre(0.07, 0.21, 0.28));
}

TEST(Interval, IsDueAtTheFirstStepAtOrAfterAMultipleWhereStepsVary) {
  const TimeSettings varying{0.07, 1, 0.2};
  EXPECT_THAT(dueTimes(varying, 0, {0.07, 0.099, 0.101, 0.15, 0.2, 0.21, 0.45, 0.46}),
              ElementsAre(0.101, 0.2, 0.45));
  // A multiple but for rounding, below and above.
  EXPECT_THAT(dueTimes(varying, 0, {0.1 + 0.1 + 0.1 - 1e-16, 0.3 + 1e-16}), ElementsAre(testing::_));
  EXPECT_THAT(dueTimes(varying, 0.3, {0.31, 0.39}), IsEmpty());
  EXPECT_THAT(dueTimes(varying, 0.299, {0.301, 0.39}), ElementsAre(0.301));
}

TEST(Interval, IsNeverDueWithoutLength) {
  Interval interval(0, {0.07, 1, 0.2}, 0);
  EXPECT_FALSE(interval.due(0.5));
}

/// What is printed for steps of so many times, to no terminal, of a run to 2 s.
std::string progressText(const TimeSettings& settings, const std::vector<double>& times) {
  Case c;
  c.time = settings;
  testing::internal::CaptureStdout();
  Progress progress(c, 0, 0, false);
  StepReport report;
  for (const double time : times) {
    ++report.step;
    report.time = time;
    report.iterations = 12;
    progress.update(report);
  }
  return testing::internal::GetCapturedStdout();
}

TEST(Progress, CountsStepsOfOneLength) {
  const std::string text = progressText({0.1, 2}, {0.1, 0.2, 0.3, 0.4});
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 2) << text;
  EXPECT_THAT(text, testing::StartsWith("step 2/20  t = 0.2 s  12 iterations  "));
}

TEST(Progress, GoesByTimeWhereStepsVary) {
  const std::string text = progressText({0.3, 2, 0.2}, {0.1, 0.3, 0.35, 0.55, 2 * (1 - 1e-10)});
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 3) << text;
  EXPECT_THAT(text, testing::StartsWith("step 2  t = 0.3 s (15 %)  12 iterations  "));
  EXPECT_THAT(text, HasSubstr("step 5  t = 2 s (100 %)  12 iterations  0.0 s left\n"));
}

}  // namespace
}  // namespace treacle
