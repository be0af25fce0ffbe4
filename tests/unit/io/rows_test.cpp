#include "treacle/io/files/rows.hpp"
#include "support/probe_table.hpp"
#include "support/temporary_directory.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace treacle::test {
namespace {

TEST(Rows, TablesAndFilesHoldTheSame) {
  TemporaryDirectory directory;
  RowTable table;
  for (const RowTarget& target : {RowTarget(directory / "rows.csv"), RowTarget(&table)}) {
    Rows rows(target, "time,x,y");
    rows.append("0,0.1,-3e-300");
    rows.append("1,2,3\n2,4,nan");  // a probe of several places
  }
  const ProbeTable file = readProbe(directory / "rows.csv");
  EXPECT_EQ(table.names, file.names);
  ASSERT_EQ(table.columns.size(), file.columns.size());
  EXPECT_EQ(table.columns[1], file.columns[1]);
  EXPECT_EQ(table.columns[2][0], -3e-300);
  EXPECT_TRUE(std::isnan(table.columns[2][2]));
}

TEST(Rows, NamesOfAnyKind) {
  RowTable table;
  Rows(&table, R"(time,"the ""old"" tank, left_force_x")").append("1,2");
  EXPECT_EQ(table.names[1], R"(the "old" tank, left_force_x)");
}

TEST(Rows, ATableBeginsAnew) {
  RowTable table;
  Rows(&table, "time,x").append("1,2");
  Rows(&table, "time");
  EXPECT_EQ(table.names.size(), 1u);
  EXPECT_TRUE(table.columns[0].empty());
}

TEST(Rows, OtherNumbersThanNamesAreAMistakeOfTheProgram) {
  RowTable table;
  Rows rows(&table, "time,x");
  EXPECT_THROW(rows.append("1"), std::logic_error);
  EXPECT_THROW(rows.append("1,two"), std::logic_error);
}

}  // namespace
}  // namespace treacle::test
