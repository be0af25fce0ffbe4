#pragma once

namespace treacle {

/// What a run remembers of its time steps; zeros: not known.
struct StepMemory {
  double last = 0;  // the last one [s]
  // Of automatic steps.
  double planned = 0;  // the next one, before it is fitted to frames [s]
  double rate = 0;     // error of the last one over its length [1/s]

  bool operator==(const StepMemory&) const = default;
};

}  // namespace treacle
