#include "given_step.hpp"

#include "treacle/core/error.hpp"

#include <fmt/format.h>

namespace treacle {
namespace {

/// No particle goes farther than so many spacings, and the last step meets the end [s]. The last two share what is
/// left: pressures of water go with 1/dt, and those of a step that is short for no reason are noise.
double courantStep(const TimeSettings& t, double spacing, double time, double fastest) {
  double length = t.step;
  if (fastest * length > t.courant * spacing) length = t.courant * spacing / fastest;
  // Fractions of the time's own rounding would never reach the end.
  if (time + 1e-3 * length == time)
    throw RunError(
        fmt::format("particles at {:.4g} m/s allow steps of {:.3g} s only (time.courant): the time no "
                    "longer advances",
                    fastest, length));
  const double rest = t.end - time;
  if (rest <= 0 || 2 * length < rest) return length;
  return length > rest * (1 - 1e-9) ? rest : rest / 2;
}

}  // namespace

StepControl::Step givenStep(const Case& c, std::int64_t step, double time, double fastest) {
  if (!(c.time.courant > 0)) return {c.time.step, static_cast<double>(step + 1) * c.time.step};
  const double length = courantStep(c.time, c.spacing, time, fastest);
  return {length, time + length};
}

}  // namespace treacle
