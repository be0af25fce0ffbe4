#pragma once

#include "treacle/io/tables/summary.hpp"
#include "treacle/model/case/case.hpp"
#include "treacle/model/particles/particles.hpp"
#include "treacle/step/run/simulation.hpp"

#include <cstdint>
#include <string>

namespace treacle {

/// What is known of a run before its first step. `device`: its name for the user.
RunOrigin originOf(const Case& c, bool onDevice, const std::string& device, const ParticleNumbers& particles);

/// Adds up the reports of a run's steps for its summary.
class RunTally {
 public:
  void add(const StepReport& report);

  std::int64_t steps() const { return steps_; }
  std::int64_t lastStep() const { return lastStep_; }  // -1 before the first report
  int lastIterations() const { return tally_.lastIterations; }
  const StepTally& tally() const { return tally_; }
  const PhaseSeconds& seconds() const { return seconds_; }

 private:
  std::int64_t steps_ = 0, lastStep_ = -1, iterations_ = 0;
  double time_ = 0;  // of all steps [s]
  StepTally tally_;
  PhaseSeconds seconds_;
};

}  // namespace treacle
