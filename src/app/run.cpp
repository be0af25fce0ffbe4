#include "run.hpp"

#include "interrupt.hpp"
#include "memory.hpp"
#include "pinned_snapshot.hpp"
#include "treacle/core/error.hpp"
#include "treacle/core/peak_memory.hpp"
#include "treacle/io/case/case_reader.hpp"
#include "treacle/io/files/atomic_file.hpp"
#include "treacle/step/method/solve_stages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <new>
#include <system_error>
#include <utility>

namespace treacle {
namespace {

/// HDF5 and the fonts of the picture end the program where they get no memory; they take some 18 MB.
constexpr std::size_t reserveBytes = 24 << 20;

}  // namespace

Run::Run(const Case& c, RunStart start, RunDirectory directory, const RunOptions& options,
         const Communicator& processes)
    : case_(c),
      processes_(processes),
      start_(std::move(start)),
      directory_(std::move(directory)),
      timings_(options.timings),
      log_(directory_.log(), options.quiet),
      progress_(c, start_.state.step, start_.state.time, options.quiet) {
  if (writesPieces(c, start_.particles, static_cast<std::uint64_t>(processes.size())))
    pieces_.emplace(c, directory_, processes);
}

void Run::execute(const std::vector<std::string>& warnings) {
  describe();
  for (const std::string& warning : warnings) log_.warning(warning);
  attempt([&] {
    reserve_ = std::make_unique_for_overwrite<std::byte[]>(reserveBytes);
    writeFile(directory_.caseFile(), caseText(case_));
    simulation_.emplace(case_, std::move(start_.state.particles), start_.backend, start_.state.step,
                        start_.state.time, &processes_);
    if (const std::string link = simulation_->linkName(); !link.empty())
      log_.info("the devices of the processes exchange by " + link);
    Recorder::Source source{[this](Snapshot& s) { copyState(s); },
                            [this](std::uint64_t probes) { return simulation_->measure(probes); }};
    if (pieces_)
      source.orderPieces = [this](PieceOrder order, std::size_t frame) { return orderPieces(order, frame); };
    recorder_.emplace(case_, directory_, log_, start_.state.time, timings_, std::move(source));
    recorder_->begin();
    advanceToEnd();
  });
  finish();
}

void Run::describe() {
  summary_.origin = originOf(case_, onDevice(), start_.device, start_.particles);
  log_.info(fmt::format("treacle {} ({}), backend {}, {}, {} threads of the host{}", summary_.origin.version,
                        summary_.origin.commit, summary_.origin.backend, start_.device, summary_.origin.threads,
                        processes_.size() > 1 ? fmt::format(" in each of {} processes", processes_.size()) : ""));
  say(fmt::format("{}: {} fluid and {} wall particles, {}, into {}", case_.title.empty() ? "case" : case_.title,
                  start_.particles.fluid, start_.particles.wall, stepsText(), directory_.path().string()));
  log_.info("solver: " + solverText(solveStages(case_).front()));
  if (processes_.size() > 1) say(fmt::format("shared by {} processes", processes_.size()));
  if (case_.method.kind == MethodKind::Isph) log_.info("viscous step: " + viscousText(case_));
  if (const StartState& from = start_.state; from.step > 0)
    say(fmt::format("continues after step {} (t = {:.6g} s)", from.step, from.time));
}

std::string Run::stepsText() const {
  const TimeSettings& time = case_.time;
  if (!time.stepsVary()) return fmt::format("{} steps of {:g} s", case_.steps(), time.step);
  if (time.automatic)
    return fmt::format("steps of {:g} to {:g} s, for errors of {:g}, to {:g} s", time.least, time.step,
                       time.tolerance, time.end);
  return fmt::format("steps of at most {:g} s and Courant number {:g} to {:g} s", time.step, time.courant,
                     time.end);
}

void Run::advanceToEnd() {
  while (!atEnd() && !interruptSignal()) {
    const StepReport report = simulation_->advance();
    recorder_->record(report);
    if (report.fallbacks > 0) warnOfFallback(report);
    warnOfArrangement();
    keepWatch(report);
    progress_.update(report);
  }
  if (!atEnd()) throw RunError(fmt::format("stopped by {}", interruptSignal()));
}

void Run::warnOfFallback(const StepReport& report) {
  if (std::exchange(fellBack_, true)) return;
  progress_.endLine();
  log_.warning(
      fmt::format("step {}: the linear solver had to fall back after {}; further steps that do are counted in {}",
                  report.step, report.failures, directory_.history().filename().string()));
}

/// Frames are looked at by the thread that writes them, but the progress line is this one's.
void Run::warnOfArrangement() {
  for (const std::string& warning : recorder_->takeWarnings()) {
    progress_.endLine();
    log_.warning(warning);
  }
}

void Run::keepWatch(const StepReport& report) {
  const Watched& w = report.watched;
  watched_.energy = std::max(watched_.energy, w.energy), watched_.courant = std::max(watched_.courant, w.courant);
  watched_.insideWalls = std::max(watched_.insideWalls, w.insideWalls);
  watched_.density = std::max(watched_.density, w.density);
  if (!report.warnings.empty()) progress_.endLine();
  for (const std::string& text : report.warnings) log_.warning(fmt::format("step {}: {}", report.step, text));
  if (!report.notes.empty()) progress_.endLine();
  for (const std::string& text : report.notes) log_.info(fmt::format("step {}: {}", report.step, text));
}

void Run::copyState(Snapshot& snapshot) {
  if (onDevice()) resizePinned(snapshot, case_.dimensions, simulation_->numbers());
  simulation_->copyParticles(snapshot.particles);
  snapshot.step = simulation_->step();
  snapshot.time = simulation_->time();
}

std::vector<PiecedFrame> Run::orderPieces(PieceOrder order, std::size_t frame) {
  std::vector<PiecedFrame> whole;
  if (order == PieceOrder::Collect && !pieces_->hasNews()) return whole;
  simulation_->everywhere(static_cast<int>(order), static_cast<std::int64_t>(frame),
                          [&](AnySimulation& s, int, std::int64_t) { whole = pieces_->answer(s, order, frame); });
  return whole;
}

void Run::attempt(const std::function<void()>& action) {
  std::string diagnosis;
  try {
    action();
    return;
  } catch (const DeviceMemoryExhausted& e) {
    diagnosis = exhaustedText(e.numbers());
  } catch (const std::bad_alloc&) {
    diagnosis = "memory exhausted";
  } catch (const DeviceFailure& e) {
    diagnosis = fmt::format(
        "{}; nvidia-smi and the system's log (NVRM, Xid) tell whether the device or its driver is at fault",
        e.what());
    isDeviceLost_ = true;
    if (recorder_) recorder_->loseSimulation();
  } catch (const InputError& e) {
    diagnosis = e.what();
    isBadInput_ = failure_.empty() && (!simulation_ || simulation_->step() == start_.state.step);
  } catch (const EndOfRun& e) {
    diagnosis = e.what();
    isOver_ = true;
  } catch (const std::runtime_error& e) {
    diagnosis = e.what();
  }
  if (simulation_)
    diagnosis =
        fmt::format("after step {} (t = {:.6g} s): {}", simulation_->step(), simulation_->time(), diagnosis);
  log_.error(diagnosis);
  if (failure_.empty()) failure_ = diagnosis;
}

void Run::finish() {
  reserve_.reset();
  if (simulation_ && recorder_) {
    attempt([&] { recorder_->wait(); });
    attempt([&] { recorder_->writeCheckpoint(); });
    attempt([&] { recorder_->writeFrame(); });
    warnOfArrangement();
    attempt([&] { recorder_->drawPicture(); });
    summary_.steps = simulation_->step(), summary_.time = simulation_->time();
    recorder_->summarise(summary_);
    if (processes_.size() > 1)
      for (const AnySimulation::Share& s : simulation_->shares())
        summary_.processes.push_back({s.fluidParticles, s.traffic.bytes, s.traffic.calls, s.traffic.seconds,
                                      s.waiting, s.peakBytes, s.peakHostBytes});
    log_.info(
        fmt::format("watch, largest of all steps: energy {:.3g}, courant {:.3g}, inside_walls {:.3g}, density "
                    "{:.3g}",
                    watched_.energy, watched_.courant, watched_.insideWalls, watched_.density));
  }
  if (simulation_ && !isDeviceLost_) attempt([&] { summary_.peakDeviceMemory = simulation_->peakBytes(); });
  summary_.wallSeconds = timer_.lap();
  summary_.peakMemory = peakMemory();
  // After a run that took all memory the summary still needs a little.
  recorder_.reset();
  if (!isDeviceLost_) simulation_.reset();
  summary_.done = failure_.empty();
  summary_.message = failure_;
  attempt([&] { writeSummary(directory_.summary(), summary_); });
  if (isBadInput_) throw InputError(failure_);
  if (!failure_.empty()) throw RunError(failure_ + lastStateText());
  say(fmt::format("done: {} steps{} in {}, {:.1f} iterations per step, {} of memory{}", summary_.steps,
                  case_.time.automatic ? fmt::format(" ({} rejected)", summary_.tally.rejectedSteps) : "",
                  durationText(summary_.wallSeconds), summary_.tally.meanIterations,
                  bytesText(summary_.peakMemory),
                  onDevice() ? fmt::format(", {} of the device's", bytesText(summary_.peakDeviceMemory)) : ""));
  progress_.message(fmt::format("picture: {}\nParaView: {}", directory_.finalPicture().string(),
                                directory_.fluidIndex().string()));
}

std::string Run::lastStateText() const {
  std::string text;
  if (directory_.frameCount() > 0) {
    const std::size_t last = directory_.frameCount() - 1;
    text += fmt::format("\nThe last state written is frame {} (t = {:.6g} s) in {}", last,
                        directory_.frameTime(last), directory_.path().string());
  }
  const bool hasGoneOn = summary_.steps > start_.state.step;  // else it would fail again as it did
  if (std::error_code error; hasGoneOn && !isOver_ && std::filesystem::exists(directory_.checkpoint(), error))
    text += fmt::format("\nContinue from the last checkpoint with --resume {}", directory_.checkpoint().string());
  return text;
}

void Run::say(const std::string& text) {
  log_.info(text);
  progress_.message(text);
}

}  // namespace treacle
