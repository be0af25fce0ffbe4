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
  addViscosities(c, frame);
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

Recorder::Recorder(const Case& c, RunDirectory& directory, RunLog& log, double start, bool timings, Source source)
    : case_(c),
      directory_(directory),
      source_(std::move(source)),
      history_(directory.history(), {.flow = c.isOpen(), .gas = c.gas.has_value(), .timings = timings}),
      probes_(c, filesOf(directory), start, source_.measure),
      frames_(c.output.interval, c.time, start),
      checkpoints_(c.output.checkpointInterval, c.time, start),
      watch_(c, log),
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
  tally_.add(report);
  Timer timer;
  history_.append(historyRow(case_, report));
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
  source_.orderPieces(PieceOrder::Take, directory_.frameCount() + openFrames_.size());
  openFrames_.push_back(tally_.lastIterations());
  outputSeconds_ += timer.lap();
}

/// Joins the pieces that have been written so far.
void Recorder::joinPieces(PieceOrder order) {
  if (openFrames_.empty()) return;
  Timer timer;
  try {
    for (const PiecedFrame& f : source_.orderPieces(order, 0)) {
      directory_.joinPieces(f.pieces);
      frameStep_ = f.step;
      watch_.note(directory_.frameCount() - 1, f.step, f.pieces.time, openFrames_.front(), f.arrangement, f.cost);
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
    if (frameStep_ >= 0 && (tally_.steps() == 0 || frameStep_ == tally_.lastStep())) return;
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

void Recorder::summarise(RunSummary& summary) const {
  const PhaseSeconds& seconds = tally_.seconds();
  summary.tally = tally_.tally(), summary.frames = watch_.tally();
  summary.frames.count = directory_.frameCount();
  summary.phaseSeconds = {
      {"search", seconds.search}, {"lists", seconds.lists}, {"coefficients", seconds.coefficients},
      {"coarse", seconds.coarse}, {"solve", seconds.solve}, {"update", seconds.update},
      {"output", outputSeconds_}};
  summary.outputThreadSeconds = output_.busySeconds();
}

Snapshot& Recorder::takeSnapshot() {
  Timer timer;
  Snapshot& snapshot = output_.next();
  snapshot.whole = false;
  source_.copyState(snapshot);
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
  snapshot.iterations = tally_.lastIterations();
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
    const Arrangement arrangement =
        measureArrangement(fluid, solidWalls(case_, walls), case_.domain, case_.spacing);
    std::uint64_t bytes = directory_.writeFrame(fluid, walls, case_.output);
    if (case_.output.surface)
      bytes += directory_.writeSurface(directory_.frameCount() - 1, freeSurface(fluid, case_.spacing),
                                       SurfaceFormat::Vtp, case_.output.compression);
    frameStep_ = s.step;
    watch_.note(directory_.frameCount() - 1, s.step, s.time, s.iterations, arrangement, {bytes, timer.lap()});
    watch_.look(fluid, walls, arrangement);
  }
  if (s.checkpoint) {
    s.particles.visit([&](const auto& p) {
      treacle::writeCheckpoint(directory_.checkpoint(), p, s.step, s.time, case_.method.kind,
                               StateNames::of(case_));
    });
    checkpointStep_ = s.step;
  }
}

}  // namespace treacle
