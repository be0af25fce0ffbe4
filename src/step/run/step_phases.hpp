#pragma once

#include "treacle/core/phase_clock.hpp"
#include "treacle/core/trace.hpp"
#include "treacle/step/run/simulation.hpp"

#include <vector>

namespace treacle {

/// A phase of a step: where its seconds are added, and what a profiler calls it.
struct Phase {
  double PhaseSeconds::*seconds;
  const char* name;
};
namespace phases {
inline constexpr Phase search{&PhaseSeconds::search, "search"};
inline constexpr Phase lists{&PhaseSeconds::lists, "lists"};
inline constexpr Phase coefficients{&PhaseSeconds::coefficients, "coefficients"};
inline constexpr Phase coarse{&PhaseSeconds::coarse, "coarse operators"};
inline constexpr Phase solve{&PhaseSeconds::solve, "solve"};
inline constexpr Phase update{&PhaseSeconds::update, "update"};
}  // namespace phases

/// Takes the times of a step's phases. One may come several times.
template <class Backend>
class StepPhases {
 public:
  void start(Context<Backend>& context) {
    phases_.clear();
    clock_.start(context);
  }
  /// Does the work of a phase.
  template <class F>
  void run(Context<Backend>& context, const Phase& phase, F&& work) {
    const TraceRange range(phase.name);
    work();
    clock_.mark(context);
    phases_.push_back(phase);
  }
  /// Since start(); waits for the end of the last phase.
  PhaseSeconds seconds() {
    PhaseSeconds sum;
    const std::vector<double>& laps = clock_.seconds();
    for (std::size_t k = 0; k < phases_.size(); ++k) sum.*phases_[k].seconds += laps[k];
    return sum;
  }

 private:
  PhaseClock<Backend> clock_;
  std::vector<Phase> phases_;
};

}  // namespace treacle
