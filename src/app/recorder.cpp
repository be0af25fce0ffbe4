#include "recorder.hpp"

#include "treacle/core/timer.hpp"
#include "treacle/io/checkpoint.hpp"
#include "treacle/io/picture.hpp"

namespace treacle {
namespace {

template <int D>
Frame fluidFrame(const Simulation<D>& s) {
  return makeFrame(s.particles(), 0, s.particles().fluidCount, s.time());
}

template <int D>
Frame wallsFrame(const Simulation<D>& s) {
  return makeFrame(s.particles(), s.particles().fluidCount, s.particles().count, s.time());
}

HistoryRow historyRow(const StepReport& r) {
  const Diagnostics& d = r.diagnostics;
  return {r.step,   r.time, r.iterations, r.residual,       d.kineticEnergy, d.potentialEnergy,
          d.frontX, d.top,  d.maxSpeed,   r.seconds.total()};
}

}  // namespace

template <int D>
void Recorder<D>::record(const StepReport& report, const Simulation<D>& simulation) {
  if (steps_++ == 0) firstIterations_ = report.iterations;
  lastIterations_ = report.iterations;
  iterations_ += report.iterations;
  seconds_ += report.seconds;
  Timer timer;
  history_.append(historyRow(report));
  outputSeconds_ += timer.lap();
  if (frames_.due(report.time)) writeFrame(simulation);
  if (checkpoints_.due(report.time)) writeCheckpoint(simulation);
}

template <int D>
void Recorder<D>::writeFrame(const Simulation<D>& simulation) {
  if (frameStep_ == simulation.step()) return;
  Timer timer;
  directory_.writeFrame(fluidFrame(simulation), wallsFrame(simulation), case_.output);
  frameStep_ = simulation.step();
  outputSeconds_ += timer.lap();
}

template <int D>
void Recorder<D>::writeCheckpoint(const Simulation<D>& simulation) {
  if (checkpointStep_ == simulation.step()) return;
  Timer timer;
  treacle::writeCheckpoint(directory_.checkpoint(), simulation.particles(), simulation.step(), simulation.time());
  checkpointStep_ = simulation.step();
  outputSeconds_ += timer.lap();
}

template <int D>
void Recorder<D>::drawPicture(const Simulation<D>& simulation) const {
  PictureOptions options;
  options.spacing = case_.spacing;
  options.gravity = case_.gravity;
  options.title = case_.title;
  drawFrame(directory_.finalPicture(), fluidFrame(simulation), wallsFrame(simulation), options);
}

template <int D>
void Recorder<D>::summarise(RunSummary& summary) const {
  summary.meanIterations = steps_ > 0 ? static_cast<double>(iterations_) / static_cast<double>(steps_) : 0;
  summary.firstIterations = firstIterations_;
  summary.lastIterations = lastIterations_;
  summary.phaseSeconds = {
      {"search", seconds_.search}, {"lists", seconds_.lists}, {"coefficients", seconds_.coefficients},
      {"coarse", seconds_.coarse}, {"solve", seconds_.solve}, {"update", seconds_.update},
      {"output", outputSeconds_}};
}

template class Recorder<2>;
template class Recorder<3>;

}  // namespace treacle
