#include "run_tally.hpp"

#include "treacle/core/version.hpp"
#include "treacle/model/case/names.hpp"

#include <omp.h>

#include <algorithm>

namespace treacle {

RunOrigin originOf(const Case& c, bool onDevice, const std::string& device, const ParticleNumbers& particles) {
  const BuildInfo build = buildInfo();
  RunOrigin origin;
  origin.version = build.version, origin.commit = build.commit;
  origin.backend = onDevice ? "cuda" : "cpu", origin.device = device;
  origin.threads = omp_get_max_threads();
  origin.precision = nameOf(c.solver.precision);
  origin.title = c.title;
  origin.dimensions = c.dimensions;
  origin.fluidParticles = particles.fluid, origin.wallParticles = particles.wall;
  return origin;
}

void RunTally::add(const StepReport& report) {
  StepTally& t = tally_;
  if (steps_++ == 0) t.firstIterations = report.iterations, t.leastStep = report.timeStep;
  lastStep_ = report.step, iterations_ += report.iterations, time_ += report.timeStep;
  const auto count = static_cast<double>(steps_);
  t.meanIterations = static_cast<double>(iterations_) / count, t.meanStep = time_ / count;
  t.lastIterations = report.iterations;
  t.fallbacks += report.fallbacks, t.rejectedSteps += report.rejected;
  t.leastStep = std::min(t.leastStep, report.timeStep), t.longestStep = std::max(t.longestStep, report.timeStep);
  t.meanDensity = report.diagnostics.meanDensityRatio, t.densityError = report.diagnostics.meanDensityError;
  t.largestDensityError = std::max(t.largestDensityError, t.densityError);
  if (report.flow) t.flow = {report.flow->particles, report.flow->in.particles, report.flow->out.particles};
  seconds_ += report.seconds;
}

}  // namespace treacle
