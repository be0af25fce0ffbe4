#pragma once

#include <span>
#include <string>
#include <vector>

namespace treacle {

/// Unknowns of one kind that a step finds together with its flow (StepUnknowns), such as the velocities of rigid
/// bodies. Their number stays the same within a step.
class FlowUnknowns {
 public:
  virtual ~FlowUnknowns() = default;

  /// What they are, for messages: "the velocities of the rigid bodies".
  virtual std::string name() const = 0;
  /// The values that the step begins with, which the flow already has.
  virtual std::vector<double> values() const = 0;
  /// Of each: a change that counts, all > 0.
  virtual std::vector<double> scales() const = 0;
  /// Values that the next flow is solved with.
  virtual void set(std::span<const double> values) = 0;
  /// What the flow at hand misses, as many numbers as there are unknowns; all are zero in the end.
  virtual std::vector<double> missing() = 0;
};

}  // namespace treacle
