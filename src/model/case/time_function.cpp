#include "treacle/model/case/time_function.hpp"

#include "treacle/core/error.hpp"
#include "treacle/model/case/expression.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <unordered_map>

namespace treacle {
namespace {

double finite(double value, const std::string& text, double t) {
  if (std::isfinite(value)) return value;
  throw InputError(fmt::format("\"{}\" is {} at t = {:g} s; expected a finite number", text,
                               std::isnan(value) ? "not a number" : "infinite", t));
}

/// The formula of a text. Reading it takes as long as hundreds of its values, so that each thread keeps what it
/// has read; a process that goes through many cases forgets it now and then.
const Expression& formula(const std::string& text) {
  constexpr std::size_t most = 256;
  thread_local std::unordered_map<std::string, Expression> known;
  if (const auto found = known.find(text); found != known.end()) return found->second;
  if (known.size() >= most) known.clear();
  return known.emplace(text, Expression::ofTime(text)).first->second;
}

double inTable(const TimeFunction& f, double t) {
  const auto next = std::ranges::upper_bound(f.times, t);
  if (next == f.times.begin()) return f.values.front();
  if (next == f.times.end()) return f.values.back();
  const auto k = static_cast<std::size_t>(next - f.times.begin());
  const double share = (t - f.times[k - 1]) / (f.times[k] - f.times[k - 1]);
  return f.values[k - 1] + share * (f.values[k] - f.values[k - 1]);
}

/// Between two corners of the table it is a straight line.
double integralOfTable(const TimeFunction& f, double from, double to) {
  double sum = 0, left = from;
  const auto add = [&](double right) {
    sum += (right - left) * (inTable(f, left) + inTable(f, right)) / 2;
    left = right;
  };
  for (auto corner = std::ranges::upper_bound(f.times, from); corner != f.times.end() && *corner < to; ++corner)
    add(*corner);
  add(to);
  return sum;
}

}  // namespace

double TimeFunction::at(double t) const {
  if (isTable()) return inTable(*this, t);
  if (expression.empty()) return value;
  return finite(formula(expression)({t, 0, 0}), expression, t);
}

double TimeFunction::integral(double from, double to) const {
  if (isTable()) return integralOfTable(*this, from, to);
  if (expression.empty()) return value * (to - from);
  const Expression& f = formula(expression);
  const double middle = (from + to) / 2, half = (to - from) / 2, node = half * std::sqrt(0.6);
  const auto at = [&](double t) { return finite(f({t, 0, 0}), expression, t); };
  return half * (5 * at(middle - node) + 8 * at(middle) + 5 * at(middle + node)) / 9;
}

}  // namespace treacle
