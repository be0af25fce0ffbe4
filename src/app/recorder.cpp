#include "recorder.hpp"

#include "treacle/core/timer.hpp"
#include "treacle/core/trace.hpp"
#include "treacle/io/checkpoint.hpp"
#include "treacle/io/picture.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace treacle {
namespace {

template <int D>
Frame fluidFrame(const Snapshot<D>& s) {
  return makeFrame(s.particles, 0, s.particles.fluidCount, s.time);
}

template <int D>
Frame wallsFrame(const Snapshot<D>& s) {
  return makeFrame(s.particles, s.particles.fluidCount, s.particles.count, s.time);
}

HistoryRow historyRow(const StepReport& r) {
  const Diagnostics& d = r.diagnostics;
  const PhaseSeconds& s = r.seconds;
  HistoryRow row;
  row.step = r.step, row.time = r.time, row.timeStep = r.timeStep;
  row.iterations = r.iterations, row.residual = r.residual, row.fallbacks = r.fallbacks;
  row.kineticEnergy = d.kineticEnergy, row.potentialEnergy = d.potentialEnergy;
  row.frontX = d.frontX, row.top = d.top, row.maxSpeed = d.maxSpeed;
  row.meanDensity = d.meanDensityRatio, row.densityError = d.meanDensityError;
  row.seconds = s.total();
  row.timings = {s.search, s.lists, s.coefficients, s.coarse, s.solve, s.update};
  return row;
}

}  // namespace

template <int D>
Recorder<D>::Recorder(const Case& c, RunDirectory& directory, RunLog& log, double start, bool timings,
                      CopyState copyState)
    : case_(c),
      directory_(directory),
      log_(log),
      copyState_(std::move(copyState)),
      history_(directory.history(), timings),
      frames_(c.output.interval, c.time, start),
      checkpoints_(c.output.checkpointInterval, c.time, start),
      output_([this](const Snapshot<D>& snapshot) { write(snapshot); }) {
  if (c.output.balance) balance_.emplace(directory.balance(), c);
}

template <int D>
void Recorder<D>::begin() {
  handOver(takeSnapshot(), true, false);
}

template <int D>
void Recorder<D>::record(const StepReport& report) {
  if (steps_++ == 0) firstIterations_ = report.iterations;
  lastIterations_ = report.iterations;
  iterations_ += report.iterations;
  fallbacks_ += report.fallbacks;
  seconds_ += report.seconds;
  meanDensity_ = report.diagnostics.meanDensityRatio;
  densityError_ = report.diagnostics.meanDensityError;
  largestDensityError_ = std::max(largestDensityError_, densityError_);
  Timer timer;
  history_.append(historyRow(report));
  if (report.balance) balance_->append(report.step, report.time, *report.balance);
  outputSeconds_ += timer.lap();
  const bool frame = frames_.due(report.time), checkpoint = checkpoints_.due(report.time);
  if (frame || checkpoint) handOver(takeSnapshot(), frame, checkpoint);
}

template <int D>
void Recorder<D>::wait() {
  Timer timer;
  output_.wait();
  outputSeconds_ += timer.lap();
}

template <int D>
void Recorder<D>::writeFrame() {
  wait();
  Snapshot<D>& snapshot = takeSnapshot();
  if (frameStep_ == snapshot.step) return;
  handOver(snapshot, true, false);
  wait();
}

template <int D>
void Recorder<D>::writeCheckpoint() {
  wait();
  Snapshot<D>& snapshot = takeSnapshot();
  if (checkpointStep_ == snapshot.step) return;
  handOver(snapshot, false, true);
  wait();
}

template <int D>
void Recorder<D>::drawPicture() {
  PictureOptions options;
  options.spacing = case_.spacing;
  options.gravity = case_.gravity;
  options.title = case_.title;
  const Snapshot<D>& state = takeSnapshot();
  drawFrame(directory_.finalPicture(), fluidFrame(state), wallsFrame(state), options);
}

template <int D>
void Recorder<D>::summarise(RunSummary& summary) const {
  summary.meanIterations = steps_ > 0 ? static_cast<double>(iterations_) / static_cast<double>(steps_) : 0;
  summary.firstIterations = firstIterations_;
  summary.lastIterations = lastIterations_;
  summary.fallbacks = fallbacks_;
  summary.meanDensity = meanDensity_;
  summary.densityError = densityError_;
  summary.largestDensityError = largestDensityError_;
  summary.phaseSeconds = {
      {"search", seconds_.search}, {"lists", seconds_.lists}, {"coefficients", seconds_.coefficients},
      {"coarse", seconds_.coarse}, {"solve", seconds_.solve}, {"update", seconds_.update},
      {"output", outputSeconds_}};
  summary.outputThreadSeconds = output_.busySeconds();
}

template <int D>
Snapshot<D>& Recorder<D>::takeSnapshot() {
  Timer timer;
  Snapshot<D>& snapshot = output_.next();
  copyState_(snapshot);
  outputSeconds_ += timer.lap();
  return snapshot;
}

template <int D>
void Recorder<D>::handOver(Snapshot<D>& snapshot, bool frame, bool checkpoint) {
  snapshot.iterations = lastIterations_;
  snapshot.frame = frame, snapshot.checkpoint = checkpoint;
  output_.handOver();
}

/// Called by the output thread.
template <int D>
void Recorder<D>::write(const Snapshot<D>& s) {
  const TraceRange range("output");
  if (s.frame) {
    const std::size_t number = directory_.frameCount();
    directory_.writeFrame(fluidFrame(s), wallsFrame(s), case_.output);
    frameStep_ = s.step;
    log_.info(fmt::format("frame {}: step {}, t = {:.6g} s, {} iterations", number, s.step, s.time, s.iterations));
  }
  if (s.checkpoint) {
    treacle::writeCheckpoint(directory_.checkpoint(), s.particles, s.step, s.time);
    checkpointStep_ = s.step;
  }
}

template class Recorder<2>;
template class Recorder<3>;

}  // namespace treacle
