#pragma once

#include "treacle/core/vec.hpp"

#include <memory>
#include <span>
#include <string>

namespace treacle {

/// A formula of a case file in the coordinates x, y and, in three dimensions, z [m], or in the time t [s], with
/// the constant pi. Whatever the locale, numbers have a point and arguments are separated by commas. Not for
/// several threads at once.
class Expression {
 public:
  /// Errors: InputError with what was expected and what is wrong with the text.
  Expression(const std::string& text, int dimensions);
  /// In the time, which stands for x.
  static Expression ofTime(const std::string& text);
  ~Expression();
  Expression(Expression&&) noexcept;

  /// Its value at x; comparisons give 0 or 1. Need not be finite.
  double operator()(const Vec<3>& x) const;

 private:
  struct Parser;
  Expression(const std::string& text, std::span<const char* const> variables, const char* expected);

  std::unique_ptr<Parser> parser_;
};

}  // namespace treacle
