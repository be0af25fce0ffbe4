#include "treacle/io/tables/history.hpp"

#include "limited_files.hpp"
#include "support/temporary_directory.hpp"
#include "treacle/core/error.hpp"

#include <cmath>
#include <cstring>
#include <limits>

using namespace treacle;
using namespace treacle::test;

namespace {

constexpr const char* header =
    "step,time,time_step,iterations,residual,kinetic_energy,potential_energy,front_x,top,max_speed,mean_density,"
    "density_error,seconds,fallbacks\n";
constexpr const char* firstHeader =
    "step,time,iterations,residual,kinetic_energy,potential_energy,front_x,top,max_speed,seconds\n";
constexpr const char* secondHeader =
    "step,time,iterations,residual,kinetic_energy,potential_energy,front_x,top,max_speed,seconds,fallbacks\n";
constexpr const char* timingColumns = ",search_s,lists_s,coefficients_s,coarse_s,solve_s,update_s";

/// A header with other columns at its end.
std::string extended(const char* columns) {
  return std::string(columns, std::strlen(columns) - 1) + timingColumns + "\n";
}

HistoryRow row(int k) {
  return {k,        k / 3.0,      0.1 * k,       200 + k,   1e-13 / (k + 1),    std::exp(-k),
          -0.1 * k, std::sqrt(k), 1.0 / (k + 7), 1e300 * k, 1 - 0.01 / (k + 1), 1e-3 / (k + 3),
          1e-300,   k % 3};
}

bool equal(const HistoryRow& a, const HistoryRow& b) {
  return a.step == b.step && a.time == b.time && a.timeStep == b.timeStep && a.iterations == b.iterations &&
         a.residual == b.residual && a.kineticEnergy == b.kineticEnergy &&
         a.potentialEnergy == b.potentialEnergy && a.frontX == b.frontX && a.top == b.top &&
         a.maxSpeed == b.maxSpeed && a.meanDensity == b.meanDensity && a.densityError == b.densityError &&
         a.seconds == b.seconds && a.fallbacks == b.fallbacks;
}

}  // namespace

TEST(History, FormatIsFixed) {
  TemporaryDirectory directory;
  HistoryWriter writer(directory / "history.csv");
  EXPECT_EQ(content(directory / "history.csv"), header);
  writer.append({3, 0.003, 1e-3, 233, 9.5e-13, 1e-6, 0.04, 0.02125, 0.0195, 0.5, 0.998, 0.015, 0.25, 2});
  // Seen without closing the writer.
  EXPECT_EQ(content(directory / "history.csv"),
            std::string(header) + "3,0.003,0.001,233,9.5e-13,1e-06,0.04,0.02125,0.0195,0.5,0.998,0.015,0.25,2\n");
}

TEST(History, ReadsBackToTheSameBits) {
  TemporaryDirectory directory;
  {
    HistoryWriter writer(directory / "history.csv");
    for (int k = 0; k < 500; ++k) writer.append(row(k));
  }
  const std::vector<HistoryRow> rows = readHistory(directory / "history.csv");
  ASSERT_EQ(rows.size(), 500u);
  for (int k = 0; k < 500; ++k) EXPECT_TRUE(equal(rows[static_cast<std::size_t>(k)], row(k))) << k;
}

TEST(History, TimingsAreColumnsOfTheirOwn) {
  TemporaryDirectory directory;
  const auto path = directory / "history.csv";
  HistoryRow timed = row(4);
  timed.timings = {1, 2, 3, 4, 5.5, 6};
  HistoryWriter(path, {.timings = true}).append(timed);
  const std::string text = content(path);
  EXPECT_TRUE(text.starts_with(extended(header))) << text;
  EXPECT_TRUE(text.ends_with(",1e-300,1,1,2,3,4,5.5,6\n")) << text;
  const HistoryRow read = readHistory(path).at(0);
  EXPECT_TRUE(equal(read, timed));
  EXPECT_EQ(read.timings.search, 1);
  EXPECT_EQ(read.timings.lists, 2);
  EXPECT_EQ(read.timings.coefficients, 3);
  EXPECT_EQ(read.timings.coarse, 4);
  EXPECT_EQ(read.timings.solve, 5.5);
  EXPECT_EQ(read.timings.update, 6);
  put(path, text + "1,2,3,4,5,6,7,8,9,10\n");
  EXPECT_NE(messageOf<InputError>([&] { readHistory(path); }).find(":3: expected 20 numbers"), std::string::npos);
}

TEST(History, FilesOfEarlierVersionsAreRead) {
  TemporaryDirectory directory;
  const auto path = directory / "history.csv";
  const auto read = [&](const std::string& text) {
    put(path, text);
    return readHistory(path).at(0);
  };
  HistoryRow expected{1, 2, 0, 3, 4, 5, 6, 7, 8, 9, 0, 0, 10, 0};
  EXPECT_TRUE(equal(read(std::string(firstHeader) + "1,2,3,4,5,6,7,8,9,10\n"), expected));
  HistoryRow timed = read(extended(firstHeader) + "1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16\n");
  EXPECT_TRUE(equal(timed, expected));
  EXPECT_EQ(timed.timings.search, 11);
  EXPECT_EQ(timed.timings.update, 16);
  expected.fallbacks = 11;
  EXPECT_TRUE(equal(read(std::string(secondHeader) + "1,2,3,4,5,6,7,8,9,10,11\n"), expected));
  timed = read(extended(secondHeader) + "1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16,17\n");
  EXPECT_TRUE(equal(timed, expected));
  EXPECT_EQ(timed.timings.search, 12);
  EXPECT_EQ(timed.timings.update, 17);
}

TEST(History, NotANumberIsKept) {
  TemporaryDirectory directory;
  HistoryRow bad = row(1);
  bad.maxSpeed = std::numeric_limits<double>::quiet_NaN();
  bad.top = -std::numeric_limits<double>::infinity();
  HistoryWriter(directory / "history.csv").append(bad);
  const HistoryRow read = readHistory(directory / "history.csv").at(0);
  EXPECT_TRUE(std::isnan(read.maxSpeed));
  EXPECT_EQ(read.top, bad.top);
}

TEST(History, UnfinishedLastLineIsLeftOut) {
  TemporaryDirectory directory;
  put(directory / "history.csv", std::string(header) + "1,2,3,4,5,6,7,8,9,10,11,12,13,0\n2,3,4,5");
  EXPECT_EQ(readHistory(directory / "history.csv").size(), 1u);
}

TEST(History, BadLinesAreNamed) {
  TemporaryDirectory directory;
  const auto path = directory / "history.csv";
  for (const char* bad : {"1,2,3,4,5,6,7,8,9,10,11,12,13\n", "1,2,3,4,5,6,7,8,9,10,11,12,13,14,15\n",
                          "1,2,3,4,x,6,7,8,9,10,11,12,13,0\n", "\n", "1,2,3,4.5,5,6,7,8,9,10,11,12,13,0\n",
                          "1,2,3,4,5,6,7,8,9,10,11,12,13,0.5\n", "1 2 3 4 5 6 7 8 9 10 11 12 13 0\n"}) {
    put(path, std::string(header) + "1,2,3,4,5,6,7,8,9,10,11,12,13,0\n" + bad);
    const std::string message = messageOf<InputError>([&] { readHistory(path); });
    EXPECT_EQ(message.find(path.string() + ":3: expected 14 numbers"), 0u) << message;
  }
  put(path, "time,step\n");
  EXPECT_NE(messageOf<InputError>([&] { readHistory(path); }).find("expected the header"), std::string::npos);
  EXPECT_THROW(readHistory(directory / "none.csv"), InputError);
}

TEST(History, FullDiskLeavesWholeRows) {
  TemporaryDirectory directory;
  const auto path = directory / "history.csv";
  EXPECT_TRUE(withFileLimit(1000, [&] {
    HistoryWriter writer(path);
    const std::string message = messageOf<RunError>([&] {
      for (int k = 0; k < 100; ++k) writer.append(row(k));
    });
    return message == "cannot write " + path.string() + ": File too large";
  }));
  const std::string text = content(path);
  EXPECT_EQ(text.back(), '\n');
  EXPECT_GT(text.size(), 800u);
  EXPECT_GE(readHistory(path).size(), 5u);
}

TEST(History, TimesThatAreNotFiniteAreNamed) {
  TemporaryDirectory directory;
  const auto path = directory / "history.csv";
  for (const char* time : {"nan", "inf", "-inf"}) {
    put(path, std::string(header) + "1," + time + ",3,4,5,6,7,8,9,10,11,12,13,0\n");
    const std::string message = messageOf<InputError>([&] { readHistory(path); });
    EXPECT_EQ(message.find(path.string() + ":2: expected a finite time"), 0u) << message;
  }
}

TEST(History, RemovedWhileItGrowsIsAnError) {
  TemporaryDirectory directory;
  const auto path = directory / "history.csv";
  HistoryWriter writer(path);
  writer.append(row(1));
  std::filesystem::remove(path);
  EXPECT_EQ(messageOf<RunError>([&] { writer.append(row(2)); }),
            "cannot write " + path.string() + ": it was removed while the run went on");
}
