#pragma once

#include "gpu_record.hpp"
#include "treacle/model/case/names.hpp"
#include "treacle/model/particles/create.hpp"
#include "treacle/step/run/any_simulation.hpp"

namespace treacle {

/// A run of some steps, of which the last `timed` count.
struct SolveRun {
  int dimensions;
  double resolution;
  int steps, timed;
  PreconditionerKind preconditioner;
  CoarseKind coarse = CoarseKind::Auto;
};

inline void benchmarkSolve(const BenchmarkOptions& options, const SolveRun& run, Record& record) {
  const std::string name =
      fmt::format("solve/{}D x1/{:g}/{}{}/steps {}-{}", run.dimensions, run.resolution, nameOf(run.preconditioner),
                  run.coarse == CoarseKind::Spgemm ? " spgemm" : "", run.steps - run.timed + 1, run.steps);
  if (!options.wants(name)) return;
  // Krylov method and precision follow from the preconditioner.
  Case c = paperCase(options, run.dimensions, run.resolution,
                     {fmt::format("solver.preconditioner={}", nameOf(run.preconditioner))});
  c.solver.multigrid.coarseOperators = run.coarse;
  std::vector<std::string> notes;
  AnySimulation simulation(c, createParticles(c, notes), BackendKind::Cuda);
  const std::uint64_t n = simulation.numbers().fluid, all = n + simulation.numbers().wall;
  PhaseSeconds seconds;
  std::int64_t iterations = 0;
  StepReport last;
  for (int step = 0; step < run.steps; ++step) {
    last = simulation.advance();
    if (step < run.steps - run.timed) continue;
    seconds += last.seconds;
    iterations += last.iterations;
  }
  const double perStep = 1e3 / run.timed;
  const double setup = seconds.search + seconds.lists + seconds.coefficients + seconds.coarse;
  record.json["runs"].push_back({{"name", name},
                                 {"fluid_particles", n},
                                 {"particles", all},
                                 {"iterations", static_cast<double>(iterations) / run.timed},
                                 {"solve_ms", seconds.solve * perStep},
                                 {"step_ms", seconds.total() * perStep},
                                 {"search_ms", seconds.search * perStep},
                                 {"lists_ms", seconds.lists * perStep},
                                 {"coefficients_ms", seconds.coefficients * perStep},
                                 {"coarse_ms", seconds.coarse * perStep},
                                 {"update_ms", seconds.update * perStep},
                                 {"setup_share", setup / seconds.total()},
                                 {"peak_bytes", simulation.peakBytes()},
                                 {"bytes_per_fluid_particle", static_cast<double>(simulation.peakBytes()) / n}});
  fmt::print(
      "{:<56} {:>9} fluid {:>7.1f} iterations, solve {:>9.3f} ms, step {:>9.3f} ms, set-up {:>4.1f} %, "
      "{:.0f} B per particle\n",
      name, n, static_cast<double>(iterations) / run.timed, seconds.solve * perStep, seconds.total() * perStep,
      100 * setup / seconds.total(), static_cast<double>(simulation.peakBytes()) / n);
  std::fflush(stdout);
}

inline void benchmarkSolves(const BenchmarkOptions& options, Record& record) {
  std::vector<SolveRun> runs;
  for (const auto k : {PreconditionerKind::BucketMultigrid, PreconditionerKind::None}) {
    runs.push_back({2, 1, 200, 10, k});
    runs.push_back({2, 2, 400, 10, k});
    runs.push_back({2, 4, 20, 5, k});
    runs.push_back({2, 8, 3, 2, k});
    runs.push_back({2, 16, 2, 1, k});
    runs.push_back({2, 32, 2, 1, k});
    runs.push_back({3, 0.5, 100, 10, k});
    runs.push_back({3, 1, 200, 10, k});
    runs.push_back({3, 2, 2, 1, k});
    runs.push_back({3, 4, 2, 1, k});
  }
  for (const double resolution : {1.0, 4.0, 16.0})
    runs.push_back({2, resolution, 2, 1, PreconditionerKind::BucketMultigrid, CoarseKind::Spgemm});
  for (const double resolution : {1.0, 2.0, 4.0})
    runs.push_back({3, resolution, 2, 1, PreconditionerKind::BucketMultigrid, CoarseKind::Spgemm});
  if (options.largest > 0) runs = {{3, options.largest, 1, 1, PreconditionerKind::BucketMultigrid}};
  for (SolveRun run : runs) {
    if (options.quick) run.steps = run.timed = std::min(run.timed, 2);
    benchmarkSolve(options, run, record);
  }
}

}  // namespace treacle
