#include "treacle/model/case/formula.hpp"

#include "treacle/core/error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <numbers>
#include <optional>
#include <string_view>
#include <system_error>

namespace treacle {
namespace {

using Step = FormulaStep;

struct NamedOperation {
  std::string_view name;
  Step::Operation operation;
};
constexpr NamedOperation functions[] = {
    {"abs", Step::Absolute},      {"sign", Step::Sign},       {"sqrt", Step::SquareRoot},
    {"exp", Step::Exponential},   {"log", Step::Logarithm},   {"ln", Step::Logarithm},
    {"log10", Step::Logarithm10}, {"sin", Step::Sine},        {"cos", Step::Cosine},
    {"tan", Step::Tangent},       {"atan", Step::ArcTangent}, {"tanh", Step::HyperbolicTangent},
    {"min", Step::Minimum},       {"max", Step::Maximum}};

/// Operators between two values, by how tightly they bind; those of two characters stand before their beginnings.
struct Level {
  std::vector<NamedOperation> operators;
  bool compares = false;
};
const Level levels[] = {{{{"||", Step::Or}}},
                        {{{"&&", Step::And}}},
                        {{{"<=", Step::LessOrEqual},
                          {">=", Step::GreaterOrEqual},
                          {"==", Step::Equal},
                          {"!=", Step::Unequal},
                          {"<", Step::Less},
                          {">", Step::Greater}},
                         true},
                        {{{"+", Step::Add}, {"-", Step::Subtract}}},
                        {{{"*", Step::Multiply}, {"/", Step::Divide}}}};

/// Reads a text by descending through the levels; what is wrong is thrown as text.
class Reader {
 public:
  Reader(const std::string& text, std::span<const std::string> variables, std::vector<Step>& steps)
      : text_(text), variables_(variables), steps_(steps) {}

  void read() {
    choice();
    skipSpace();
    if (at_ < text_.size()) fail(fmt::format("unexpected \"{}\"", text_.substr(at_, 20)));
  }

 private:
  [[noreturn]] static void fail(const std::string& why) { throw InputError(why); }

  void skipSpace() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
  }
  bool take(std::string_view symbol) {
    skipSpace();
    if (std::string_view(text_).substr(at_, symbol.size()) != symbol) return false;
    at_ += symbol.size();
    return true;
  }
  void require(std::string_view symbol) {
    if (!take(symbol)) fail(fmt::format("\"{}\" is missing", symbol));
  }

  /// Adds a step that leaves so many numbers more on the stack.
  void put(Step::Operation operation, int more, std::uint8_t variable = 0, double number = 0) {
    depth_ += more;
    if (depth_ > Formula::deepest) fail("too many values inside each other");
    steps_.push_back({operation, variable, number});
  }

  void choice() {
    if (++nested_ > 64) fail("too many brackets inside each other");
    between(0);
    if (take("?")) {
      choice();
      require(":");
      choice();
      put(Step::Choose, -2);
    }
    --nested_;
  }

  void between(std::size_t level) {
    if (level == std::size(levels)) return sign();
    between(level + 1);
    for (bool first = true; const auto operation = operatorOf(levels[level]); first = false) {
      if (levels[level].compares && !first) fail(twoComparisons);
      between(level + 1);
      put(*operation, -1);
    }
  }
  std::optional<Step::Operation> operatorOf(const Level& level) {
    for (const NamedOperation& o : level.operators)
      if (take(o.name)) return o.operation;
    return {};
  }

  /// A sign binds less tightly than a power on its right: -x^2 is -(x^2).
  void sign() {
    if (++nested_ > 64) fail("too many signs behind each other");
    if (take("-")) {
      sign();
      put(Step::Negate, 0);
    } else if (take("+")) {
      sign();
    } else {
      power();
    }
    --nested_;
  }
  void power() {
    value();
    if (!take("^")) return;
    sign();
    put(Step::Power, -1);
  }

  void value() {
    skipSpace();
    if (take("(")) {
      choice();
      return require(")");
    }
    if (at_ == text_.size()) fail("it ends where a value is expected");
    const char first = text_[at_];
    if (std::isdigit(static_cast<unsigned char>(first)) || first == '.') return number();
    if (std::isalpha(static_cast<unsigned char>(first)) || first == '_') return name();
    fail(fmt::format("unexpected \"{}\" where a value is expected", first));
  }

  void number() {
    std::size_t end = at_;
    const auto digits = [&] {
      while (end < text_.size() && std::isdigit(static_cast<unsigned char>(text_[end]))) ++end;
    };
    digits();
    if (end < text_.size() && text_[end] == '.') ++end, digits();
    if (end < text_.size() && (text_[end] == 'e' || text_[end] == 'E')) {
      std::size_t exponent = end + 1;
      if (exponent < text_.size() && (text_[exponent] == '+' || text_[exponent] == '-')) ++exponent;
      if (exponent < text_.size() && std::isdigit(static_cast<unsigned char>(text_[exponent])))
        end = exponent, digits();
    }
    double x = 0;  // read with a point whatever the locale
    if (std::from_chars(text_.data() + at_, text_.data() + end, x).ec != std::errc{})
      fail(fmt::format("\"{}\" is no number", text_.substr(at_, end - at_)));
    put(Step::Number, 1, 0, x);
    at_ = end;
  }

  void name() {
    std::size_t end = at_;
    while (end < text_.size() && (std::isalnum(static_cast<unsigned char>(text_[end])) || text_[end] == '_'))
      ++end;
    const std::string name = text_.substr(at_, end - at_);
    at_ = end;
    if (take("(")) return call(name);
    if (name == "pi") return put(Step::Number, 1, 0, std::numbers::pi);
    const auto found = std::ranges::find(variables_, name);
    if (found == variables_.end()) fail(fmt::format("unknown name \"{}\"", name));
    put(Step::Variable, 1, static_cast<std::uint8_t>(found - variables_.begin()));
  }

  void call(const std::string& name) {
    const auto* function = std::ranges::find(functions, name, &NamedOperation::name);
    if (function == std::end(functions)) fail(fmt::format("unknown function \"{}\"", name));
    const bool ofMany = function->operation == Step::Minimum || function->operation == Step::Maximum;
    choice();
    if (!ofMany) put(function->operation, 0);
    while (ofMany && take(",")) {
      choice();
      put(function->operation, -1);
    }
    require(")");
  }

  const std::string& text_;
  std::span<const std::string> variables_;
  std::vector<Step>& steps_;
  std::size_t at_ = 0;
  int depth_ = 0, nested_ = 0;
};

}  // namespace

Formula::Formula(const std::string& text, std::span<const std::string> variables) {
  constexpr std::size_t longest = 1000;
  try {
    if (text.size() > longest) throw InputError(fmt::format("more than {} characters", longest));
    Reader(text, variables, steps_).read();
  } catch (const InputError& e) {
    std::vector<std::string> known;
    for (const std::string& name : variables)
      if (!name.empty()) known.push_back(name);
    throw InputError(fmt::format("expected an expression in {} and the constant pi, found \"{}\": {}",
                                 fmt::join(known, ", "), text.substr(0, 200), e.what()));
  }
}

double Formula::operator()(const double* variables) const {
  return formulaValue(steps_.data(), static_cast<int>(steps_.size()), variables);
}

}  // namespace treacle
