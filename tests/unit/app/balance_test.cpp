#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "command.hpp"
#include "treacle/io/tables/history.hpp"

namespace treacle::test {
namespace {

using testing::HasSubstr;

const std::string movingFloor =
    replaced(replaced(smallCase, "max = [12e-3, 0]", "max = [12e-3, 0]\nvelocity = [0.05, 0]"), "interval = 1e-3",
             "balance = true");

std::vector<std::string> linesOf(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

std::vector<double> numbersOf(const std::string& line) {
  std::vector<double> numbers;
  std::istringstream in(line);
  for (std::string cell; std::getline(in, cell, ',');) numbers.push_back(std::stod(cell));
  return numbers;
}

TEST(balance, closesWithTheHistory) {
  Workshop shop;
  shop.put("case.toml", movingFloor);
  ASSERT_EQ(
      shop.call("run case.toml -o here --threads 1 --quiet --end-time 6e-3 --set solver.tolerance=1e-20").exitCode,
      0);
  const std::vector<std::string> lines = linesOf(shop.content("here/balance.csv"));
  const std::vector<HistoryRow> history = readHistory(shop / "here/history.csv");
  ASSERT_EQ(lines.size(), 7u);
  ASSERT_EQ(history.size(), 6u);
  EXPECT_EQ(lines[0],
            "step,time,shear_dissipation,bulk_dissipation,inertial_loss,elastic_power,elastic_energy,wall_power,"
            "repulsion_power,shift_power,floor_force_x,floor_force_y,floor_torque");
  for (std::size_t k = 0; k < 6; ++k) {
    const std::vector<double> row = numbersOf(lines[k + 1]);
    ASSERT_EQ(row.size(), 13u);
    EXPECT_EQ(row[0], static_cast<double>(k + 1));
    EXPECT_EQ(row[1], history[k].time);
    if (k == 0) continue;
    const double gained = history[k].kineticEnergy + history[k].potentialEnergy - history[k - 1].kineticEnergy -
                          history[k - 1].potentialEnergy;
    const double lost = 1e-3 * (row[2] + row[3] + row[4]), given = 1e-3 * (row[5] + row[7] + row[8] + row[9]);
    EXPECT_GT(lost, 0);
    EXPECT_NEAR(gained + lost, given, 2e-8 * lost);
    // The floor has one velocity: its power is that of the force it exerts.
    EXPECT_NEAR(row[7], -0.05 * row[10], 1e-12 * row[7]);
  }
}

TEST(balance, ofAResumedRunGoesOnWithTheSameBits) {
  Workshop shop;
  shop.put("case.toml", movingFloor);
  const std::string run = "run case.toml --threads 1 --quiet ";
  ASSERT_EQ(shop.call(run + "-o whole --end-time 6e-3").exitCode, 0);
  ASSERT_EQ(shop.call(run + "-o half --end-time 3e-3").exitCode, 0);
  ASSERT_EQ(shop.call(run + "-o rest --end-time 6e-3 --resume half/checkpoint.h5").exitCode, 0);
  std::vector<std::string> whole = linesOf(shop.content("whole/balance.csv"));
  whole.erase(whole.begin() + 1, whole.begin() + 4);
  EXPECT_EQ(linesOf(shop.content("rest/balance.csv")), whole);
}

TEST(balance, isWrittenOnlyWhereTheCaseSaysSo) {
  Workshop shop;
  shop.put("case.toml", movingFloor);
  ASSERT_EQ(shop.call("run case.toml -o here --threads 1 --quiet").exitCode, 0);
  EXPECT_TRUE(std::filesystem::exists(shop / "here/balance.csv"));
  ASSERT_EQ(shop.call("run case.toml -o here --threads 1 --quiet --force --set output.balance=false").exitCode, 0);
  EXPECT_FALSE(std::filesystem::exists(shop / "here/balance.csv"));
}

TEST(balance, isNotForIsph) {
  Workshop shop;
  shop.put("case.toml", replaced(smallIsphCase, "interval = 1e-3", "balance = true"));
  const Outcome outcome = shop.call("run case.toml");
  EXPECT_EQ(outcome.exitCode, 2);
  EXPECT_THAT(outcome.err,
              HasSubstr("case.toml:41:1: unknown key 'balance' in [output]: it belongs to the method 'mph-i'; "
                        "expected 'interval', 'checkpoint_interval', 'fields', 'format', 'precision', "
                        "'compression', 'pieces' or 'surface'"));
}

}  // namespace
}  // namespace treacle::test
