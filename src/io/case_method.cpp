#include "case_settings.hpp"

#include <fmt/format.h>

namespace treacle {
namespace {

using Keys = std::vector<std::string_view>;

const Keys mphKeys{"pressure_radius", "viscosity_radius"};
const Keys isphKeys{"kernel", "smoothing_ratio", "alpha", "walls", "viscosity", "shifting", "negative_pressure"};

IsphSettings readIsph(const Section& s) {
  IsphSettings isph;
  isph.kernel = s.choice<KernelKind>("kernel", isph.kernel);
  isph.smoothingRatio = s.number("smoothing_ratio", Bound::Positive, "spacings", isph.smoothingRatio);
  if (isph.smoothingRatio < 0.9 || isph.smoothingRatio > 2)
    throw s.error(
        "smoothing_ratio",
        fmt::format("expected a number from 0.9 to 2, found {}: with less the sums have too few neighbours "
                    "to be accurate, with more they smooth the flow away and take several times as long",
                    isph.smoothingRatio));
  isph.alpha = s.number("alpha", Bound::NonNegative, "", isph.alpha);
  if (isph.alpha > 1) throw s.error("alpha", fmt::format("expected a number from 0 to 1, found {}", isph.alpha));
  isph.walls = s.choice<WallSlip>("walls", isph.walls);
  isph.viscosity = s.choice<ViscousStep>("viscosity", isph.viscosity);
  isph.shifting = s.number("shifting", Bound::NonNegative, "", isph.shifting);
  isph.negativePressure = s.flag("negative_pressure", isph.negativePressure);
  return isph;
}

}  // namespace

ForeignKeys keysOf(MethodKind owner, const Keys& keys) {
  return {keys, fmt::format("the method '{}'", nameOf(owner))};
}

MethodSettings readMethod(const Section& top) {
  const auto word = top.table()["method"]["name"].value_or(nameOf(MethodKind::MphI));
  const bool isph = word == nameOf(MethodKind::Isph), mph = word == nameOf(MethodKind::MphI);
  // Only the keys of the method at hand; all while it is unclear.
  Keys keys{"name"};
  if (!isph) keys.insert(keys.end(), mphKeys.begin(), mphKeys.end());
  if (!mph) keys.insert(keys.end(), isphKeys.begin(), isphKeys.end());
  const Section s = top.section("method", isph ? "[method] (isph)" : "[method]", keys,
                                isph ? keysOf(MethodKind::MphI, mphKeys) : keysOf(MethodKind::Isph, isphKeys));
  MethodSettings method;
  method.kind = s.choice<MethodKind>("name", method.kind);
  if (isph) {
    method.isph = readIsph(s);
    return method;
  }
  method.pressureRadius = s.number("pressure_radius", Bound::Positive, "spacings", method.pressureRadius);
  method.viscosityRadius = s.number("viscosity_radius", Bound::Positive, "spacings", method.viscosityRadius);
  return method;
}

}  // namespace treacle
