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

/// Of a text too long for a message.
std::string beginningOf(const std::string& text) {
  constexpr std::size_t longest = 200;
  return text.size() <= longest ? text : text.substr(0, longest) + "...";
}

}  // namespace

/// muParser reads numbers by a locale of its own, that of C.
struct Expression::Parser {
  mu::Parser parser;
  Vec<3> x{};

  explicit Parser(int dimensions) {
    constexpr const char* names[] = {"x", "y", "z"};
    parser.ClearConst();
    parser.DefineConst("pi", std::numbers::pi);
    for (int k = 0; k < dimensions; ++k) parser.DefineVar(names[k], &x[k]);
  }

  /// Takes the text; what is wrong with it, or nothing.
  std::string fault(const std::string& text) {
    if (assigns(text)) return "a single = (== compares)";
    try {
      parser.SetExpr(text);
      parser.Eval();
    } catch (const mu::Parser::exception_type& e) {
      return e.GetMsg();
    }
    return parser.GetNumResults() > 1 ? "more than one value" : "";
  }
};

Expression::Expression(const std::string& text, int dimensions) : parser_(std::make_unique<Parser>(dimensions)) {
  if (const std::string fault = parser_->fault(text); !fault.empty())
    throw InputError(fmt::format("expected an expression in {} [m] and the constant pi, found \"{}\": {}",
                                 dimensions == 2 ? "x, y" : "x, y, z", beginningOf(text), fault));
}
Expression::~Expression() = default;
Expression::Expression(Expression&&) noexcept = default;

double Expression::operator()(const Vec<3>& x) const {
  parser_->x = x;
  return parser_->parser.Eval();
}

}  // namespace treacle
