#include "treacle/io/case/case_reader.hpp"
#include "treacle/model/particles/create.hpp"
#include "treacle/step/run/any_simulation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace treacle {
namespace {

/// What automatic steps are worth: their errors in time against the tolerance, and equal steps of the same error.
struct Outcome {
  std::vector<double> values;  // at the times asked for
  int steps = 0, rejected = 0;
};

using Measure = double (*)(const Diagnostics&);

/// Runs a case to the last of the times, all of which are multiples of the interval of its frames.
Outcome run(const std::string& file, std::vector<std::string> settings, const std::vector<double>& times,
            Measure measure) {
  const Case c = readCase(std::string(TREACLE_CASES) + "/../" + file, settings);
  std::vector<std::string> notes;
  AnySimulation simulation(c, createParticles(c, notes));
  Outcome o;
  while (o.values.size() < times.size()) {
    const StepReport report = simulation.advance();
    ++o.steps, o.rejected += report.rejected;
    if (std::abs(report.time - times[o.values.size()]) < 1e-9) o.values.push_back(measure(report.diagnostics));
  }
  return o;
}

/// Largest difference, as a part of what the values have come to from where they started.
double largestError(const Outcome& o, const Outcome& exact, double start) {
  double largest = 0;
  for (std::size_t k = 0; k < exact.values.size(); ++k)
    largest = std::max(largest, std::abs((o.values[k] - exact.values[k]) / (exact.values[k] - start)));
  return largest;
}

Outcome front(std::vector<std::string> settings, const std::vector<double>& times) {
  return run("cases/dam-break-2d.toml", settings, times, [](const Diagnostics& d) { return d.frontX; });
}

/// From the first frame on, when equal steps of the usual length are not yet exact, to the end, where elastic
/// pressures bound the steps.
void checkDamBreak(const std::string& resolution, const std::string& exactStep, double spacing) {
  const std::vector<double> times{0.01, 0.02, 0.05, 0.1, 0.2};
  const std::string size = "resolution=" + resolution;
  const double start = 20e-3 - spacing / 2;
  const Outcome exact = front({size, "time.step=" + exactStep}, times), equal = front({size}, times);
  const double equalError = largestError(equal, exact, start);
  for (const double tolerance : {0.04, 0.02}) {
    const Outcome o = front({size, "time.step=auto", "time.tolerance=" + std::to_string(tolerance)}, times);
    const double error = largestError(o, exact, start);
    EXPECT_LT(error, 0.4 * tolerance);  // measured: 0.22 to 0.28 of it
    EXPECT_LE(o.rejected, 4);
    // Equal steps of the same error would be so many, since theirs is of first order.
    EXPECT_GT(equal.steps * equalError / error, 3 * o.steps) << tolerance;
  }
}

TEST(AutomaticSteps, FrontOfTheDamBreak) { checkDamBreak("1", "0.125e-3", 1e-3); }
TEST(AutomaticSteps, FrontOfTheDamBreakHalfTheSpacing) { checkDamBreak("2", "0.5e-3", 0.5e-3); }

/// With a softer fluid nothing but the tolerance bounds the steps. In the longest of them the stiffness of fluid
/// under pressure acts, which makes their error smaller and is no part of the order.
TEST(AutomaticSteps, ErrorOfTheDamBreakFallsWithTheTolerance) {
  const std::string soft = "fluid.bulk_modulus=1e5", whole = "output.interval=0";
  const Outcome exact = front({soft, whole, "time.step=0.125e-3"}, {0.2});
  double last = 0;
  for (const double tolerance : {0.02, 0.01, 0.005, 0.0025}) {
    const Outcome o = front({soft, whole, "time.step=auto", "time.tolerance=" + std::to_string(tolerance)}, {0.2});
    const double error = largestError(o, exact, 19.5e-3);
    EXPECT_LT(error, 0.2 * tolerance);  // measured: 0.06, 0.09, 0.13, 0.16 of it
    if (tolerance < 0.01) {
      EXPECT_GT(std::log2(last / error), 0.45) << tolerance;  // measured: 0.56, 0.67
    }
    last = error;
  }
}

/// Of the start-up of plane Poiseuille flow, root mean square over the gap of H = 20 mm [m/s]: Fourier's series,
/// in which each term adds its own square.
double exactSpeed(double t) {
  constexpr double pi = std::numbers::pi, H = 0.02, nu = 1e-3, g = 2, top = g * H * H / (8 * nu);
  double square = 0;
  for (int n = 1; n < 100; n += 2) {
    const double steady = 32 / std::pow(n * pi, 3);
    square += 0.5 * std::pow(steady * (1 - std::exp(-std::pow(n * pi / H, 2) * nu * t)), 2);
  }
  return top * std::sqrt(square);
}

TEST(AutomaticSteps, StartUpOfPoiseuilleFlow) {
  const std::vector<double> times{0.02, 0.04, 0.06};
  const auto speed = [&](std::vector<std::string> settings) {
    settings.push_back("output.interval=0.02");
    return run("tests/validation/cases/poiseuille.toml", settings, times, [](const Diagnostics& d) {
      return std::sqrt(2 * d.kineticEnergy / (1e3 * 0.02 * 0.02));  // 1000 kg/m3 between the plates
    });
  };
  Outcome exact = speed({"time.step=0.25e-3"});
  const Outcome coarser = speed({"time.step=0.5e-3"});
  for (std::size_t k = 0; k < times.size(); ++k) {
    exact.values[k] += exact.values[k] - coarser.values[k];  // of steps of no length
    EXPECT_NEAR(exact.values[k] / exactSpeed(times[k]), 1, 0.012) << "error of the spacing";  // measured: 0.9 %
  }
  double last = 0;
  for (const double tolerance : {0.08, 0.04, 0.02, 0.01}) {
    const Outcome o = speed({"time.step=auto", "time.tolerance=" + std::to_string(tolerance)});
    const double error = largestError(o, exact, 0);
    // The velocity is that of the middle of a step, which here has grown with the time: measured 0.6 to 0.9 of it.
    EXPECT_LT(error, tolerance);
    if (last > 0) {
      EXPECT_GT(last / error, 1.2) << tolerance;
    }
    for (std::size_t k = 0; k < times.size(); ++k)
      EXPECT_NEAR(o.values[k] / exactSpeed(times[k]), 1, 0.012 + tolerance);
    last = error;
  }
}

}  // namespace
}  // namespace treacle
