#pragma once

#include "commands.hpp"
#include "interrupt.hpp"
#include "machine.hpp"
#include "memory.hpp"
#include "pinned_snapshot.hpp"
#include "progress.hpp"
#include "recorder.hpp"
#include "run_log.hpp"
#include "treacle/core/error.hpp"
#include "treacle/core/timer.hpp"
#include "treacle/core/version.hpp"
#include "treacle/io/atomic_file.hpp"
#include "treacle/io/case_reader.hpp"
#include "treacle/io/checkpoint.hpp"
#include "treacle/model/names.hpp"
#include "treacle/step/solve_stages.hpp"

#include <fmt/format.h>
#include <omp.h>

#include <functional>
#include <new>
#include <optional>
#include <type_traits>
#include <utility>

namespace treacle {

/// One run from the first frame to the summary. Whatever goes wrong on the way, the last good state (checkpoint
/// and frame), the picture and the summary are still written as far as that is possible.
template <int D, class Backend>
class Run {
 public:
  /// `device`: its name for the user.
  Run(const Case& c, Checkpoint<D> start, RunDirectory directory, const RunOptions& options, std::string device)
      : case_(c),
        device_(std::move(device)),
        start_(std::move(start)),
        directory_(std::move(directory)),
        timings_(options.timings),
        log_(directory_.log(), options.quiet),
        progress_(c, start_.step, start_.time, options.quiet) {}

  /// Errors: RunError with the diagnosis, after everything is written.
  void execute(const std::vector<std::string>& warnings) {
    describe(start_.particles);
    for (const std::string& warning : warnings) log_.warning(warning);
    attempt([&] {
      writeFile(directory_.caseFile(), caseText(case_));
      simulation_.emplace(case_, std::move(start_.particles), start_.step, start_.time);
      recorder_.emplace(case_, directory_, log_, start_.time, timings_, [this](Snapshot<D>& s) { copyState(s); });
      recorder_->begin();
      advanceToEnd();
    });
    finish();
  }

 private:
  void describe(const Particles<D>& particles) {
    const BuildInfo build = buildInfo();
    summary_.version = build.version, summary_.commit = build.commit;
    summary_.backend = onDevice ? "cuda" : "cpu", summary_.device = device_;
    summary_.threads = omp_get_max_threads();
    summary_.precision = nameOf(case_.solver.precision);
    summary_.title = case_.title;
    summary_.dimensions = D;
    summary_.fluidParticles = particles.fluidCount, summary_.wallParticles = particles.wallCount();
    log_.info(fmt::format("treacle {} ({}), backend {}, {}, {} threads of the host", build.version, build.commit,
                          summary_.backend, device_, summary_.threads));
    say(fmt::format("{}: {} fluid and {} wall particles, {}, into {}", case_.title.empty() ? "case" : case_.title,
                    particles.fluidCount, particles.wallCount(), stepsText(), directory_.path().string()));
    log_.info("solver: " + solverText(solveStages(case_).front()));
    if (case_.method.kind == MethodKind::Isph) log_.info("viscous step: " + viscousText(case_));
    if (start_.step > 0) say(fmt::format("continues after step {} (t = {:.6g} s)", start_.step, start_.time));
  }

  std::string stepsText() const {
    const TimeSettings& time = case_.time;
    if (!time.stepsVary()) return fmt::format("{} steps of {:g} s", case_.steps(), time.step);
    return fmt::format("steps of at most {:g} s and Courant number {:g} to {:g} s", time.step, time.courant,
                       time.end);
  }

  bool atEnd() const { return case_.atEnd(simulation_->step(), simulation_->time()); }

  void advanceToEnd() {
    while (!atEnd() && !interruptSignal()) {
      const StepReport report = simulation_->advance();
      recorder_->record(report);
      if (report.fallbacks > 0) warnOfFallback(report);
      progress_.update(report);
    }
    if (!atEnd()) throw RunError(fmt::format("stopped by {}", interruptSignal()));
  }

  void warnOfFallback(const StepReport& report) {
    if (std::exchange(fellBack_, true)) return;
    progress_.endLine();
    log_.warning(fmt::format(
        "step {}: the linear solver had to fall back after {}; further steps that do are counted in {}",
        report.step, report.failures, directory_.history().filename().string()));
  }

  void copyState(Snapshot<D>& snapshot) {
    if constexpr (onDevice)
      resizePinned(snapshot, simulation_->particles().fluidCount, simulation_->particles().wallCount(),
                   simulation_->particles().modeCount());
    simulation_->copyParticles(snapshot.particles);
    snapshot.step = simulation_->step();
    snapshot.time = simulation_->time();
  }

  /// Keeps the diagnosis of the first thing that goes wrong.
  void attempt(const std::function<void()>& action) {
    std::string diagnosis;
    try {
      action();
      return;
    } catch (const DeviceMemoryExhausted& e) {
      diagnosis = fmt::format("device memory exhausted: {} in use at the peak, {} on the device",
                              bytesText(e.peakBytes()), bytesText(e.totalBytes()));
    } catch (const std::bad_alloc&) {
      diagnosis = "memory exhausted";
    } catch (const std::runtime_error& e) {
      diagnosis = e.what();
    }
    if (simulation_)
      diagnosis =
          fmt::format("after step {} (t = {:.6g} s): {}", simulation_->step(), simulation_->time(), diagnosis);
    log_.error(diagnosis);
    if (failure_.empty()) failure_ = diagnosis;
  }

  void finish() {
    if (simulation_ && recorder_) {
      attempt([&] { recorder_->wait(); });
      attempt([&] { recorder_->writeCheckpoint(); });
      attempt([&] { recorder_->writeFrame(); });
      attempt([&] { recorder_->drawPicture(); });
      summary_.steps = simulation_->step(), summary_.time = simulation_->time();
      recorder_->summarise(summary_);
    }
    if (simulation_) attempt([&] { summary_.peakDeviceMemory = simulation_->peakBytes(); });
    summary_.wallSeconds = timer_.lap();
    summary_.peakMemory = peakMemory();
    summary_.done = failure_.empty();
    summary_.message = failure_;
    attempt([&] { writeSummary(directory_.summary(), summary_); });
    if (!failure_.empty()) throw RunError(failure_ + lastStateText());
    say(fmt::format("done: {} steps in {}, {:.1f} iterations per step, {} of memory{}", summary_.steps,
                    durationText(summary_.wallSeconds), summary_.meanIterations, bytesText(summary_.peakMemory),
                    onDevice ? fmt::format(", {} of the device's", bytesText(summary_.peakDeviceMemory)) : ""));
    progress_.message(fmt::format("picture: {}\nParaView: {}", directory_.finalPicture().string(),
                                  directory_.fluidIndex().string()));
  }

  std::string lastStateText() const {
    std::string text;
    if (directory_.frameCount() > 0) {
      const std::size_t last = directory_.frameCount() - 1;
      text += fmt::format("\nThe last state written is frame {} (t = {:.6g} s) in {}", last,
                          directory_.frameTime(last), directory_.path().string());
    }
    if (std::filesystem::exists(directory_.checkpoint()))
      text +=
          fmt::format("\nContinue from the last checkpoint with --resume {}", directory_.checkpoint().string());
    return text;
  }

  void say(const std::string& text) {
    log_.info(text);
    progress_.message(text);
  }

  static constexpr bool onDevice = std::is_same_v<Backend, Cuda>;

  Timer timer_;
  const Case& case_;
  std::string device_;
  Checkpoint<D> start_;
  RunDirectory directory_;
  bool timings_;
  RunLog log_;
  Progress progress_;
  std::optional<Simulation<D, Backend>> simulation_;
  std::optional<Recorder<D>> recorder_;
  RunSummary summary_;
  std::string failure_;
  bool fellBack_ = false;
};

}  // namespace treacle
