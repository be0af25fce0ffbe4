#pragma once

#include "treacle/io/frames/arrangement.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace treacle {

/// What one of several processes had to do.
struct ProcessShare {
  std::uint64_t fluidParticles = 0;  // at the end
  std::uint64_t bytesSent = 0, exchanges = 0;
  double exchangeSeconds = 0;          // in which it exchanged, or waited for others to [s]
  double waitingSeconds = 0;           // of these, where devices know [s]
  std::uint64_t peakDeviceMemory = 0;  // [B]
  std::uint64_t peakMemory = 0;        // [B]
};

/// What writing frames takes.
struct FrameCost {
  std::uint64_t bytes = 0;  // of their files
  double seconds = 0;       // of the writing thread; where each process writes pieces of the slowest one's [s]

  FrameCost& operator+=(const FrameCost& other) {
    bytes += other.bytes, seconds += other.seconds;
    return *this;
  }
};

/// Program, machine and case of a run.
struct RunOrigin {
  std::string version, commit;
  std::string backend;    // "cpu" or "cuda"
  std::string device;     // name of the processor or accelerator
  int threads = 0;        // of the host, of each process
  std::string precision;  // "double" or "mixed"
  std::string title;      // of the case
  int dimensions = 0;
  std::uint64_t fluidParticles = 0, wallParticles = 0;  // at the start of the run
};

/// Sums and extremes over the steps of a run.
struct StepTally {
  double leastStep = 0, meanStep = 0, longestStep = 0;  // [s]
  std::int64_t rejectedSteps = 0;                       // automatic ones that were repeated with shorter ones
  double meanIterations = 0;
  int firstIterations = 0, lastIterations = 0;
  std::int64_t fallbacks = 0;                // of the linear solver, all steps together
  double meanDensity = 0, densityError = 0;  // of the last step, as in the history
  double largestDensityError = 0;            // of all steps
  struct Flow {
    std::uint64_t particles = 0, in = 0, out = 0;  // at the end; since the start of the case
  };
  std::optional<Flow> flow{};  // of a case where fluid comes or goes
};

/// Sums and extremes over the frames of a run.
struct FrameTally {
  std::uint64_t count = 0;                                          // of those written
  FrameCost cost;                                                   // of all
  Arrangement arrangement;                                          // of the last one
  double smallestLeast = nearestReach, smallestLow = nearestReach;  // of all
};

/// What a run was and what it took: `summary.json`.
struct RunSummary {
  RunOrigin origin;
  std::int64_t steps = 0;
  double time = 0;  // simulation time reached [s]
  StepTally tally;
  FrameTally frames;
  std::vector<ProcessShare> processes;  // that shared the run, if there were several
  std::vector<std::pair<std::string, double>>
      phaseSeconds;                    // wall-clock time by phase, in the order of a step [s]
  double outputThreadSeconds = 0;      // writing frames and checkpoints beside the computation [s]
  double wallSeconds = 0;              // of the whole run [s]
  std::uint64_t peakMemory = 0;        // of the host [B]
  std::uint64_t peakDeviceMemory = 0;  // of the accelerator [B]; 0 on the CPU

  bool done = false;    // status "done" or "failed"
  std::string message;  // diagnosis of a run that failed
};

/// Errors: RunError if the file cannot be written.
void writeSummary(const std::filesystem::path& path, const RunSummary& summary);

}  // namespace treacle
