#pragma once

#include "interval.hpp"
#include "treacle/io/history.hpp"
#include "treacle/io/run_directory.hpp"
#include "treacle/io/summary.hpp"
#include "treacle/model/case.hpp"
#include "treacle/step/simulation.hpp"

#include <cstdint>

namespace treacle {

/// Writes what a run leaves behind: frames, history, checkpoints, picture, summary. Errors, of every member:
/// RunError.
template <int D>
class Recorder {
 public:
  /// `start`: simulation time at which the run starts [s].
  Recorder(const Case& c, RunDirectory& directory, double start)
      : case_(c),
        directory_(directory),
        history_(directory.history()),
        frames_(c.output.interval, c.time, start),
        checkpoints_(c.output.checkpointInterval, c.time, start) {}

  /// A history row for every step, a frame and a checkpoint when they are due.
  void record(const StepReport& report, const Simulation<D>& simulation);

  /// The state as it is, unless it is the last frame already.
  void writeFrame(const Simulation<D>& simulation);

  /// The state as it is, unless it is in the checkpoint already.
  void writeCheckpoint(const Simulation<D>& simulation);

  void drawPicture(const Simulation<D>& simulation) const;

  /// Fills in steps, iterations and seconds per phase.
  void summarise(RunSummary& summary) const;

 private:
  const Case& case_;
  RunDirectory& directory_;
  HistoryWriter history_;
  Interval frames_, checkpoints_;
  std::int64_t frameStep_ = -1, checkpointStep_ = -1;  // of the last ones
  std::int64_t steps_ = 0, iterations_ = 0;
  int firstIterations_ = 0, lastIterations_ = 0;
  PhaseSeconds seconds_;
  double outputSeconds_ = 0;
};

extern template class Recorder<2>;
extern template class Recorder<3>;

}  // namespace treacle
