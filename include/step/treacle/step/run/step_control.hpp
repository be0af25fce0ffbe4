#pragma once

#include "treacle/model/case/case.hpp"
#include "treacle/model/state/step_memory.hpp"
#include "treacle/step/readings/step_change.hpp"

namespace treacle {

/// Chooses the lengths of automatic steps (docs/time-step.md). They follow from the case, the time, the speeds and
/// the memory of the steps, and from nothing else.
class StepControl {
 public:
  struct Step {
    double length;  // [s]
    double end;     // time at its end: exactly that of a frame or of the run's end where it meets them [s]
  };

  /// A case with automatic steps, whose bounds are known (setStepBounds).
  explicit StepControl(const Case& c);

  /// The next step from `time` [s], where the fastest particle goes at `fastest` [m/s].
  Step next(const StepMemory&, double time, double fastest) const;

  /// The error of a step of `length` [s] that changes velocities by so much, in proportion to its length.
  double error(const StepChange&, double length, const StepMemory&) const;

  /// Whether a step counts: one that is exact enough or cannot be shorter. It is then the last one of the memory;
  /// else a shorter one is planned. `way`: how far pressures carry particles in it, over what they bear, which
  /// bounds the next step; zero where that does not matter.
  bool accept(double length, double error, double way, StepMemory&) const;
  /// Whether fluid that goes at `speed` [m/s] in the mean flows in a step of `length` [s], and does not rest.
  bool flows(double speed, double length) const;

  /// Plans a shorter step in place of one that could not be solved. False where it cannot be shorter.
  bool shorten(double length, StepMemory&) const;

 private:
  static constexpr double rounding = 1e-9;

  double planned(const StepMemory&) const;
  double quantised(double length) const;
  double nextMeeting(double time) const;
  bool isShortest(double length) const { return length <= least_ * (1 + rounding); }

  double tolerance_;                         // [-]
  double least_, longest_, end_, interval_;  // [s]
  double reach_;                             // way of the fastest particle in a step, at most [m]
  double spacing_;                           // [m]
};

}  // namespace treacle
