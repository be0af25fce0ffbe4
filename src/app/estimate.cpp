#include "estimate.hpp"

#include "print.hpp"
#include "progress.hpp"
#include "treacle/core/error.hpp"
#include "treacle/core/timer.hpp"
#include "treacle/step/any_simulation.hpp"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace treacle {
namespace {

constexpr int warmUp = 2;             // steps that do not count: memory is taken, and solves begin without a guess
constexpr int fewest = 5, most = 50;  // steps that do
constexpr double enough = 5;          // seconds that they take if there are more than the fewest
// What whole runs took per step, over the mean of the steps that were timed (docs/choosing.md).
constexpr double leastFactor = 0.6, mostFactor = 2;

struct Timed {
  int steps = 0, iterations = 0, rejected = 0;
  double seconds = 0, shortest = 0, longest = 0;

  void add(const StepReport& report, double wall) {
    shortest = steps == 0 ? wall : std::min(shortest, wall), longest = std::max(longest, wall);
    ++steps, seconds += wall, iterations += report.iterations, rejected += report.rejected;
  }
  double mean() const { return seconds / steps; }
};

/// Steps from now on.
double stepsLeft(const Case& c, const AnySimulation& simulation, double length) {
  if (!c.time.stepsVary()) return static_cast<double>(c.steps() - simulation.step());
  return std::ceil((c.time.end - simulation.time()) / length * (1 - 1e-9));
}

}  // namespace

void printEstimate(const Case& c, AnyParticles particles, BackendKind backend) {
  Timer timer;
  AnySimulation simulation(c, std::move(particles), backend);
  double before = timer.lap();
  Timed timed;
  double length = c.time.step;
  const auto atEnd = [&] { return c.atEnd(simulation.step(), simulation.time()); };
  while (!atEnd() && (timed.steps < fewest || (timed.steps < most && timed.seconds < enough))) {
    const bool counts = simulation.step() >= warmUp;
    StepReport report;
    try {
      report = simulation.advance();
    } catch (const RunError& error) {
      throw RunError(
          fmt::format("after step {} (t = {:.6g} s): {}", simulation.step(), simulation.time(), error.what()));
    }
    length = report.timeStep;
    const double wall = timer.lap();
    if (counts)
      timed.add(report, wall);
    else
      before += wall;
  }
  if (atEnd()) {
    print("# run time: {}, without output; these are all {} steps of the case\n",
          durationText(before + timed.seconds), simulation.step());
    return;
  }
  const double left = stepsLeft(c, simulation, c.time.stepsVary() ? length : c.time.step);
  const double done = before + timed.seconds, whole = done + left * timed.mean();
  print("# timed: {} steps of {:.3g} s ({:.2g} to {:.2g}), {:.1f} iterations each, after {:.2g} s for the start\n",
        timed.steps, timed.mean(), timed.shortest, timed.longest,
        static_cast<double>(timed.iterations) / timed.steps, before);
  print(
      "# run time: about {} on {} for {}{:.0f} steps, without output; {} to {} as solves become harder or "
      "easier\n",
      durationText(whole),
      backend == BackendKind::Cuda ? "the GPU" : fmt::format("{} threads", omp_get_max_threads()),
      c.time.stepsVary() ? "some " : "", static_cast<double>(simulation.step()) + left,
      durationText(done + leastFactor * left * timed.mean()),
      durationText(done + mostFactor * left * timed.mean()));
}

}  // namespace treacle
