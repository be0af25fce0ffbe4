#pragma once

#include "frame_watch.hpp"
#include "interval.hpp"
#include "output_thread.hpp"
#include "piece_writer.hpp"
#include "probe_recorder.hpp"
#include "run_log.hpp"
#include "run_tally.hpp"
#include "treacle/io/files/run_directory.hpp"
#include "treacle/io/tables/balance_writer.hpp"
#include "treacle/io/tables/history.hpp"
#include "treacle/io/tables/rigid_writer.hpp"
#include "treacle/io/tables/summary.hpp"
#include "treacle/model/case/case.hpp"
#include "treacle/step/run/simulation.hpp"

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace treacle {

/// Writes what a run leaves behind: frames, history, checkpoints, picture, summary. Frames and checkpoints are
/// written by another thread, from a copy of the particles, while the simulation goes on; until wait() the run
/// directory and the files in it are that thread's. Where processes share the run frames may be written in pieces
/// (PieceWriter); what makes frames of them is written here, soon after the last piece. Errors, of every member
/// but summarise: RunError or std::bad_alloc, also for what was to be written since the call before.
class Recorder {
 public:
  /// The simulation that a recorder reads.
  struct Source {
    std::function<void(Snapshot&)> copyState;  // particles, step and time of the simulation
    ProbeRecorder::Measure measure;
    // Has the PieceWriters of all processes do something; empty: frames are not written in pieces.
    std::function<std::vector<PiecedFrame>(PieceOrder order, std::size_t frame)> orderPieces{};
  };

  /// `start`: simulation time at which the run starts [s]. `timings`: the history has the seconds of the phases.
  Recorder(const Case& c, RunDirectory& directory, RunLog& log, double start, bool timings, Source source);

  /// The frame of the state at the start, and what probes read there.
  void begin();

  /// Rows of the history and, where the case wants it, the balance for every step, what probes read, a frame and
  /// a checkpoint when they are due.
  void record(const StepReport& report);

  /// Returns when all frames and checkpoints up to now are on disk.
  void wait();

  /// The state as it is, unless it is the last frame, or in the checkpoint, already; on disk when they return.
  void writeFrame();
  void writeCheckpoint();

  void drawPicture();

  /// The simulation's memory is lost, with a device: in place of the state as it is stands from now on the last
  /// one that was copied, that of the last frame or checkpoint, where there is one.
  void loseSimulation() { isLost_ = true; }

  /// What is to be said about frames written since the call before.
  std::vector<std::string> takeWarnings() { return watch_.takeWarnings(); }

  /// Fills in iterations, fallbacks, densities, distances and seconds. To be called after wait().
  void summarise(RunSummary& summary) const;

 private:
  Snapshot& takeSnapshot();
  Snapshot* finalSnapshot();
  void save(bool frame, bool checkpoint);
  void handOver(Snapshot& snapshot, bool frame, bool checkpoint);
  void write(const Snapshot& snapshot);

  bool inPieces() const { return static_cast<bool>(source_.orderPieces); }
  void takePieces();
  void joinPieces(PieceOrder order);

  const Case& case_;
  RunDirectory& directory_;
  Source source_;
  std::deque<int> openFrames_;  // in pieces that may not all be on disk: iterations of their steps
  HistoryWriter history_;
  std::optional<BalanceWriter> balance_;
  std::optional<RigidWriter> rigid_;
  ProbeRecorder probes_;
  Interval frames_, checkpoints_;
  RunTally tally_;
  FrameWatch watch_;  // the output thread's, or that of the run where pieces are joined
  std::int64_t frameStep_ = -1, checkpointStep_ = -1;  // of the last ones on disk; likewise
  bool isLost_ = false;
  double outputSeconds_ = 0;  // that the simulation had to wait
  OutputThread output_;       // last: it uses the others
};

}  // namespace treacle
