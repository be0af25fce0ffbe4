#include "recorder.hpp"

#include "history_row.hpp"
#include "treacle/core/timer.hpp"
#include "treacle/core/trace.hpp"
#include "treacle/io/checkpoint/checkpoint.hpp"
#include "treacle/io/picture/picture.hpp"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <utility>

namespace treacle {
namespace {

Frame fluidFrame(const Case& c, const Snapshot& s) {
  Frame frame = s.particles.visit([&](const auto& p) { return makeFrame(p, 0, p.fluidCount, s.time); });
  addViscosities(c.materials, frame);
  return frame;
}

Frame wallsFrame(const Snapshot& s) {
  return s.particles.visit([&](const auto& p) { return makeFrame(p, p.fluidCount, p.count, s.time); });
}

ProbeRecorder::Target filesOf(const RunDirectory& directory) {
  return [&directory](const Probe& probe) {
    directory.makeRoomForProbes();
    return directory.probe(probe.name);
  };
}

}  // namespace

Recorder::Recorder(const Case& c, RunDirectory& directory, RunLog& log, double start, bool timings,
                   CopyState copyState, ProbeRecorder::Measure measure, OrderPieces orderPieces)
    : case_(c),
      directory_(directory),
      log_(log),
      copyState_(std::move(copyState)),
      orderPieces_(std::move(orderPieces)),
      history_(directory.history(), {.flow = c.isOpen(), .timings = timings}),
      probes_(c, filesOf(directory), start, std::move(measure)),
      frames_(c.output.interval, c.time, start),
      checkpoints_(c.output.checkpointInterval, c.time, start),
      watch_(c),
      hanging_(c),
      // OpenMP forgets in a new thread how many it was given.
      output_([this, threads = omp_get_max_threads()](const Snapshot& snapshot) {
        omp_set_num_threads(threads);
        write(snapshot);
      }) {
  if (c.output.balance) balance_.emplace(directory.balance(), c);
  if (c.hasRigid()) rigid_.emplace(directory.rigidBodies(), c);
}

void Recorder::begin() {
  Timer timer;
  probes_.begin();
  outputSeconds_ += timer.lap();
  save(true, false);
}

void Recorder::record(const StepReport& report) {
  if (steps_++ == 0) firstIterations_ = report.iterations;
  lastIterations_ = report.iterations, lastStep_ = report.step;
  iterations_ += report.iterations;
  fallbacks_ += report.fallbacks;
  rejected_ += report.rejected;
  leastStep_ = steps_ == 1 ? report.timeStep : std::min(leastStep_, report.timeStep);
  longestStep_ = std::max(longestStep_, report.timeStep);
  stepTime_ += report.timeStep;
  seconds_ += report.seconds;
  meanDensity_ = report.diagnostics.meanDensityRatio;
  densityError_ = report.diagnostics.meanDensityError;
  largestDensityError_ = std::max(largestDensityError_, densityError_);
  Timer timer;
  history_.append(historyRow(case_, report));
  if (report.flow) flow_ = *report.flow;
  if (balance_ && report.balance) balance_->append(report.step, report.time, *report.balance);
  if (rigid_) rigid_->append(report.step, report.time, report.rigid);
  probes_.record(report);
  outputSeconds_ += timer.lap();
  const bool frame = frames_.due(report.time), checkpoint = checkpoints_.due(report.time);
  save(frame, checkpoint);
  joinPieces(PieceOrder::Collect);
}

void Recorder::save(bool frame, bool checkpoint) {
  if (frame && inPieces()) takePieces();
  frame = frame && !inPieces();
  if (frame || checkpoint) handOver(takeSnapshot(), frame, checkpoint);
}

void Recorder::takePieces() {
  Timer timer;
  orderPieces_(PieceOrder::Take, directory_.frameCount() + openFrames_.size());
  openFrames_.push_back(lastIterations_);
  outputSeconds_ += timer.lap();
}

/// Joins the pieces that have been written so far.
void Recorder::joinPieces(PieceOrder order) {
  if (openFrames_.empty()) return;
  Timer timer;
  try {
    for (const PiecedFrame& f : orderPieces_(order, 0)) {
      directory_.joinPieces(f.pieces);
      frameStep_ = f.step;
      note(f.step, f.pieces.time, openFrames_.front(), f.arrangement, f.cost);
      openFrames_.pop_front();
    }
  } catch (...) {
    openFrames_.clear();  // their numbers are given anew
    throw;
  }
  outputSeconds_ += timer.lap();
}

void Recorder::wait() {
  Timer timer;
  output_.wait();
  outputSeconds_ += timer.lap();
  joinPieces(PieceOrder::Finish);
}

void Recorder::writeFrame() {
  wait();
  if (inPieces()) {
    if (frameStep_ >= 0 && (steps_ == 0 || frameStep_ == lastStep_)) return;
    takePieces();
    return joinPieces(PieceOrder::Finish);
  }
  Snapshot* snapshot = finalSnapshot();
  if (!snapshot || frameStep_ == snapshot->step) return;
  handOver(*snapshot, true, false);
  wait();
}

void Recorder::writeCheckpoint() {
  wait();
  Snapshot* snapshot = finalSnapshot();
  if (!snapshot || checkpointStep_ == snapshot->step) return;
  handOver(*snapshot, false, true);
  wait();
}

void Recorder::drawPicture() {
  const Snapshot* state = finalSnapshot();
  if (!state) return;
  PictureOptions options;
  options.spacing = case_.spacing;
  options.gravity = case_.gravity;
  options.title = case_.title;
  drawFrame(directory_.finalPicture(), fluidFrame(case_, *state), wallsFrame(*state), options);
}

std::vector<std::string> Recorder::takeWarnings() {
  const std::lock_guard lock(warningsMutex_);
  return std::exchange(warnings_, {});
}

void Recorder::summarise(RunSummary& summary) const {
  summary.meanIterations = steps_ > 0 ? static_cast<double>(iterations_) / static_cast<double>(steps_) : 0;
  summary.firstIterations = firstIterations_;
  summary.lastIterations = lastIterations_;
  summary.fallbacks = fallbacks_;
  summary.rejectedSteps = rejected_;
  summary.leastStep = leastStep_, summary.longestStep = longestStep_;
  summary.meanStep = steps_ > 0 ? stepTime_ / static_cast<double>(steps_) : 0;
  summary.meanDensity = meanDensity_;
  summary.densityError = densityError_;
  summary.largestDensityError = largestDensityError_;
  summary.arrangement = lastArrangement_;
  summary.smallestLeast = smallestLeast_, summary.smallestLow = smallestLow_;
  if (flow_) summary.flow = {flow_->particles, flow_->in.particles, flow_->out.particles};
  summary.phaseSeconds = {
      {"search", seconds_.search}, {"lists", seconds_.lists}, {"coefficients", seconds_.coefficients},
      {"coarse", seconds_.coarse}, {"solve", seconds_.solve}, {"update", seconds_.update},
      {"output", outputSeconds_}};
  summary.frames = directory_.frameCount(), summary.frameCost = frameCost_;
  summary.outputThreadSeconds = output_.busySeconds();
}

Snapshot& Recorder::takeSnapshot() {
  Timer timer;
  Snapshot& snapshot = output_.next();
  snapshot.whole = false;
  copyState_(snapshot);
  snapshot.whole = true;
  outputSeconds_ += timer.lap();
  return snapshot;
}

/// What the run ends with; null where it is lost.
Snapshot* Recorder::finalSnapshot() {
  if (!isLost_) return &takeSnapshot();
  Snapshot& last = output_.last();
  return last.whole ? &last : nullptr;
}

void Recorder::handOver(Snapshot& snapshot, bool frame, bool checkpoint) {
  snapshot.iterations = lastIterations_;
  snapshot.frame = frame, snapshot.checkpoint = checkpoint;
  output_.handOver();
}

/// Called by the output thread.
void Recorder::write(const Snapshot& s) {
  const TraceRange range("output");
  if (s.frame) {
    Timer timer;
    Frame fluid = fluidFrame(case_, s);
    const Frame walls = wallsFrame(s);
    const Arrangement arrangement = measureArrangement(fluid, walls, case_.domain, case_.spacing);
    std::uint64_t bytes = directory_.writeFrame(fluid, walls, case_.output);
    if (case_.output.surface)
      bytes += directory_.writeSurface(directory_.frameCount() - 1, freeSurface(fluid, case_.spacing),
                                       SurfaceFormat::Vtp, case_.output.compression);
    frameStep_ = s.step;
    note(s.step, s.time, s.iterations, arrangement, {bytes, timer.lap()});
    if (std::optional<std::string> warning = hanging_.look(fluid, walls, arrangement)) {
      const std::lock_guard lock(warningsMutex_);
      warnings_.push_back(std::move(*warning));
    }
  }
  if (s.checkpoint) {
    s.particles.visit([&](const auto& p) {
      treacle::writeCheckpoint(directory_.checkpoint(), p, s.step, s.time, case_.method.kind,
                               StateNames::of(case_));
    });
    checkpointStep_ = s.step;
  }
}

/// Notes in the log that a frame is on disk. The output thread calls it, or, if frames are in pieces, that of the
/// run.
void Recorder::note(std::int64_t step, double time, int iterations, const Arrangement& arrangement,
                    const FrameCost& cost) {
  log_.info(fmt::format("frame {}: step {}, t = {:.6g} s, {} iterations, {}; {:.3g} MB in {:.3g} s",
                        directory_.frameCount() - 1, step, time, iterations, textOf(arrangement),
                        static_cast<double>(cost.bytes) / 1e6, cost.seconds));
  frameCost_ += cost;
  lastArrangement_ = arrangement;
  smallestLeast_ = std::min(smallestLeast_, arrangement.least);
  smallestLow_ = std::min(smallestLow_, arrangement.low);
  const std::vector<std::string> warnings = watch_.look(arrangement, time);
  const std::lock_guard lock(warningsMutex_);
  warnings_.insert(warnings_.end(), warnings.begin(), warnings.end());
}

}  // namespace treacle
