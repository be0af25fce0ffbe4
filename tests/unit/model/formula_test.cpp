#include "treacle/model/case/formula.hpp"

#include "treacle/core/error.hpp"
#include "treacle/model/case/expression.hpp"

#include <gmock/gmock.h>
#include <cmath>
#include <string>
#include <vector>

namespace treacle {
namespace {

const std::vector<std::string> variables{"x", "y", "z"};

/// Formulas and the expressions of case files are one language.
TEST(Formula, HasTheValuesOfExpressions) {
  const char* texts[] = {"1",
                         "-x^2",
                         "2^-x",
                         "2^3^0.5",
                         "1 - 2 - 3",
                         "8/4/2",
                         "x + y*z - 4/(1 + x^2)",
                         "-x*-y",
                         "+x",
                         "x < y ? 1 : y < z ? 2 : 3",
                         "x <= 0.5 && y >= 0.5 || z != 0.5",
                         "(x > y) + 2*(x == x)",
                         "min(x, y, z) + 10*max(x, y) - min(z)",
                         "sqrt(abs(x - y)) + sign(x - 0.5)",
                         "exp(-x) * ln(1 + y) + log(2 + z) - log10(3)",
                         "sin(pi*x) + cos(y) - tan(0.1*z) + atan(x) + tanh(y)",
                         "1e-3 + .5 + 2.E+1 + 3.25e0*x",
                         "((x))*(1)"};
  for (const char* text : texts) {
    const Expression expression(text, 3);
    const Formula formula(text, variables);
    for (const Vec<3>& at : {Vec<3>{0, 0, 0}, {0.3, 0.7, 1.9}, {0.5, 0.5, 0.5}, {2, 1, 0.25}})
      EXPECT_DOUBLE_EQ(formula(at.v), expression(at)) << text;
  }
}

std::string faultOf(const std::string& text) {
  try {
    Formula(text, variables);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(Formula, RefusesWhatIsNone) {
  using testing::HasSubstr;
  EXPECT_THAT(faultOf(""),
              HasSubstr("expected an expression in x, y, z and the constant pi, found \"\": it ends"));
  EXPECT_THAT(faultOf("1 +"), HasSubstr("it ends where a value is expected"));
  EXPECT_THAT(faultOf("w"), HasSubstr("unknown name \"w\""));
  EXPECT_THAT(faultOf("foo(1)"), HasSubstr("unknown function \"foo\""));
  EXPECT_THAT(faultOf("(1"), HasSubstr("\")\" is missing"));
  EXPECT_THAT(faultOf("0 < x < 1"), HasSubstr("two comparisons in a row; write \"a < x && x < b\""));
  EXPECT_THAT(faultOf("1 2"), HasSubstr("unexpected \"2\""));
  EXPECT_THAT(faultOf("x ? 1"), HasSubstr("\":\" is missing"));
  EXPECT_THAT(faultOf("x = 1"), HasSubstr("unexpected \"= 1\""));
  EXPECT_THAT(faultOf("exp(1, 2)"), HasSubstr("\")\" is missing"));
  EXPECT_THAT(faultOf("1e999"), HasSubstr("is no number"));
  EXPECT_THAT(faultOf("."), HasSubstr("is no number"));
  EXPECT_THAT(faultOf(std::string(1001, '1')), HasSubstr("more than 1000 characters"));
  EXPECT_THAT(faultOf(std::string(200, '(') + "1"), HasSubstr("too many brackets"));
  EXPECT_THAT(faultOf(std::string(200, '-') + "1"), HasSubstr("too many signs"));
  std::string deep = "1";
  for (int k = 0; k < 20; ++k) deep = "1+(1*" + deep + ")";
  EXPECT_THAT(faultOf(deep), HasSubstr("too many values"));
}

}  // namespace
}  // namespace treacle
