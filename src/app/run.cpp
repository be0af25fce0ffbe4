#include "commands.hpp"
#include "interrupt.hpp"
#include "machine.hpp"
#include "memory.hpp"
#include "progress.hpp"
#include "recorder.hpp"
#include "resume.hpp"
#include "run_log.hpp"
#include "treacle/core/error.hpp"
#include "treacle/core/timer.hpp"
#include "treacle/core/version.hpp"
#include "treacle/io/atomic_file.hpp"
#include "treacle/io/case_reader.hpp"
#include "treacle/model/checks.hpp"
#include "treacle/model/create.hpp"
#include "treacle/model/names.hpp"

#include <fmt/format.h>
#include <omp.h>

#include <functional>
#include <new>
#include <optional>

namespace treacle {
namespace {

/// One run from the first frame to the summary. Whatever goes wrong on the way, the last good state (checkpoint
/// and frame), the picture and the summary are still written as far as that is possible.
template <int D>
class Run {
 public:
  Run(const Case& c, Checkpoint<D> start, RunDirectory directory, const RunOptions& options)
      : case_(c),
        start_(std::move(start)),
        directory_(std::move(directory)),
        timings_(options.timings),
        log_(directory_.log(), options.quiet),
        progress_(start_.step, c.steps(), options.quiet) {}

  /// Errors: RunError with the diagnosis, after everything is written.
  void execute(const std::vector<std::string>& warnings) {
    describe(start_.particles);
    for (const std::string& warning : warnings) log_.warning(warning);
    attempt([&] {
      writeFile(directory_.caseFile(), caseText(case_));
      simulation_.emplace(case_, std::move(start_.particles), start_.step, start_.time);
      recorder_.emplace(case_, directory_, log_, start_.time, timings_);
      recorder_->begin(*simulation_);
      advanceToEnd();
    });
    finish();
  }

 private:
  void describe(const Particles<D>& particles) {
    const BuildInfo build = buildInfo();
    summary_.version = build.version, summary_.commit = build.commit;
    summary_.backend = "cpu", summary_.device = processorName();
    summary_.threads = omp_get_max_threads();
    summary_.precision = nameOf(case_.solver.precision);
    summary_.title = case_.title;
    summary_.dimensions = D;
    summary_.fluidParticles = particles.fluidCount, summary_.wallParticles = particles.wallCount();
    log_.info(fmt::format("treacle {} ({}), {} threads on {}", build.version, build.commit, summary_.threads,
                          summary_.device));
    say(fmt::format("{}: {} fluid and {} wall particles, {} steps of {:g} s, into {}",
                    case_.title.empty() ? "case" : case_.title, particles.fluidCount, particles.wallCount(),
                    case_.steps(), case_.time.step, directory_.path().string()));
    if (start_.step > 0) say(fmt::format("continues after step {} (t = {:.6g} s)", start_.step, start_.time));
  }

  void advanceToEnd() {
    while (simulation_->step() < case_.steps() && !interruptSignal()) {
      const StepReport report = simulation_->advance();
      recorder_->record(report, *simulation_);
      progress_.update(report);
    }
    if (simulation_->step() < case_.steps()) throw RunError(fmt::format("stopped by {}", interruptSignal()));
  }

  /// Keeps the diagnosis of the first thing that goes wrong.
  void attempt(const std::function<void()>& action) {
    std::string diagnosis;
    try {
      action();
      return;
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
      attempt([&] { recorder_->writeCheckpoint(*simulation_); });
      attempt([&] { recorder_->writeFrame(*simulation_); });
      attempt([&] { recorder_->drawPicture(*simulation_); });
      summary_.steps = simulation_->step(), summary_.time = simulation_->time();
      recorder_->summarise(summary_);
    }
    summary_.wallSeconds = timer_.lap();
    summary_.peakMemory = peakMemory();
    summary_.done = failure_.empty();
    summary_.message = failure_;
    attempt([&] { writeSummary(directory_.summary(), summary_); });
    if (!failure_.empty()) throw RunError(failure_ + lastStateText());
    say(fmt::format("done: {} steps in {}, {:.1f} iterations per step, {} of memory", summary_.steps,
                    durationText(summary_.wallSeconds), summary_.meanIterations, bytesText(summary_.peakMemory)));
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

  Timer timer_;
  const Case& case_;
  Checkpoint<D> start_;
  RunDirectory directory_;
  bool timings_;
  RunLog log_;
  Progress progress_;
  std::optional<Simulation<D>> simulation_;
  std::optional<Recorder<D>> recorder_;
  RunSummary summary_;
  std::string failure_;
};

Case caseOf(const RunOptions& options) {
  Case c = readCase(options.input.file, options.input.overrides);
  if (options.precision) c.solver.precision = *options.precision;
  if (options.endTime) {
    c.time.end = *options.endTime;
    if (c.steps() < 1)
      throw InputError(
          fmt::format("--end-time: expected at least one step of {:g} s, found {:g}", c.time.step, c.time.end));
  }
  return c;
}

/// --force would remove the checkpoint before another one exists.
void requireElsewhere(const std::filesystem::path& directory, const std::filesystem::path& checkpoint) {
  using std::filesystem::weakly_canonical;
  if (!checkpoint.empty() && weakly_canonical(checkpoint).parent_path() == weakly_canonical(directory))
    throw InputError(fmt::format("--resume {}: lies in the run directory; choose another one with --output",
                                 checkpoint.string()));
}

template <int D>
void runCase(const Case& c, const RunOptions& options) {
  std::vector<std::string> warnings;
  Checkpoint<D> start{createParticles<D>(c, warnings)};
  for (std::string& warning : caseWarnings(c)) warnings.push_back(std::move(warning));
  requireMemory(c, start.particles.fluidCount, start.particles.wallCount());
  const auto directory = options.directory.empty() ? options.input.file.stem().concat("-run") : options.directory;
  requireElsewhere(directory, options.resume);
  if (!options.resume.empty()) start = resumedState<D>(c, options.resume, start.particles);
  catchInterrupts();
  Run<D> run(c, std::move(start), RunDirectory::create(directory, options.force), options);
  run.execute(warnings);
}

}  // namespace

void runCommand(const RunOptions& options) {
  if (options.backend == BackendChoice::Cuda)
    throw InputError("--backend cuda: MPH-I runs on the CPU in this version; expected 'auto' or 'cpu'");
  if (options.threads > 0) omp_set_num_threads(options.threads);
  const Case c = caseOf(options);
  c.dimensions == 2 ? runCase<2>(c, options) : runCase<3>(c, options);
}

}  // namespace treacle
