#pragma once

#include "arrangement_watch.hpp"
#include "hanging_watch.hpp"
#include "run_log.hpp"
#include "treacle/io/frames/frame.hpp"
#include "treacle/io/tables/summary.hpp"
#include "treacle/model/case/case.hpp"

#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

namespace treacle {

/// Notes the frames of a run in its log, adds them up for its summary, and warns of what it sees in them. One
/// thread writes frames; warnings may be taken by another one.
class FrameWatch {
 public:
  FrameWatch(const Case& c, RunLog& log) : log_(log), arrangement_(c), hanging_(c) {}

  /// A frame is on disk. `number`: among those of the directory. `iterations`: of its step.
  void note(std::size_t number, std::int64_t step, double time, int iterations, const Arrangement& arrangement,
            const FrameCost& cost);

  /// Looks at one that holds all particles.
  void look(const Frame& fluid, const Frame& walls, const Arrangement& arrangement);

  /// What is to be said about frames since the call before.
  std::vector<std::string> takeWarnings();

  const FrameTally& tally() const { return tally_; }

 private:
  void warn(std::vector<std::string> warnings);

  RunLog& log_;
  ArrangementWatch arrangement_;
  HangingWatch hanging_;
  FrameTally tally_;
  std::mutex mutex_;  // of the warnings
  std::vector<std::string> warnings_;
};

}  // namespace treacle
