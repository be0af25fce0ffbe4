#include "arrangement_watch.hpp"

#include <fmt/format.h>

#include <cmath>

namespace treacle {

std::vector<std::string> ArrangementWatch::look(const Arrangement& a, double time) {
  std::vector<std::string> warnings;
  const auto warn = [&](const std::string& text) {
    warnings.push_back(fmt::format("t = {:.6g} s: {}", time, text));
  };
  // The least distance is that of one pair, which comes and goes: it is told once.
  const bool many = a.low < lowBound && a.low < warnedLow_ / 2, one = a.least < leastBound && !clumped_;
  if (many || one) warn(clumpText(a)), clumped_ = true;
  if (many) warnedLow_ = a.low;
  const double error = a.density ? std::abs(*a.density - 1) : 0;
  if (error > densityBound && error > 2 * warnedError_) warn(densityText(*a.density)), warnedError_ = error;
  return warnings;
}

std::string ArrangementWatch::clumpText(const Arrangement& a) const {
  return fmt::format(
      "fluid particles clump: one has its nearest neighbour at {:.3g} spacings, and 1 % have it within {:.3g} "
      "(warned of below {:g} and {:g}). Such pairs count for one particle, so that the fluid around them is "
      "resolved more coarsely than the spacing says; {}a shorter time step may help",
      a.least, a.low, leastBound, lowBound, published() ? "method.scheme = \"accurate\" or " : "");
}

std::string ArrangementWatch::densityText(double density) const {
  return fmt::format(
      "the density inside the fluid is {:.3f} of its material's (warned of beyond {:g} %). So much of its "
      "volume is {}, and levels and fronts are wrong accordingly; {}{}a smaller spacing may help",
      density, 100 * densityBound, density > 1 ? "lost" : "gained",
      density > 1 && case_.method.kind == MethodKind::MphI ? "a larger bulk viscosity, " : "",
      published() ? "method.scheme = \"accurate\" or " : "");
}

bool ArrangementWatch::published() const {
  return case_.method.kind == MethodKind::MphI && case_.method.scheme == SchemeKind::Published;
}

std::string textOf(const Arrangement& a) {
  return fmt::format("nearest distances from {:.3g}, 1 % below {:.3g}, density inside {}", a.least, a.low,
                     a.density ? fmt::format("{:.4f}", *a.density) : "unknown");
}

}  // namespace treacle
