#pragma once

#include "isph_options.hpp"
#include "solve_record.hpp"
#include "treacle/step/run/any_simulation.hpp"

namespace treacle {

/// Mean seconds per phase of `steps` steps; says what memory the simulation has needed so far.
inline void timePhases(AnySimulation& simulation, const std::string& name, int steps, SolveRecord& record) {
  PhaseSeconds sum;
  int iterations = 0, fallbacks = 0;
  for (int k = 0; k < steps; ++k) {
    const StepReport report = simulation.advance();
    sum += report.seconds;
    iterations += report.iterations;
    fallbacks += report.fallbacks;
  }
  const std::uint64_t fluid = simulation.numbers().fluid, all = fluid + simulation.numbers().wall;
  const double perStep = 1e3 / steps, meanIterations = static_cast<double>(iterations) / steps;
  const double bytes = static_cast<double>(simulation.peakBytes());
  record.json["steps"].push_back({{"system", name},
                                  {"fluid_particles", fluid},
                                  {"particles", all},
                                  {"steps", steps},
                                  {"iterations", meanIterations},
                                  {"fallbacks", fallbacks},
                                  {"step_ms", sum.total() * perStep},
                                  {"search_ms", sum.search * perStep},
                                  {"lists_ms", sum.lists * perStep},
                                  {"coefficients_ms", sum.coefficients * perStep},
                                  {"coarse_ms", sum.coarse * perStep},
                                  {"solve_ms", sum.solve * perStep},
                                  {"update_ms", sum.update * perStep},
                                  {"peak_bytes", simulation.peakBytes()},
                                  {"bytes_per_particle", bytes / all},
                                  {"bytes_per_fluid_particle", bytes / fluid}});
  fmt::print(
      "{:<22} {:>8}  {} steps: {:.3f} ms each, search {:.3f}, lists {:.3f}, coefficients {:.3f}, coarse {:.3f}, "
      "solve "
      "{:.3f}, update {:.3f}; {:.1f} iterations, {:.1f} ns per fluid particle; {:.2f} GB, {:.0f} B per fluid "
      "particle\n",
      name, fluid, steps, sum.total() * perStep, sum.search * perStep, sum.lists * perStep,
      sum.coefficients * perStep, sum.coarse * perStep, sum.solve * perStep, sum.update * perStep, meanIterations,
      sum.total() * 1e9 / steps / fluid, bytes * 1e-9, bytes / fluid);
  std::fflush(stdout);
}

}  // namespace treacle
