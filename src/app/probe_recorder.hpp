#pragma once

#include "interval.hpp"
#include "treacle/io/tables/probe_writer.hpp"
#include "treacle/step/run/simulation.hpp"

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <vector>

namespace treacle {

/// Records what the probes of a case read, each at intervals of its own. Errors, of every member: RunError,
/// std::bad_alloc.
class ProbeRecorder {
 public:
  /// AnySimulation::measure.
  using Measure = std::function<std::vector<ProbeReading>(std::uint64_t probes)>;

  /// Where the rows of a probe go.
  using Target = std::function<RowTarget(const Probe&)>;

  /// Replaces what the targets hold. `start`: simulation time at which the run starts [s]. The case must outlive
  /// this.
  ProbeRecorder(const Case& c, const Target& target, double start, Measure measure);

  /// The state at the start. Loads have none.
  void begin();
  /// Records the probes that are due after a step.
  void record(const StepReport& report);

 private:
  /// `step`: null at the start, where it is not known what walls bear.
  void take(std::uint64_t probes, double time, const StepReport* step);
  void meanPatches(const StepReport& step);

  const Case& case_;
  double start_;  // [s]
  Measure measure_;
  std::deque<ProbeWriter> writers_;                 // per probe; they cannot be moved
  std::vector<std::optional<Interval>> intervals_;  // without one: every step
  std::vector<PatchMean> patches_;                  // per probe; of WallPressure since its last reading
};

}  // namespace treacle
