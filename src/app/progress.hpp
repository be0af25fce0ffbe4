#pragma once

#include "treacle/model/case/case.hpp"
#include "treacle/step/run/simulation.hpp"

#include <chrono>
#include <cstdint>
#include <string>

namespace treacle {

/// Tells the user on stdout how far a run is: on a terminal one line that is rewritten a few times per second,
/// otherwise plain lines, one for every tenth of the run and at least one a minute. Where steps vary in length
/// their number is not known, and the way to the end is that of the time.
class Progress {
 public:
  /// `step`, `time`: those that the run starts at. The case must outlive this.
  Progress(const Case& c, std::int64_t step, double time, bool quiet);

  void update(const StepReport& report);

  /// Ends the progress line, for something else to be printed below it.
  void endLine();

  /// Prints a line of its own, below which the progress line goes on.
  void message(const std::string& text);

 private:
  using Clock = std::chrono::steady_clock;

  std::string line(const StepReport& report) const;
  double done(std::int64_t step, double time) const;

  const Case& case_;
  double first_;  // part of the whole that was done at the start
  bool quiet_, terminal_;
  bool lineOpen_ = false;  // the cursor stands behind an unfinished line
  int tenths_;
  Clock::time_point start_, last_;
};

/// "5 min 20 s", "2 h 3 min", "0.8 s".
std::string durationText(double seconds);

}  // namespace treacle
