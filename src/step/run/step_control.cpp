#include "treacle/step/run/step_control.hpp"

#include <algorithm>
#include <cmath>

namespace treacle {
namespace {

constexpr double safety = 0.9;  // of the step that the tolerance would just allow
constexpr double mostGrowth = 2, leastShare = 0.1;
constexpr double stepsPerOctave = 4;  // planned steps are the longest one times 2^(-k / stepsPerOctave)
constexpr double shareAfterFailure = 0.25;
constexpr double mostWay = 25;       // of pressed particles, over what they bear and the tolerance
constexpr double restsBelow = 1e-3;  // way of fluid in a step, in spacings

}  // namespace

StepControl::StepControl(const Case& c)
    : tolerance_(c.time.tolerance),
      least_(c.time.least),
      longest_(c.time.step),
      end_(c.time.end),
      interval_(c.output.interval),
      reach_(c.time.mostCourant() * c.spacing),
      spacing_(c.spacing) {}

/// Equal steps lead to the next time that is to be met: no short one is left over.
StepControl::Step StepControl::next(const StepMemory& memory, double time, double fastest) const {
  double step = planned(memory);
  // The error of a first step is not seen if velocities follow from positions.
  const double reach = memory.last > 0 ? reach_ : std::min(reach_, tolerance_ * spacing_);
  if (fastest * step > reach) step = std::max(reach / fastest, least_);
  const double target = nextMeeting(time), rest = target - time;
  if (rest <= 0) return {step, time + step};  // beyond the end
  const double count = std::ceil(rest / step * (1 - rounding));
  if (count <= 1) return {rest, target};
  return {rest / count, time + rest / count};
}

/// A step of MPH-I takes the positions at its start and the velocities at its end. Where inertia rules, positions
/// are ahead by dt^2/2 a of the right ones, a being the acceleration; where velocities follow from positions
/// alone, they are behind by as much. This counts as a part of the way in the step, a dt / 2u, so that what adds
/// up is a part of the whole way; or, where that is less, by the root of what it is in spacings, so that fluid can
/// start from rest. Both are proportional to dt, as is the sum of all errors. Velocities that follow from
/// positions have changed over the step before: so the acceleration is taken over the mean of both.
double StepControl::error(const StepChange& d, double length, const StepMemory& memory) const {
  if (d.change == 0) return 0;
  const double over = memory.last > 0 ? 0.5 * (length + memory.last) : length;
  const double acceleration = d.change / over;
  return length * std::min(acceleration / (2 * d.speed), std::sqrt(acceleration / (2 * spacing_)));
}

bool StepControl::flows(double speed, double length) const { return speed * length > restsBelow * spacing_; }

bool StepControl::accept(double length, double error, double way, StepMemory& memory) const {
  if (error > tolerance_ && !isShortest(length)) {
    memory.planned = quantised(length * std::max(safety * tolerance_ / error, leastShare));
    return false;
  }
  // The step that the last two would have borne, in the geometric mean. It is kept while it needs no more than the
  // safety.
  const double rate = error / length, mean = memory.rate > 0 ? std::sqrt(rate * memory.rate) : rate;
  const double now = memory.last > 0 ? planned(memory) : length, most = mostGrowth * now;
  double wanted = mean > 0 ? std::min(safety * tolerance_ / mean, most) : most;
  if (way > 0) wanted = std::min(wanted, mostWay * tolerance_ / way * length);
  memory.planned = wanted < safety * now ? quantised(wanted) : std::max(quantised(wanted), now);
  memory.rate = rate;
  memory.last = length;
  return true;
}

bool StepControl::shorten(double length, StepMemory& memory) const {
  if (isShortest(length)) return false;
  memory.planned = quantised(shareAfterFailure * length);
  return true;
}

double StepControl::planned(const StepMemory& memory) const {
  const double length = memory.planned > 0 ? memory.planned : memory.last;
  return length > 0 ? std::clamp(length, least_, longest_) : longest_;
}

/// A few lengths alone, so that roundings seldom reach the steps, and a steady flow has steps of one length.
double StepControl::quantised(double length) const {
  if (length >= longest_) return longest_;
  const double k = std::ceil(stepsPerOctave * std::log2(longest_ / length) - rounding);
  return std::max(longest_ * std::exp2(-k / stepsPerOctave), least_);
}

/// The time of the next frame, or that of the end.
double StepControl::nextMeeting(double time) const {
  if (interval_ == 0) return end_;
  const double frame = (std::floor(time / interval_ + rounding) + 1) * interval_;
  return frame < end_ * (1 - rounding) ? frame : end_;
}

}  // namespace treacle
