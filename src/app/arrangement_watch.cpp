#include "arrangement_watch.hpp"

#include <fmt/format.h>

#include <cmath>

namespace treacle {

std::vector<std::string> ArrangementWatch::look(const Arrangement& a, double time) {
  std::vector<std::string> warnings;
  const auto warn = [&](const std::string& text) {
    warnings.push_back(fmt::format("t = {:.6g} s: {}", time, text));
  };
  if (clumps(a)) warn(clumpText(a));
  // What is known of places alone says nothing where volumes are not all those of the start.
  const double error = a.density && !case_.hasVolumeFactors() ? std::abs(*a.density - 1) : 0;
  if (error > densityBound && error > 2 * warnedError_) warn(densityText(*a.density)), warnedError_ = error;
  return warnings;
}

bool ArrangementWatch::clumps(const Arrangement& a) {
  if (isIsph()) {
    const bool many = a.close > closeBound && a.close > 2 * warnedClose_;
    if (many) warnedClose_ = a.close;
    return many;
  }
  // The least distance is that of one pair, which comes and goes, and does no harm.
  const bool many = a.low < lowBound && a.low < warnedLow_ / 2;
  if (many) warnedLow_ = a.low;
  return many;
}

std::string ArrangementWatch::clumpText(const Arrangement& a) const {
  const std::string found =
      isIsph()
          ? fmt::format("{:.3g} % have their nearest neighbour within {:g} spacings (warned of beyond {:g} %)",
                        100 * a.close, closeDistance, 100 * closeBound)
          : fmt::format("1 % have their nearest neighbour within {:.3g} spacings (warned of below {:g})", a.low,
                        lowBound);
  const char* cure = "";
  if (published()) cure = "method.scheme = \"accurate\" helps, ";
  if (isIsph() && case_.method.isph.negativePressure) cure = "method.negative_pressure = false helps, ";
  return fmt::format(
      "fluid particles clump: {}. Such pairs count for one particle, so that the fluid around them is "
      "resolved more coarsely than the spacing says; {}shorter time steps help only where particles go by much of "
      "a spacing in one",
      found, cure);
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
