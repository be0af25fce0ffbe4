#include "estimate.hpp"

#include "print.hpp"
#include "progress.hpp"
#include "treacle/core/error.hpp"
#include "treacle/core/timer.hpp"
#include "treacle/step/run/any_simulation.hpp"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

namespace treacle {
namespace {

constexpr int warmUp = 2;  // steps that do not count: memory is taken, and solves begin without a guess
constexpr std::size_t fewest = 5, most = 50;  // steps that do
constexpr double enough = 5;                  // seconds that they take if there are more than the fewest
// What whole runs took per step, over the mean of the steps that were timed (docs/command.md).
constexpr double leastFactor = 0.6, mostFactor = 2;

/// Steps that were timed.
struct Timed {
  std::vector<double> seconds, particles;  // of each; the latter of fluid
  int iterations = 0;

  double sum() const { return std::accumulate(seconds.begin(), seconds.end(), 0.0); }
};

/// The mean of the later half: solves become easier from step to step, since first guesses become better.
double laterMean(const std::vector<double>& values) {
  const std::size_t half = values.size() / 2;
  return std::accumulate(values.begin() + static_cast<std::ptrdiff_t>(half), values.end(), 0.0) /
         static_cast<double>(values.size() - half);
}

/// By how much more particles the coming steps have than those that were timed, where fluid comes in as it has.
double growth(const Case& c, const StepReport& now, const Timed& timed) {
  if (!now.flow || now.time <= 0) return 1;
  const double net = static_cast<double>(now.flow->in.particles) - static_cast<double>(now.flow->out.particles);
  const double coming = std::max(0.0, net) / now.time * (c.time.end - now.time);
  return (timed.particles.back() + coming / 2) / std::max(1.0, laterMean(timed.particles));
}

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
  StepReport report;
  const auto atEnd = [&] { return c.atEnd(simulation.step(), simulation.time()); };
  const auto timedEnough = [&] {
    const std::size_t steps = timed.seconds.size();
    return steps >= most || (steps >= fewest && timed.sum() >= enough);
  };
  while (!atEnd() && !timedEnough()) {
    const bool counts = simulation.step() >= warmUp;
    try {
      report = simulation.advance();
    } catch (const RunError& error) {
      throw RunError(
          fmt::format("after step {} (t = {:.6g} s): {}", simulation.step(), simulation.time(), error.what()));
    }
    const double wall = timer.lap();
    if (!counts) {
      before += wall;
      continue;
    }
    timed.seconds.push_back(wall), timed.iterations += report.iterations;
    timed.particles.push_back(static_cast<double>(simulation.numbers().fluid));
  }
  if (atEnd()) {
    print("# run time: {}, without output; these are all {} steps of the case\n",
          durationText(before + timed.sum()), simulation.step());
    return;
  }
  const double left = stepsLeft(c, simulation, report.timeStep), perStep = laterMean(timed.seconds);
  const double done = before + timed.sum(), rest = left * perStep * growth(c, report, timed);
  const auto [shortest, longest] = std::ranges::minmax(timed.seconds);
  print("# timed: {} steps of {:.2g} to {:.2g} s, {:.3g} s in the later half, {:.1f} iterations each\n",
        timed.seconds.size(), shortest, longest, perStep,
        timed.iterations / static_cast<double>(timed.seconds.size()));
  const std::string machine =
      backend == BackendKind::Cuda ? "the GPU" : fmt::format("{} threads", omp_get_max_threads());
  print(
      "# run time: about {} on {} for {}{:.0f} steps, without output; from {} to {} as solves become easier or "
      "harder\n",
      durationText(done + rest), machine, c.time.stepsVary() ? "some " : "",
      static_cast<double>(simulation.step()) + left, durationText(done + leastFactor * rest),
      durationText(done + mostFactor * rest));
}

}  // namespace treacle
