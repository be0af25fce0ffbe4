#include "recording.hpp"

#include "run_tally.hpp"
#include "treacle/core/error.hpp"
#include "treacle/core/peak_memory.hpp"
#include "treacle/io/case/case_reader.hpp"
#include "treacle/io/files/atomic_file.hpp"
#include "treacle/io/surface/free_surface.hpp"
#include "treacle/step/method/solve_stages.hpp"

#include <fmt/format.h>

#include <exception>
#include <utility>

namespace treacle {
namespace {

RunDirectory made(const Session& session, const std::filesystem::path& directory, bool force) {
  if (session.isRecorded()) throw InputError("output: another run directory is being written of the same steps");
  if (session.theCase().output.surface && !hasFreeSurface())
    throw InputError("output.surface: " + whyNoFreeSurface());
  return RunDirectory::create(directory, force);
}

}  // namespace

Recording::Recording(Session& session, const std::filesystem::path& directory, bool force)
    : session_(session),
      directory_(made(session, directory, force)),
      log_(directory_.log(), true),
      recorder_(session.theCase(), directory_, log_, session.simulation().time(), true,
                {[this](Snapshot& s) {
                   writeCase();
                   session_.simulation().copyParticles(s.particles);
                   s.step = session_.simulation().step(), s.time = session_.simulation().time();
                 },
                 [this](std::uint64_t probes) { return session_.simulation().measure(probes); }}) {
  summary_.origin =
      originOf(session.theCase(), session.onDevice(), session.device(), session.simulation().numbers());
  log_.info(fmt::format("treacle {} ({}) from Python, backend {}, {}, {} threads of the host",
                        summary_.origin.version, summary_.origin.commit, summary_.origin.backend, session.device(),
                        summary_.origin.threads));
  log_.info("solver: " + solverText(solveStages(session.theCase()).front()));
  writeCase();
  recorder_.begin();
  session_.setRecorded(true);
  isRecording_ = true;
}

/// The case that a checkpoint of now goes on with. What it says of earlier times does not change.
void Recording::writeCase() {
  if (std::exchange(written_, session_.revision()) != session_.revision())
    writeFile(directory_.caseFile(), caseText(session_.theCase()));
}

void Recording::record() {
  const Session::Use use(session_);
  recorder_.record(session_.lastReport());
  for (const std::string& text : session_.lastReport().warnings)
    log_.warning(fmt::format("step {}: {}", session_.lastReport().step, text));
  for (const std::string& text : session_.lastReport().notes)
    log_.info(fmt::format("step {}: {}", session_.lastReport().step, text));
}

/// As much as is possible, whatever goes wrong on the way.
void Recording::finish(const std::string& failure) {
  const Session::Use use(session_, true);
  release();
  std::exception_ptr first;
  summary_.message = failure;
  const auto attempt = [&](auto&& action) {
    try {
      action();
    } catch (const std::exception& e) {
      log_.error(e.what());
      if (!first) first = std::current_exception();
      if (summary_.message.empty()) summary_.message = e.what();
    }
  };
  if (!failure.empty()) log_.error(failure);
  if (session_.isLost()) recorder_.loseSimulation();
  attempt([&] { recorder_.wait(); });
  attempt([&] { recorder_.writeCheckpoint(); });
  attempt([&] { recorder_.writeFrame(); });
  attempt([&] { recorder_.drawPicture(); });
  summary_.steps = session_.simulation().step(), summary_.time = session_.simulation().time();
  recorder_.summarise(summary_);
  if (!session_.isLost()) attempt([&] { summary_.peakDeviceMemory = session_.simulation().peakBytes(); });
  summary_.wallSeconds = timer_.lap();
  summary_.peakMemory = peakMemory();
  summary_.done = summary_.message.empty();
  attempt([&] { writeSummary(directory_.summary(), summary_); });
  if (first) std::rethrow_exception(first);
}

}  // namespace treacle
