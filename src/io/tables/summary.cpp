#include "treacle/io/tables/summary.hpp"

#include "treacle/io/files/atomic_file.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace treacle {

namespace {

using Json = nlohmann::ordered_json;

/// Least, mean and most of a number of each process.
template <class T>
Json spread(const std::vector<ProcessShare>& processes, T ProcessShare::*number) {
  T least = processes.front().*number, most = least;
  double sum = 0;
  for (const ProcessShare& p : processes) {
    least = std::min(least, p.*number), most = std::max(most, p.*number);
    sum += static_cast<double>(p.*number);
  }
  return {{"least", least}, {"mean", sum / static_cast<double>(processes.size())}, {"most", most}};
}

Json sharesOf(const std::vector<ProcessShare>& processes) {
  return {{"fluid_particles", spread(processes, &ProcessShare::fluidParticles)},
          {"bytes_sent", spread(processes, &ProcessShare::bytesSent)},
          {"exchanges", spread(processes, &ProcessShare::exchanges)},
          {"exchange_seconds", spread(processes, &ProcessShare::exchangeSeconds)},
          {"waiting_seconds", spread(processes, &ProcessShare::waitingSeconds)},
          {"peak_memory", spread(processes, &ProcessShare::peakMemory)},
          {"peak_device_memory", spread(processes, &ProcessShare::peakDeviceMemory)}};
}

}  // namespace

void writeSummary(const std::filesystem::path& path, const RunSummary& s) {
  Json phases = Json::object();
  for (const auto& [phase, seconds] : s.phaseSeconds) phases[phase] = seconds;

  const RunOrigin& origin = s.origin;
  const StepTally& tally = s.tally;
  const FrameTally& frames = s.frames;
  Json json;
  json["status"] = s.done ? "done" : "failed";
  json["message"] = s.message;
  json["title"] = origin.title;
  json["version"] = origin.version;
  json["commit"] = origin.commit;
  json["backend"] = origin.backend;
  json["device"] = origin.device;
  json["threads"] = origin.threads;
  json["processes"] = std::max<std::size_t>(s.processes.size(), 1);
  json["precision"] = origin.precision;
  json["dimensions"] = origin.dimensions;
  json["fluid_particles"] = origin.fluidParticles;
  json["wall_particles"] = origin.wallParticles;
  if (tally.flow)
    json["flow"] = {{"fluid_particles", tally.flow->particles},
                    {"inflow_particles", tally.flow->in},
                    {"outflow_particles", tally.flow->out}};
  json["steps"] = s.steps;
  json["time"] = s.time;
  json["time_step"] = {{"least", tally.leastStep}, {"mean", tally.meanStep}, {"longest", tally.longestStep}};
  json["rejected_steps"] = tally.rejectedSteps;
  json["iterations"] = {
      {"mean", tally.meanIterations}, {"first", tally.firstIterations}, {"last", tally.lastIterations}};
  json["fallbacks"] = tally.fallbacks;
  json["density"] = {
      {"mean", tally.meanDensity}, {"error", tally.densityError}, {"largest_error", tally.largestDensityError}};
  json["density"]["inside"] = frames.arrangement.density ? Json(*frames.arrangement.density) : Json();
  json["nearest_distance"] = {{"least", frames.arrangement.least},
                              {"low", frames.arrangement.low},
                              {"smallest_least", frames.smallestLeast},
                              {"smallest_low", frames.smallestLow}};
  json["seconds_per_phase"] = phases;
  if (!s.processes.empty()) json["shares"] = sharesOf(s.processes);
  json["frames"] = {{"count", frames.count}, {"bytes", frames.cost.bytes}, {"seconds", frames.cost.seconds}};
  json["output_thread_seconds"] = s.outputThreadSeconds;
  json["wall_seconds"] = s.wallSeconds;
  json["peak_memory_bytes"] = s.peakMemory;
  json["peak_device_memory_bytes"] = s.peakDeviceMemory;
  json["memory_bytes_per_fluid_particle"] =
      origin.fluidParticles > 0 ? static_cast<double>(s.peakMemory) / static_cast<double>(origin.fluidParticles)
                                : 0.0;
  // Titles and messages may hold file names in any encoding; they must not cost the summary.
  writeFile(path, json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace treacle
