#include "pressed_steps.hpp"

#include "treacle/model/case/case_keys.hpp"

#include <fmt/format.h>

#include <utility>

namespace treacle {
namespace {

constexpr double mostWay = 2.5, harmlessWay = 0.5;  // of pressed particles, over what they bear
constexpr double restsBelow = 0.05;                 // way of the fastest particle, in spacings
constexpr double leastShare = 0.02;                 // of the steps of a run: impacts press for a moment

}  // namespace

void PressedSteps::look(const Case& c, double way, double fastest, std::vector<std::string>& warnings) {
  if (warned_ || !(way > mostWay && fastest * c.time.step > restsBelow * c.spacing)) return;
  if (++count_ * c.time.step < leastShare * c.time.end) return;
  warned_ = true;
  const std::string wider =
      c.method.pressureRadius < radiusAroundBodies
          ? fmt::format(", method.pressure_radius = {:g}, which bears ten times the step", radiusAroundBodies)
          : "";
  warnings.push_back(fmt::format(
      "steps of {:g} s are long for the pressure, which could carry particles {:.1f} times as far in each as they "
      "bear: fluid that shears is held back by 15 % or more; take time.step <= {:.2g}{}, or time.step = \"auto\"; "
      "further steps are not reported",
      c.time.step, way, harmlessWay / way * c.time.step, wider));
}

}  // namespace treacle
