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

  Json json;
  json["status"] = s.done ? "done" : "failed";
  json["message"] = s.message;
  json["title"] = s.title;
  json["version"] = s.version;
  json["commit"] = s.commit;
  json["backend"] = s.backend;
  json["device"] = s.device;
  json["threads"] = s.threads;
  json["processes"] = std::max<std::size_t>(s.processes.size(), 1);
  json["precision"] = s.precision;
  json["dimensions"] = s.dimensions;
  json["fluid_particles"] = s.fluidParticles;
  json["wall_particles"] = s.wallParticles;
  if (s.flow)
    json["flow"] = {{"fluid_particles", s.flow->particles},
                    {"inflow_particles", s.flow->in},
                    {"outflow_particles", s.flow->out}};
  json["steps"] = s.steps;
  json["time"] = s.time;
  json["time_step"] = {{"least", s.leastStep}, {"mean", s.meanStep}, {"longest", s.longestStep}};
  json["rejected_steps"] = s.rejectedSteps;
  json["iterations"] = {{"mean", s.meanIterations}, {"first", s.firstIterations}, {"last", s.lastIterations}};
  json["fallbacks"] = s.fallbacks;
  json["density"] = {{"mean", s.meanDensity}, {"error", s.densityError}, {"largest_error", s.largestDensityError}};
  json["density"]["inside"] = s.arrangement.density ? Json(*s.arrangement.density) : Json();
  json["nearest_distance"] = {{"least", s.arrangement.least},
                              {"low", s.arrangement.low},
                              {"smallest_least", s.smallestLeast},
                              {"smallest_low", s.smallestLow}};
  json["seconds_per_phase"] = phases;
  if (!s.processes.empty()) json["shares"] = sharesOf(s.processes);
  json["frames"] = {{"count", s.frames}, {"bytes", s.frameCost.bytes}, {"seconds", s.frameCost.seconds}};
  json["output_thread_seconds"] = s.outputThreadSeconds;
  json["wall_seconds"] = s.wallSeconds;
  json["peak_memory_bytes"] = s.peakMemory;
  json["peak_device_memory_bytes"] = s.peakDeviceMemory;
  json["memory_bytes_per_fluid_particle"] =
      s.fluidParticles > 0 ? static_cast<double>(s.peakMemory) / static_cast<double>(s.fluidParticles) : 0.0;
  // Titles and messages may hold file names in any encoding; they must not cost the summary.
  writeFile(path, json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace treacle
