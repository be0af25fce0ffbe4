#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "command.hpp"
#include "treacle/io/tables/history.hpp"

namespace treacle::test {
namespace {

using testing::HasSubstr;

/// A workshop with the small case in small.toml and two runs of it in a and b.
Workshop& withTwoRuns(Workshop& shop) {
  shop.put("small.toml", smallCase);
  for (const char* run : {"a", "b"})
    EXPECT_EQ(shop.call(std::string("run small.toml --threads 1 --quiet -o ") + run).exitCode, 0);
  return shop;
}

constexpr const char* full = ": No space left on device\n";

TEST(Streams, whatCannotBePrintedIsAnErrorOfItsOwnCode) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  Workshop shop;
  withTwoRuns(shop);
  for (const char* command :
       {"check small.toml", "info", "--help", "plot a", "compare a b", "compare a b --quiet --bound 0"}) {
    const Outcome outcome = shop.call(std::string(command) + " >/dev/full");
    EXPECT_EQ(outcome.exitCode, 3) << command;
    EXPECT_EQ(outcome.err, std::string("treacle: error: cannot write to stdout") + full) << command;
  }
}

TEST(Streams, errorsThatCannotBePrintedKeepTheirCode) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  Workshop shop;
  shop.put("small.toml", smallCase);
  EXPECT_EQ(shop.call("check none.toml 2>/dev/full").exitCode, 2);
  EXPECT_EQ(shop.call("run small.toml --fast 2>/dev/full").exitCode, 2);
  EXPECT_EQ(shop.call("check small.toml --set time.end=2.5e-3 2>/dev/full").exitCode, 0);
  EXPECT_EQ(shop.call("check small.toml >/dev/full 2>/dev/full").exitCode, 3);
}

TEST(Streams, aRunWhoseProgressCannotBePrintedIsDoneAllTheSame) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  Workshop shop;
  shop.put("small.toml", smallCase);
  const Outcome outcome = shop.call("run small.toml --threads 1 >/dev/full");
  EXPECT_EQ(outcome.exitCode, 3);
  EXPECT_EQ(outcome.err, std::string("treacle: error: cannot write to stdout") + full);
  EXPECT_THAT(shop.content("small-run/summary.json"), HasSubstr("\"status\": \"done\""));
}

TEST(Streams, aRunThatNobodyReadsGoesOn) {
  Workshop shop;
  shop.put("small.toml", smallCase);
  const Outcome outcome =
      shop.call("run small.toml --threads 1 --end-time 0.02; echo $? >code; } | { head -n 1; }; {  true");
  EXPECT_EQ(outcome.exitCode, 0);
  EXPECT_EQ(shop.content("code"), "0\n");
  EXPECT_THAT(shop.content("small-run/summary.json"), HasSubstr("\"status\": \"done\""));
}

TEST(Streams, closedOnesAreNotTakenByFiles) {
  Workshop shop;
  shop.put("small.toml", smallCase);
  for (const char* closed : {"<&- >&-", "<&- >&- 2>&-", ">&-"}) {
    ASSERT_EQ(shop.call(std::string("run small.toml --threads 1 --force ") + closed).exitCode, 0) << closed;
    EXPECT_EQ(readHistory(shop / "small-run/history.csv").size(), 2u) << closed;
  }
}

TEST(Streams, filesOfTheUserStayWhatTheyAre) {
  Workshop shop;
  withTwoRuns(shop);
  std::filesystem::create_symlink("table.csv", shop / "link");
  ASSERT_EQ(shop.call("compare a b --csv link").exitCode, 0);
  EXPECT_TRUE(std::filesystem::is_symlink(shop / "link"));
  EXPECT_THAT(shop.content("table.csv"), HasSubstr("time,frame_a,frame_b"));
  std::filesystem::create_symlink("/dev/null", shop / "null");
  ASSERT_EQ(shop.call("plot a -o null").exitCode, 0);
  EXPECT_TRUE(std::filesystem::is_character_file(shop / "null"));
  ASSERT_EQ(shop.call("compare a b --quiet --csv /dev/stderr").exitCode, 0);
  EXPECT_THAT(shop.content("stderr.txt"), HasSubstr("time,frame_a,frame_b"));
}

TEST(Streams, framesThatAreCutOrHaveNoTimeAreNotCompared) {
  Workshop shop;
  withTwoRuns(shop);
  const std::string frame = shop.content("b/frames/fluid_000002.vtp"), index = shop.content("b/fluid.pvd");
  shop.put("b/frames/fluid_000002.vtp", frame.substr(0, frame.size() - 60));
  Outcome outcome = shop.call("compare a b");
  EXPECT_EQ(outcome.exitCode, 2);
  EXPECT_THAT(outcome.err, HasSubstr("b/frames/fluid_000002.vtp: truncated"));
  shop.put("b/frames/fluid_000002.vtp", frame);
  shop.put("b/fluid.pvd", replaced(index, "timestep=\"0.002\"", "timestep=\"nan\""));
  outcome = shop.call("compare a b");
  EXPECT_EQ(outcome.exitCode, 2);
  EXPECT_THAT(outcome.err, HasSubstr("b/fluid.pvd: time nan of frames/fluid_000002.vtp: expected finite times"));
}

}  // namespace
}  // namespace treacle::test
