#pragma once

#include <string>
#include <vector>

namespace treacle {

/// Whether a number can be drawn: not where it is not finite, nor where arithmetic with it might not be.
bool isDrawable(double x);

/// Marks at round numbers (1, 2 or 5 times a power of ten) inside [low, high], about `wanted` of them, at least
/// two where high > low: these themselves where rounding leaves no numbers between them.
std::vector<double> niceTicks(double low, double high, int wanted);

/// How numbers of a range are shown: value / factor with `decimals`, and the unit that makes up for the factor.
struct Scale {
  double factor = 1;
  int decimals = 0;
  std::string unit;

  std::string text(double value) const;
};

/// For ticks of a quantity in `unit`; a power of ten moves into the unit where numbers would be long.
Scale scaleFor(const std::vector<double>& ticks, const std::string& unit);

/// For lengths: mm below half a metre, else m. `extent` is the largest length shown [m], `step` the distance of
/// ticks [m].
Scale lengthScale(double extent, double step);

}  // namespace treacle
