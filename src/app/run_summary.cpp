#include "run_summary.hpp"

#include "treacle/core/version.hpp"
#include "treacle/model/case/names.hpp"

#include <omp.h>

namespace treacle {

RunSummary startOfSummary(const Case& c, bool onDevice, const std::string& device,
                          const ParticleNumbers& particles) {
  const BuildInfo build = buildInfo();
  RunSummary summary;
  summary.version = build.version, summary.commit = build.commit;
  summary.backend = onDevice ? "cuda" : "cpu", summary.device = device;
  summary.threads = omp_get_max_threads();
  summary.precision = nameOf(c.solver.precision);
  summary.title = c.title;
  summary.dimensions = c.dimensions;
  summary.fluidParticles = particles.fluid, summary.wallParticles = particles.wall;
  return summary;
}

}  // namespace treacle
