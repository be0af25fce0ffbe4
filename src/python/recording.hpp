#pragma once

#include "recorder.hpp"
#include "run_log.hpp"
#include "session.hpp"
#include "treacle/core/timer.hpp"
#include "treacle/io/files/run_directory.hpp"
#include "treacle/io/tables/summary.hpp"

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace treacle {

/// The run directory of steps that Python has a session make, as `treacle run` leaves one. The session outlives
/// it. Errors, of every member: RunError, std::bad_alloc.
class Recording {
 public:
  /// Begins with the frame of the session's state. Errors: InputError for a directory that cannot be taken
  /// (RunDirectory::create), and where another one is written of the session.
  Recording(Session& session, const std::filesystem::path& directory, bool force);
  Recording(const Recording&) = delete;
  ~Recording() { release(); }

  /// After a step of the session.
  void record();

  /// Completes the directory: checkpoint, frame, picture, summary. `failure`: why the run ended before its end;
  /// empty: it did not.
  void finish(const std::string& failure);

  std::vector<std::string> takeWarnings() { return recorder_.takeWarnings(); }

 private:
  void writeCase();
  /// Once: later another one may be written of the session.
  void release() {
    if (std::exchange(isRecording_, false)) session_.setRecorded(false);
  }

  Timer timer_;
  Session& session_;
  RunDirectory directory_;
  RunLog log_;
  RunSummary summary_;
  bool isRecording_ = false;
  int written_ = -1;  // revision of the case that was written
  Recorder recorder_;
};

}  // namespace treacle
