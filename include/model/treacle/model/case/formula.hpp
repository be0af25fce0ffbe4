#pragma once

#include "treacle/core/macros.hpp"

#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace treacle {

/// One operation of a formula, on a stack of numbers.
struct FormulaStep {
  enum Operation : std::uint8_t {
    Number,
    Variable,
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
    Less,
    LessOrEqual,
    Greater,
    GreaterOrEqual,
    Equal,
    Unequal,
    And,
    Or,
    Minimum,
    Maximum,
    Choose,  // the second of three numbers where the first is not zero, else the third
    Negate,
    Absolute,
    Sign,
    SquareRoot,
    Exponential,
    Logarithm,
    Logarithm10,
    Sine,
    Cosine,
    Tangent,
    ArcTangent,
    HyperbolicTangent
  };
  Operation operation = Number;
  std::uint8_t variable = 0;
  double number = 0;
};

/// What is wrong with "a < x < b", in which a number of 0 or 1 would be compared with b.
inline constexpr const char* twoComparisons = "two comparisons in a row; write \"a < x && x < b\" for a range";

/// An expression that both backends evaluate, particle by particle: the operators, functions and precedences of
/// the expressions of case files (expression.hpp), with variables of any names.
class Formula {
 public:
  static constexpr int deepest = 16;  // numbers that wait on the stack

  /// Variables of an empty name cannot be read. Errors: InputError with what was expected and what is wrong with
  /// the text.
  Formula(const std::string& text, std::span<const std::string> variables);

  const std::vector<FormulaStep>& steps() const { return steps_; }
  double operator()(const double* variables) const;

 private:
  std::vector<FormulaStep> steps_;
};

/// The value of `count` steps of a formula, of which there is at least one.
TREACLE_HD inline double formulaValue(const FormulaStep* steps, int count, const double* variables) {
  using Step = FormulaStep;
  double stack[Formula::deepest];
  int top = -1;  // where its last number is
  for (int k = 0; k < count; ++k) {
    const Step step = steps[k];
    if (step.operation == Step::Number || step.operation == Step::Variable) {
      stack[++top] = step.operation == Step::Number ? step.number : variables[step.variable];
      continue;
    }
    if (step.operation == Step::Choose) {
      top -= 2;
      stack[top] = stack[top] != 0 ? stack[top + 1] : stack[top + 2];
      continue;
    }
    if (step.operation < Step::Choose) --top;
    double& a = stack[top];
    const double b = step.operation < Step::Choose ? stack[top + 1] : 0;
    switch (step.operation) {
      case Step::Add:
        a += b;
        break;
      case Step::Subtract:
        a -= b;
        break;
      case Step::Multiply:
        a *= b;
        break;
      case Step::Divide:
        a /= b;
        break;
      case Step::Power:
        a = std::pow(a, b);
        break;
      case Step::Less:
        a = a < b;
        break;
      case Step::LessOrEqual:
        a = a <= b;
        break;
      case Step::Greater:
        a = a > b;
        break;
      case Step::GreaterOrEqual:
        a = a >= b;
        break;
      case Step::Equal:
        a = a == b;
        break;
      case Step::Unequal:
        a = a != b;
        break;
      case Step::And:
        a = a != 0 && b != 0;
        break;
      case Step::Or:
        a = a != 0 || b != 0;
        break;
      case Step::Minimum:
        a = b < a ? b : a;
        break;
      case Step::Maximum:
        a = b > a ? b : a;
        break;
      case Step::Negate:
        a = -a;
        break;
      case Step::Absolute:
        a = std::fabs(a);
        break;
      case Step::Sign:
        a = (a > 0) - (a < 0);
        break;
      case Step::SquareRoot:
        a = std::sqrt(a);
        break;
      case Step::Exponential:
        a = std::exp(a);
        break;
      case Step::Logarithm:
        a = std::log(a);
        break;
      case Step::Logarithm10:
        a = std::log10(a);
        break;
      case Step::Sine:
        a = std::sin(a);
        break;
      case Step::Cosine:
        a = std::cos(a);
        break;
      case Step::Tangent:
        a = std::tan(a);
        break;
      case Step::ArcTangent:
        a = std::atan(a);
        break;
      case Step::HyperbolicTangent:
        a = std::tanh(a);
        break;
      default:
        break;
    }
  }
  return stack[0];
}

}  // namespace treacle
