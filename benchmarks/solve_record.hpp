#pragma once

#include "gpu_record.hpp"

#include <algorithm>
#include <exception>
#include <string>
#include <vector>

namespace treacle {

struct SolveOptions : BenchmarkOptions {
  std::string states;                      // directory of files of study_state.py
  std::string checkpoint, checkpointCase;  // a late state of a run, and its case
  std::vector<std::string> solvers;        // settings of treacle's solver; empty: the default list
  std::vector<double> sizes2, sizes3;      // resolutions of the dam breaks
  int steps = 0;                           // that the dam breaks are run before the system is taken
  int repetitions = 3;
  double tolerance = 1e-12;  // of all methods
  int maxIterations = 20000;
};

inline double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

/// One method on one system.
struct SolveResult {
  std::string system, method;
  std::uint64_t fluidCount = 0;
  int iterations = 0;
  bool converged = false;
  double solveSeconds = 0;       // from the first guess to the solution, the recording of a graph included
  double iterationSeconds = 0;   // the same without recording; 0: not known
  double setupSeconds = 0;       // from the neighbour lists on: matrix or operator, preconditioner
  double matrixSeconds = 0;      // the matrix' part of these; 0: not known
  double bytesPerIteration = 0;  // that the method must move; 0: not counted
  double trueResidual = 0;       // |b - A u| / |b| with the assembled matrix
  std::string how;               // libraries, kind of loop
};

/// What a run of the benchmark leaves behind.
struct SolveRecord {
  nlohmann::ordered_json json;
  bool failed = false;
  double copyBandwidth = 0;  // [B/s]; 0: not measured

  void heading() const {
    fmt::print("{:<22} {:>8}  {:<44} {:>6} {:>10} {:>10} {:>10} {:>9}\n", "system", "fluid", "method", "its",
               "solve ms", "its. ms", "set-up ms", "residual");
  }
  void add(const SolveResult& r) {
    json["solves"].push_back({{"system", r.system},
                              {"fluid_particles", r.fluidCount},
                              {"method", r.method},
                              {"converged", r.converged},
                              {"iterations", r.iterations},
                              {"solve_ms", r.solveSeconds * 1e3},
                              {"iterations_ms", r.iterationSeconds * 1e3},
                              {"setup_ms", r.setupSeconds * 1e3},
                              {"true_residual", r.trueResidual},
                              {"how", r.how}});
    if (r.matrixSeconds > 0) json["solves"].back()["matrix_ms"] = r.matrixSeconds * 1e3;
    const double share = shareOfCopy(r);
    if (share > 0) {
      json["solves"].back()["bytes_per_iteration"] = r.bytesPerIteration;
      json["solves"].back()["share_of_copy_bandwidth"] = share;
    }
    fmt::print("{:<22} {:>8}  {:<44} {:>6} {:>10.3f} {:>10.3f} {:>10.3f} {:>9.1e}{}{}\n", r.system, r.fluidCount,
               r.method, r.iterations, r.solveSeconds * 1e3, r.iterationSeconds * 1e3, r.setupSeconds * 1e3,
               r.trueResidual, share > 0 ? fmt::format("  {:.0f} % of copy", 100 * share) : "",
               r.converged ? "" : "  NOT CONVERGED");
    std::fflush(stdout);
    failed |= !r.converged;
  }
  void addFailure(const std::string& system, const std::string& method, const std::string& why) {
    json["failures"].push_back({{"system", system}, {"method", method}, {"error", why}});
    fmt::print("{:<22} {:>8}  {:<44} FAILED: {}\n", system, "", method, why);
    std::fflush(stdout);
    failed = true;
  }

 private:
  double shareOfCopy(const SolveResult& r) const {
    if (copyBandwidth == 0 || r.iterationSeconds == 0) return 0;
    return r.bytesPerIteration * r.iterations / r.iterationSeconds / copyBandwidth;
  }
};

/// A system that cannot be made fails alone.
template <class F>
void guarded(const std::string& name, SolveRecord& record, F&& work) {
  try {
    work();
  } catch (const std::exception& error) {
    record.addFailure(name, "(all)", error.what());
  }
}

/// Median device seconds of `work`, after one call that warms up.
template <class F>
double medianSeconds(Context<Cuda>& context, int repetitions, F&& work) {
  PhaseClock<Cuda> clock;
  std::vector<double> seconds;
  for (int k = 0; k <= repetitions; ++k) {
    clock.start(context);
    work();
    clock.mark(context);
    seconds.push_back(clock.seconds()[0]);
  }
  return median({seconds.begin() + 1, seconds.end()});
}

/// One method on one system: solve(result) fills in what it finds, trueResidual() looks at the solution. A method
/// that cannot be tried fails alone.
template <class Solve, class Residual>
void attempt(const BenchmarkOptions& options, SolveRecord& record, SolveResult result, Solve&& solve,
             Residual&& trueResidual) {
  if (!options.wants(result.system + "/" + result.method)) return;
  try {
    solve(result);
    result.trueResidual = trueResidual();
    record.add(result);
  } catch (const std::exception& error) {
    record.addFailure(result.system, result.method, error.what());
  }
}

}  // namespace treacle
