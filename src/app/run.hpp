#pragma once

#include "commands.hpp"
#include "progress.hpp"
#include "recorder.hpp"
#include "resume.hpp"
#include "run_log.hpp"
#include "treacle/core/timer.hpp"
#include "treacle/io/files/run_directory.hpp"
#include "treacle/io/tables/summary.hpp"
#include "treacle/step/run/any_simulation.hpp"

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace treacle {

/// What a run begins with.
struct RunStart {
  StartState state;
  ParticleNumbers particles;  // of all processes
  BackendKind backend = BackendKind::Cpu;
  std::string device;  // its name for the user
};

/// One run from the first frame to the summary. Whatever goes wrong on the way, the last good state (checkpoint
/// and frame), the picture and the summary are still written as far as that is possible.
class Run {
 public:
  /// `processes`: those that share the run, of which this is the first.
  Run(const Case& c, RunStart start, RunDirectory directory, const RunOptions& options,
      const Communicator& processes);

  /// Errors: RunError with the diagnosis, after everything is written; InputError where it could not begin.
  void execute(const std::vector<std::string>& warnings);

 private:
  void describe();
  void advanceToEnd();
  void warnOfFallback(const StepReport& report);
  void warnOfArrangement();
  void keepWatch(const StepReport& report);
  void copyState(Snapshot& snapshot);
  std::vector<PiecedFrame> orderPieces(PieceOrder order, std::size_t frame);
  /// Keeps the diagnosis of the first thing that goes wrong.
  void attempt(const std::function<void()>& action);
  void finish();

  bool onDevice() const { return start_.backend == BackendKind::Cuda; }
  bool atEnd() const { return case_.atEnd(simulation_->step(), simulation_->time()); }
  std::string stepsText() const;
  std::string lastStateText() const;
  void say(const std::string& text);

  Timer timer_;
  const Case& case_;
  const Communicator& processes_;
  RunStart start_;  // the particles of its state go to the simulation
  RunDirectory directory_;
  bool timings_;
  RunLog log_;
  Progress progress_;
  std::optional<PieceWriter> pieces_;  // where frames are written in pieces
  std::optional<AnySimulation> simulation_;
  std::optional<Recorder> recorder_;
  RunSummary summary_;
  std::unique_ptr<std::byte[]>
      reserve_;  // memory that libraries need to write the last state, when there is no more
  std::string failure_;
  bool fellBack_ = false;
  bool isDeviceLost_ = false;
  bool isBadInput_ = false;  // what failed first is what the user gave
  bool isOver_ = false;      // to continue is of no use
  Watched watched_;          // the largest of all steps
};

}  // namespace treacle
