#include "run_log.hpp"

#include "support/temporary_directory.hpp"
#include "treacle/core/error.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>
#include <thread>
#include <vector>

namespace treacle::test {
namespace {

using testing::internal::CaptureStderr;
using testing::internal::GetCapturedStderr;

std::vector<std::string> linesOf(const std::filesystem::path& file) {
  std::istringstream text(content(file));
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  return lines;
}

TEST(RunLog, datesEachLineAndShowsWarnings) {
  const TemporaryDirectory directory;
  put(directory / "run.log", "of an earlier run\n");
  CaptureStderr();
  RunLog log(directory / "run.log", false);
  log.info("one {}"), log.warning("two"), log.error("three");
  EXPECT_EQ(GetCapturedStderr(), "treacle: warning: two\n");
  const std::vector<std::string> lines = linesOf(directory / "run.log");  // on disk while the log is open
  ASSERT_EQ(lines.size(), 3u);
  // Of the operating system's regular expressions: the standard library's take seconds to compile.
  const std::string date = "[0-9]{4}-[0-9]{2}-[0-9]{2} [0-9]{2}:[0-9]{2}:[0-9]{2}\\.[0-9]{3} ";
  const char* ends[] = {"info: one \\{\\}", "warning: two", "error: three"};
  for (std::size_t k = 0; k < 3; ++k) EXPECT_THAT(lines[k], testing::MatchesRegex(date + ends[k]));
}

TEST(RunLog, quietOneKeepsWarningsToItself) {
  const TemporaryDirectory directory;
  CaptureStderr();
  RunLog(directory / "run.log", true).warning("two");
  EXPECT_EQ(GetCapturedStderr(), "");
  EXPECT_THAT(linesOf(directory / "run.log"), testing::ElementsAre(testing::EndsWith("warning: two")));
}

TEST(RunLog, linesOfSeveralThreadsStayWhole) {
  const TemporaryDirectory directory;
  RunLog log(directory / "run.log", true);
  const std::string text(200, 'x');
  std::vector<std::jthread> threads;
  for (int t = 0; t < 4; ++t)
    threads.emplace_back([&] {
      for (int k = 0; k < 100; ++k) log.info(text);
    });
  threads.clear();
  const std::vector<std::string> lines = linesOf(directory / "run.log");
  EXPECT_EQ(lines.size(), 400u);
  for (const std::string& line : lines) EXPECT_THAT(line, testing::EndsWith(" info: " + text));
}

TEST(RunLog, fullDiskLosesLinesAndNothingElse) {
  RunLog log("/dev/full", true);
  for (int k = 0; k < 1000; ++k) EXPECT_NO_THROW(log.info("a line that has no place"));
}

TEST(RunLog, saysWhyItCannotBeOpened) {
  const TemporaryDirectory directory;
  EXPECT_THAT(messageOf<RunError>([&] { RunLog(directory / "none/run.log", true); }),
              testing::EndsWith("none/run.log: No such file or directory"));
}

}  // namespace
}  // namespace treacle::test
