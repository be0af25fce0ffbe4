#include "treacle/model/expression.hpp"

#include "treacle/core/error.hpp"

#include <fmt/format.h>
#include <muParser.h>
#include <numbers>

namespace treacle {
namespace {

/// A single = would assign to a coordinate.
bool assigns(const std::string& text) {
  for (std::size_t k = 0; k < text.size(); ++k) {
    if (text[k] != '=') continue;
    const bool comparesBefore = k > 0 && std::string("=<>!").find(text[k - 1]) != std::string::npos;
    const bool comparesAfter = k + 1 < text.size() && text[k + 1] == '=';
    if (!comparesBefore && !comparesAfter) return true;
  }
  return false;
}

}  // namespace

/// muParser reads numbers by a locale of its own, that of C.
struct Expression::Parser {
  mu::Parser parser;
  Vec<3> x{};

  Parser(const std::string& text, int dimensions) {
    constexpr const char* names[] = {"x", "y", "z"};
    parser.ClearConst();
    parser.DefineConst("pi", std::numbers::pi);
    for (int k = 0; k < dimensions; ++k) parser.DefineVar(names[k], &x[k]);
    parser.SetExpr(text);
  }

  /// What is wrong with the expression, or nothing.
  std::string fault() {
    if (assigns(parser.GetExpr())) return "a single = (== compares)";
    try {
      parser.Eval();
    } catch (const mu::Parser::exception_type& e) {
      return e.GetMsg();
    }
    return parser.GetNumResults() > 1 ? "more than one value" : "";
  }
};

Expression::Expression(const std::string& text, int dimensions)
    : parser_(std::make_unique<Parser>(text, dimensions)) {
  if (const std::string fault = parser_->fault(); !fault.empty())
    throw InputError(fmt::format("expected an expression in {} [m] and the constant pi, found \"{}\": {}",
                                 dimensions == 2 ? "x, y" : "x, y, z", text, fault));
}
Expression::~Expression() = default;
Expression::Expression(Expression&&) noexcept = default;

double Expression::operator()(const Vec<3>& x) const {
  parser_->x = x;
  return parser_->parser.Eval();
}

}  // namespace treacle
