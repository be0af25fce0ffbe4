#include "advice.hpp"
#include "backend.hpp"
#include "case_input.hpp"
#include "commands.hpp"
#include "estimate.hpp"
#include "machine.hpp"
#include "memory.hpp"
#include "patience.hpp"
#include "print.hpp"
#include "progress.hpp"
#include "resume.hpp"
#include "run_log.hpp"
#include "threads.hpp"
#include "treacle/core/error.hpp"
#include "treacle/io/case/case_reader.hpp"
#include "treacle/io/surface/free_surface.hpp"
#include "treacle/model/case/checks.hpp"
#include "treacle/model/case/names.hpp"
#include "treacle/model/geometry/mesh.hpp"
#include "treacle/model/geometry/shape.hpp"
#include "treacle/model/geometry/thickness.hpp"
#include "treacle/model/motion/nozzle.hpp"
#include "treacle/step/method/solve_stages.hpp"
#include "treacle/step/run/shareable.hpp"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace treacle {
namespace {

/// A case that does not fit may be meant for another machine: that is a warning.
void printMemory(const Case& c, const AnyParticles& particles, std::vector<std::string>& warnings) try {
  if (leastMemory(c) > availableMemory())
    print("# memory: more than {} needed, {} available\n", bytesText(leastMemory(c)),
          bytesText(availableMemory()));
  const MemoryCounts counts = countsFor(c, particles);
  warnLargeDomain(c, counts, warnings);
  const MemoryEstimate onCpu = estimatedMemory(c, counts, false), onDevice = estimatedMemory(c, counts, true);
  print("# memory: about {} needed, {} available\n", bytesText(onCpu.host + onCpu.first),
        bytesText(availableMemory()));
  const auto device = deviceFor(BackendChoice::Auto);
  print("# device memory: about {} needed", bytesText(onDevice.device));
  if (device) print(", {} available on {}", bytesText(device->freeMemory), device->name);
  print("; beside it about {} of the host\n", bytesText(onDevice.host + onDevice.first));
  requireMemory(c, counts, device ? &*device : nullptr);
} catch (const RunError& error) {
  warnings.push_back(error.what());
}

/// What processes that share the case need. Errors: InputError for a case that they cannot share.
void printSharedMemory(const Case& c, const AnyParticles& particles, int processes) {
  requireShareable(c, BackendKind::Cpu);
  const auto count = static_cast<std::uint64_t>(processes);
  const MemoryCounts all = countForMemory(c, particles);
  requireCells(c, all.filledCells, processes);
  const MemoryEstimate onCpu = estimatedMemory(c, all, false, count),
                       onDevice = estimatedMemory(c, all, true, count);
  print("# memory of {} processes: about {} each, the first one {} more; {} of one machine, {} available here\n",
        processes, bytesText(onCpu.host), bytesText(onCpu.first), bytesText(count * onCpu.host + onCpu.first),
        bytesText(availableMemory()));
  print("# device memory of {} processes: about {} each; beside it about {} of the host\n", processes,
        bytesText(onDevice.device), bytesText(onDevice.host));
}

void printParticles(const Case& c, ParticleNumbers particles, const std::vector<BodyCount>& ofBodies) {
  print("# particles: {} fluid, {} wall\n", particles.fluid, particles.wall);
  for (std::size_t b = 0; b < c.bodies.size(); ++b)
    print("#   {} '{}': {}\n", nameOf(c.bodies[b].kind), c.bodies[b].name, ofBodies[b].all());
}

/// As it stands in the case.
void printMesh(const Case& c, const Body& body) {
  const MeshFacts& facts = body.shape.file.mesh.value->facts();
  const double scale = body.shape.transform ? body.shape.transform->scale : 1;
  const Extent box = boundingBox(body.shape, c.dimensions);
  print("# mesh of '{}': {} triangles from {} to {}, area {:.6g} m2, volume enclosed {:.6g} m3, {} open edges\n",
        body.name, facts.triangles, positionText(box.min, c.dimensions), positionText(box.max, c.dimensions),
        facts.area * scale * scale, std::abs(facts.volume) * scale * scale * scale, facts.openEdges);
}

void printShapes(const Case& c) {
  for (const Body& body : c.bodies) {
    if (body.shape.file.mesh.value) printMesh(c, body);
    if (body.shape.isThinSheet() && isMiddleOfSolid(c, body))
      print("#   a thin solid: '{}' is the sheet in its middle\n", body.name);
  }
}

/// How many particles come out of all nozzles until the end of the run.
template <int D>
double particlesFromNozzles(const Case& c) {
  constexpr int samples = 200;  // of speeds that vary
  const double dt = c.time.end / samples;
  double sum = 0;
  for (const Body& body : c.bodies) {
    if (body.kind != BodyKind::Inflow) continue;
    const NozzleLayers<D> layers(c, body);
    for (int k = 0; k < samples; ++k)
      sum += static_cast<double>(layers.size()) * std::max(0.0, layers.speed(k * dt, dt)) * dt / c.spacing;
  }
  return sum;
}

/// Seconds of a step per fluid particle on one thread, as measured on one machine for the shipped cases.
double secondsPerParticle(const Case& c) {
  const bool plane = c.dimensions == 2;
  if (c.method.kind == MethodKind::Isph) return plane ? 3e-6 : 9e-6;
  if (c.method.scheme == SchemeKind::Accurate && c.hasRigid()) return plane ? 2e-5 : 3e-4;
  if (c.method.scheme == SchemeKind::Accurate) return plane ? 9e-6 : 4e-5;
  return plane ? 6e-6 : 2e-5;
}

/// `fluid`: particles in the mean over the run.
void printTime(const Case& c, double fluid) {
  const double step = secondsPerParticle(c) * fluid / omp_get_max_threads();
  print(
      "# time per step: very roughly {:.2g} s on {} threads of a processor, {} for {} steps or more (--estimate "
      "measures)\n",
      step, omp_get_max_threads(), durationText(step * c.time.end / c.time.step),
      std::llround(c.time.end / c.time.step));
}

void printAutomaticSteps(const Case& c) {
  const StableStep stable = longestStableStep(c);
  print(
      "# time step: chosen in each step for an error of {:g}, from {:g} to {:g} s, Courant number at most {:g}; ",
      c.time.tolerance, c.time.least, c.time.step, c.time.mostCourant());
  if (std::isfinite(stable.length))
    print("stable up to {:.4g} s ({})\n", stable.length, stable.reason);
  else
    print("stable at any length\n");
}

void printNumbers(const Case& c) {
  if (c.time.automatic) printAutomaticSteps(c);
  if (c.time.stepsVary())
    print("# steps: {:.0f} or more\n", std::ceil(c.time.end / c.time.step * (1 - 1e-9)));
  else
    print("# steps: {}\n", c.steps());
  print("# solver: {}\n", solverText(solveStages(c).front()));
  if (c.method.kind == MethodKind::Isph) print("# viscous step: {}\n", viscousText(c));
  print("# Courant number: {:.4g}\n", courantNumber(c));
  for (const StabilityNumbers& n : stabilityNumbers(c))
    if (c.method.kind == MethodKind::Isph)
      print("# material '{}': diffusion number d_mu = {:.4g}\n", n.material, n.shearDiffusion);
    else
      print(
          "# material '{}': dt kappa / lambda = {:.4g} (stable up to {:g}), diffusion numbers d_mu = {:.4g}, "
          "d_lambda = {:.4g}\n",
          n.material, n.compression, mostCompression(c), n.shearDiffusion, n.bulkDiffusion);
  for (const Material& m : c.materials)
    if (m.autoBulkViscosity || m.autoBulkModulus)
      print("# automatic constants of '{}': bulk_viscosity {:.3g}, bulk_modulus {:.3g}\n", m.name, m.bulkViscosity,
            m.bulkModulus);
}

}  // namespace

void checkCommand(const CheckOptions& options) {
  const Patience patience("checking the case");
  startThreads(options.threads);
  Case c = readCase(options.input.file, options.input.overrides);
  setEndTime(c, options.endTime);
  std::vector<std::string> warnings;
  requireRoomForParticles(c);
  MadeParticles made = withPlaces(options.input, [&] { return MadeParticles::of(c, warnings); });
  made.requireParticles(c);
  AnyParticles& particles = made.particles;
  for (std::string& warning : caseWarnings(c)) warnings.push_back(std::move(warning));
  if (c.output.surface && !hasFreeSurface()) warnings.push_back("output.surface: " + whyNoFreeSurface());
  printParticles(c, particles.numbers(), made.ofBodies);
  const double entering = c.dimensions == 2 ? particlesFromNozzles<2>(c) : particlesFromNozzles<3>(c);
  if (entering > 0) print("# inflow: about {:.0f} particles enter until the end\n", entering);
  printShapes(c);
  if (options.processes > 1)
    printSharedMemory(c, particles, options.processes);
  else
    printMemory(c, particles, warnings);
  // In the mean half of them are there, if none leave.
  if (!options.estimate) printTime(c, static_cast<double>(particles.numbers().fluid) + entering / 2);
  printNumbers(c);
  printAdvice(c);
  if (options.estimate) {
    const BackendKind backend = deviceFor(options.backend) ? BackendKind::Cuda : BackendKind::Cpu;
    flushPrinted();
    printEstimate(c, std::move(particles), backend);
  }
  print("\n{}", caseText(c));
  flushPrinted();
  for (const std::string& warning : warnings) printWarning(warning);
}

}  // namespace treacle
