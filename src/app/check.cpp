#include "backend.hpp"
#include "commands.hpp"
#include "machine.hpp"
#include "memory.hpp"
#include "run_log.hpp"
#include "treacle/io/case_reader.hpp"
#include "treacle/model/checks.hpp"
#include "treacle/model/create.hpp"
#include "treacle/model/names.hpp"
#include "treacle/step/solve_stages.hpp"

#include <fmt/format.h>

#include <cmath>

namespace treacle {
namespace {

void printMemory(const Case& c, ParticleNumbers particles) {
  fmt::print("# memory: about {} needed, {} available\n", bytesText(estimatedMemory(c, particles, false)),
             bytesText(availableMemory()));
  const auto device = deviceFor(BackendChoice::Auto);
  fmt::print("# device memory: about {} needed", bytesText(estimatedDeviceMemory(c, particles)));
  if (device) fmt::print(", {} available on {}", bytesText(device->freeMemory), device->name);
  fmt::print("; beside it about {} of the host\n", bytesText(estimatedMemory(c, particles, true)));
}

void printParticles(const Case& c, ParticleNumbers particles, const std::vector<std::uint32_t>& ofBodies) {
  fmt::print("# particles: {} fluid, {} wall\n", particles.fluid, particles.wall);
  for (std::size_t b = 0; b < c.bodies.size(); ++b)
    fmt::print("#   {} '{}': {}\n", nameOf(c.bodies[b].kind), c.bodies[b].name, ofBodies[b]);
  printMemory(c, particles);
}

void printNumbers(const Case& c) {
  if (c.time.stepsVary())
    fmt::print("# steps: {:.0f} or more\n", std::ceil(c.time.end / c.time.step * (1 - 1e-9)));
  else
    fmt::print("# steps: {}\n", c.steps());
  fmt::print("# solver: {}\n", solverText(solveStages(c).front()));
  if (c.method.kind == MethodKind::Isph) fmt::print("# viscous step: {}\n", viscousText(c));
  fmt::print("# Courant number: {:.4g}\n", courantNumber(c));
  for (const StabilityNumbers& n : stabilityNumbers(c))
    if (c.method.kind == MethodKind::Isph)
      fmt::print("# material '{}': diffusion number d_mu = {:.4g}\n", n.material, n.shearDiffusion);
    else
      fmt::print(
          "# material '{}': dt kappa / lambda = {:.4g} (stable up to 1), diffusion numbers d_mu = {:.4g}, "
          "d_lambda = {:.4g}\n",
          n.material, n.compression, n.shearDiffusion, n.bulkDiffusion);
}

}  // namespace

void checkCommand(const CaseOptions& options) {
  const Case c = readCase(options.file, options.overrides);
  std::vector<std::string> warnings;
  std::vector<std::uint32_t> ofBodies;
  const ParticleNumbers particles = createParticles(c, warnings, &ofBodies).numbers();
  for (std::string& warning : caseWarnings(c)) warnings.push_back(std::move(warning));
  printParticles(c, particles, ofBodies);
  printNumbers(c);
  fmt::print("\n{}", caseText(c));
  std::fflush(stdout);
  for (const std::string& warning : warnings) printWarning(warning);
}

}  // namespace treacle
