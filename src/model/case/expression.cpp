#include "treacle/model/case/expression.hpp"

#include "treacle/core/error.hpp"
#include "treacle/model/case/formula.hpp"

#include <fmt/format.h>
#include <muParser.h>
#include <cstddef>
#include <numbers>
#include <vector>

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

/// Where a comparison follows another one in the same brackets: "0 < x < 1" would compare 0 or 1 with the last
/// number.
bool comparesInARow(const std::string& text) {
  std::vector<bool> compared{false};  // in each of the brackets that are open
  for (std::size_t k = 0; k < text.size(); ++k) {
    const char c = text[k];
    if (c == '(') compared.push_back(false);
    if (c == ')' && compared.size() > 1) compared.pop_back();
    if (c == '&' || c == '|' || c == '?' || c == ':' || c == ',') compared.back() = false;
    if (c != '<' && c != '>' && c != '=' && c != '!') continue;
    if (compared.back()) return true;
    compared.back() = true;
    if (k + 1 < text.size() && text[k + 1] == '=') ++k;
  }
  return false;
}

constexpr const char* coordinates[] = {"x", "y", "z"};
constexpr const char* timeAlone[] = {"t"};

/// The text, or its beginning if it is too long for a message.
std::string beginningOf(const std::string& text) {
  constexpr std::size_t longest = 200;
  return text.size() <= longest ? text : text.substr(0, longest) + "...";
}

}  // namespace

/// muParser reads numbers by a locale of its own, that of C.
struct Expression::Parser {
  mu::Parser parser;
  Vec<3> x{};

  explicit Parser(std::span<const char* const> variables) {
    parser.ClearConst();
    parser.DefineConst("pi", std::numbers::pi);
    for (std::size_t k = 0; k < variables.size(); ++k) parser.DefineVar(variables[k], &x[static_cast<int>(k)]);
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
    if (parser.GetNumResults() > 1) return "more than one value";
    return comparesInARow(text) ? twoComparisons : "";
  }
};

Expression::Expression(const std::string& text, std::span<const char* const> variables, const char* expected)
    : parser_(std::make_unique<Parser>(variables)) {
  if (const std::string fault = parser_->fault(text); !fault.empty())
    throw InputError(fmt::format("expected an expression in {} and the constant pi, found \"{}\": {}", expected,
                                 beginningOf(text), fault));
}
Expression::Expression(const std::string& text, int dimensions)
    : Expression(text, std::span(coordinates).first(static_cast<std::size_t>(dimensions)),
                 dimensions == 2 ? "x, y [m]" : "x, y, z [m]") {}
Expression Expression::ofTime(const std::string& text) { return {text, timeAlone, "t [s]"}; }
Expression::~Expression() = default;
Expression::Expression(Expression&&) noexcept = default;

double Expression::operator()(const Vec<3>& x) const {
  parser_->x = x;
  return parser_->parser.Eval();
}

}  // namespace treacle
