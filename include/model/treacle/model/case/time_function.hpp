#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace treacle {

/// A number that follows the time: the same always, a formula in t [s], or a table that is joined by straight
/// lines and stays at its first and last value outside.
struct TimeFunction {
  double value = 0;                       // where the others are empty
  std::string expression{};               // model/expression.hpp
  std::vector<double> times{}, values{};  // rising [s], as many values

  bool isConstant() const { return expression.empty() && times.empty(); }
  bool isTable() const { return !times.empty(); }

  /// At time t. Errors: InputError for a formula that is no finite number there.
  double at(double t) const;
  /// Its integral from `from` to `to` [s]: exact but for formulas, of which it is that of Gauss's rule with three
  /// points.
  double integral(double from, double to) const;

  bool operator==(const TimeFunction&) const = default;
};

/// Components of a vector; a missing one is zero.
using TimeVector = std::array<std::optional<TimeFunction>, 3>;

}  // namespace treacle
