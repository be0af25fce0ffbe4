#pragma once

#include "treacle/io/history.hpp"
#include "treacle/io/run_directory.hpp"
#include "treacle/io/summary.hpp"
#include "treacle/model/case.hpp"
#include "treacle/step/simulation.hpp"

#include <cstdint>

namespace treacle {

/// Writes what a run leaves behind: frames, history, picture, summary. Errors, of every member: RunError.
template <int D>
class Recorder {
 public:
  Recorder(const Case& c, RunDirectory& directory)
      : case_(c), directory_(directory), history_(directory.history()) {}

  /// A history row for every step, a frame when it is due.
  void record(const StepReport& report, const Simulation<D>& simulation);

  /// The state as it is, unless it is the last frame already.
  void writeFrame(const Simulation<D>& simulation);

  void drawPicture(const Simulation<D>& simulation) const;

  /// Fills in steps, iterations and seconds per phase.
  void summarise(RunSummary& summary) const;

 private:
  bool frameDue(const StepReport& report);

  const Case& case_;
  RunDirectory& directory_;
  HistoryWriter history_;
  std::int64_t frameStep_ = -1;       // of the last frame
  std::int64_t intervalsPassed_ = 0;  // output intervals
  std::int64_t steps_ = 0, iterations_ = 0;
  int firstIterations_ = 0, lastIterations_ = 0;
  PhaseSeconds seconds_;
  double outputSeconds_ = 0;
};

extern template class Recorder<2>;
extern template class Recorder<3>;

}  // namespace treacle
