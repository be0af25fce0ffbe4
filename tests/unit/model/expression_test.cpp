#include "treacle/model/case/expression.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <locale>

#include "treacle/core/error.hpp"

namespace treacle::test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

double valueOf(const std::string& text, Vec<3> x = {}) { return Expression(text, 3)(x); }

TEST(Expression, isAFunctionOfTheCoordinates) {
  const Expression f("2*x - y^2/4 + atan2(z, 1)", 3);
  for (const Vec<3>& x : {Vec<3>{0, 0, 0}, Vec<3>{1, 2, 3}, Vec<3>{-0.3, 1e-3, -7}})
    EXPECT_DOUBLE_EQ(f(x), 2 * x[0] - x[1] * x[1] / 4 + std::atan2(x[2], 1.0));
  EXPECT_DOUBLE_EQ(valueOf("sin(pi/6) * cos(2*pi*x)", {0.5, 0, 0}), -0.5);
  EXPECT_DOUBLE_EQ(valueOf("-x^2", {3, 0, 0}), -9);
  EXPECT_DOUBLE_EQ(valueOf("x < 0 ? 1e-3 : max(x, y, z)", {1, 5, 2}), 5);
}

TEST(Expression, comparisonsAreZeroOrOne) {
  for (const auto& [text, expected] : {std::pair("x <= 1 && y != 0", 1.0), std::pair("x > 1 || y == 0", 0.0),
                                       std::pair("x >= 1", 1.0), std::pair("y*0.5 == 1", 1.0)})
    EXPECT_EQ(valueOf(text, {1, 2, 0}), expected) << text;
}

TEST(Expression, needNotBeFinite) {
  EXPECT_TRUE(std::isinf(valueOf("1/x")));
  EXPECT_TRUE(std::isnan(valueOf("sqrt(x)", {-1, 0, 0})));
}

std::string faultOf(const std::string& text, int dimensions = 2) {
  try {
    Expression(text, dimensions);
  } catch (const InputError& e) {
    return e.what();
  }
  return "none";
}

TEST(Expression, faultsAreNamed) {
  EXPECT_THAT(faultOf("x + q"),
              StartsWith("expected an expression in x, y [m] and the constant pi, found \"x + q\": "));
  EXPECT_THAT(faultOf("x + q"), HasSubstr("\"q\" found at position 4"));
  EXPECT_THAT(faultOf("x + q", 3), HasSubstr("in x, y, z [m]"));
  EXPECT_THAT(faultOf("x + z"), HasSubstr("\"z\" found at position 4"));
  EXPECT_EQ(faultOf("x + z", 3), "none");
  EXPECT_THAT(faultOf("x <"), HasSubstr("Unexpected end"));
  EXPECT_THAT(faultOf(""), HasSubstr("empty"));
  EXPECT_THAT(faultOf("sin(x, y)"), HasSubstr("Too many parameters"));
  EXPECT_THAT(faultOf("x, y"), HasSubstr("more than one value"));
  std::string endless = "x";
  while (endless.size() < 30000) endless += "+x";
  EXPECT_THAT(faultOf(endless), HasSubstr("+...\": Expression too long"));
  EXPECT_LT(faultOf(endless).size(), 500u);
  for (const char* assignment : {"x = 1", "y<x ? x=2 : 1", "x=y"})
    EXPECT_THAT(faultOf(assignment), HasSubstr("a single ="));
}

TEST(Expression, refusesComparisonsInARow) {
  for (const char* chain :
       {"-0.05<x<0.05", "x <= y <= 1", "(0 < x < 1) && y > 0", "y > 0 && 1 > x >= 0", "x < y == 1"})
    EXPECT_THAT(faultOf(chain), HasSubstr("two comparisons in a row; write \"a < x && x < b\" for a range"));
  for (const char* sound : {"0 < x && x < 1", "x < 0 ? y < 1 : y < 2", "(x < 0) == (y < 0)", "max(x < 0, y < 0)",
                            "x < (y < 0) || x != 2"})
    EXPECT_EQ(faultOf(sound), "none");
}

/// Numbers with a comma, thousands with a point.
struct OtherNumbers : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

TEST(Expression, doesNotDependOnTheLocale) {
  const std::locale before = std::locale::global(std::locale(std::locale::classic(), new OtherNumbers));
  const double number = valueOf("1.5e-3 + 2000.25"), largest = valueOf("max(0.5, 0.25)");
  std::locale::global(before);
  EXPECT_EQ(number, 1.5e-3 + 2000.25);
  EXPECT_EQ(largest, 0.5);
}

}  // namespace
}  // namespace treacle::test
