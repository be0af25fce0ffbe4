#pragma once

#include "treacle/model/case/case.hpp"

#include <cmath>

namespace treacle {

/// Tells after which steps something regular is due: for every multiple of an interval of simulation time, the
/// step nearest to it, or where steps vary in length the first one at or after it.
class Interval {
 public:
  /// `length`: [s], 0: never due. `start`: the time that a run starts at [s]; what was due up to then is done.
  Interval(double length, const TimeSettings& time, double start)
      : length_(length), ahead_(time.stepsVary() ? rounding * length : time.step / 2), passed_(multiples(start)) {}

  /// To be asked after every step, with its time [s].
  bool due(double time) {
    const double now = multiples(time);
    const bool isDue = now != passed_;
    passed_ = now;
    return isDue;
  }

 private:
  static constexpr double rounding = 1e-9;  // of the time of a multiple, in intervals

  double multiples(double time) const { return length_ > 0 ? std::floor((time + ahead_) / length_) : 0; }

  double length_;  // [s]
  double ahead_;   // [s] half a step: nearest to the multiple, whatever the rounding of time
  double passed_;  // multiples of the interval
};

}  // namespace treacle
