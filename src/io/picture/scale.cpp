#include "scale.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

namespace treacle {

namespace {

/// Decimals that tell multiples of `step` apart.
int decimalsFor(double step) {
  for (int decimals = 0; decimals < 9; ++decimals) {
    const double shown = step * std::pow(10.0, decimals);
    if (std::abs(shown - std::round(shown)) < 1e-6 * shown) return decimals;
  }
  return 9;
}

std::string superscript(int exponent) {
  constexpr std::array<std::string_view, 10> digits = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = exponent < 0 ? "⁻" : "";
  for (const char c : std::to_string(std::abs(exponent))) text += digits[static_cast<std::size_t>(c - '0')];
  return text;
}

}  // namespace

bool isDrawable(double x) { return std::abs(x) <= 1e150; }

std::vector<double> niceTicks(double low, double high, int wanted) {
  if (!(high > low)) return {low};
  const double gaps = std::max(wanted - 1, 1);
  const double raw = high / gaps - low / gaps;  // the difference itself may be more than a number can be
  // No round numbers lie between two that numbers hardly tell apart, nor between those at the ends of what they
  // hold.
  const double largest = std::max(std::abs(low), std::abs(high));
  if (!(raw > 1e-13 * largest) || raw < 1e-300 || raw > 1e300) return {low, high};
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  // The largest round step that is at most a little over the raw one: few ticks rather than crowded ones.
  double step = power;
  for (const double multiple : {2.0, 5.0, 10.0})
    if (multiple * power <= 1.5 * raw) step = multiple * power;
  std::vector<double> ticks;
  for (;;) {
    const double slack = 1e-9 * step;
    for (double k = std::ceil((low - slack) / step); k * step <= high + slack; ++k) ticks.push_back(k * step);
    if (ticks.size() >= 2) return ticks;
    ticks.clear();
    step /= 2;
  }
}

std::string Scale::text(double value) const {
  const double shown = value / factor;
  const bool zero = std::abs(shown) < 0.5 * std::pow(10.0, -decimals);
  return fmt::format("{:.{}f}", zero ? 0.0 : shown, decimals);
}

Scale scaleFor(const std::vector<double>& ticks, const std::string& unit) {
  double largest = 0;
  for (const double tick : ticks) largest = std::max(largest, std::abs(tick));
  const double step = ticks.size() > 1 ? ticks[1] - ticks[0] : largest;
  if (!(largest > 0)) return {1, 0, unit};
  int exponent = static_cast<int>(std::floor(std::log10(largest) + 1e-9));
  exponent = exponent >= -2 && exponent <= 3 ? 0 : static_cast<int>(std::floor(exponent / 3.0)) * 3;
  const double factor = std::pow(10.0, exponent);
  const std::string power = exponent == 0 ? "" : "10" + superscript(exponent);
  const std::string gap = power.empty() || unit.empty() ? "" : " ";
  return {factor, decimalsFor(step / factor), power + gap + unit};
}

Scale lengthScale(double extent, double step) {
  const bool small = extent < 0.5;
  const double factor = small ? 1e-3 : 1;
  return {factor, decimalsFor(step / factor), small ? "mm" : "m"};
}

}  // namespace treacle
