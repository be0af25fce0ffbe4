#pragma once

#include "treacle/step/simulation.hpp"

#include <chrono>
#include <cstdint>
#include <string>

namespace treacle {

/// Tells the user on stdout how far a run is: on a terminal one line that is rewritten a few times per second,
/// otherwise plain lines, one for every tenth of the run and at least one a minute.
class Progress {
 public:
  /// `start`: the step that the run starts at.
  Progress(std::int64_t start, std::int64_t steps, bool quiet);

  void update(const StepReport& report);

  /// Ends the progress line, for something else to be printed below it.
  void endLine();

  /// Prints a line of its own, below which the progress line goes on.
  void message(const std::string& text);

 private:
  using Clock = std::chrono::steady_clock;

  std::string line(const StepReport& report) const;

  std::int64_t first_, steps_;
  bool quiet_, terminal_;
  bool lineOpen_ = false;  // the cursor stands behind an unfinished line
  std::int64_t tenths_;
  Clock::time_point start_, last_;
};

/// "5 min 20 s", "2 h 3 min", "0.8 s".
std::string durationText(double seconds);

}  // namespace treacle
