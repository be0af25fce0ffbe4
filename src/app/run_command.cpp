#include "backend.hpp"
#include "case_input.hpp"
#include "commands.hpp"
#include "interrupt.hpp"
#include "machine.hpp"
#include "memory.hpp"
#include "patience.hpp"
#include "piece_writer.hpp"
#include "resume.hpp"
#include "run.hpp"
#include "threads.hpp"
#include "together.hpp"
#include "treacle/core/error.hpp"
#include "treacle/io/case/case_reader.hpp"
#include "treacle/io/checkpoint/checkpoint.hpp"
#include "treacle/io/surface/free_surface.hpp"
#include "treacle/model/case/case_error.hpp"
#include "treacle/model/case/checks.hpp"
#include "treacle/model/geometry/wall_sight.hpp"
#include "treacle/step/flow/outflow_start.hpp"
#include "treacle/step/run/shareable.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <system_error>

namespace treacle {
namespace {

Case caseOf(const RunOptions& options) {
  Case c = readCase(options.input.file, options.input.overrides);
  if (options.precision) c.solver.precision = *options.precision;
  setEndTime(c, options.endTime);
  return c;
}

/// --force would remove what the run begins with before it has anything to put in its place.
void requireElsewhere(const std::filesystem::path& directory, const RunOptions& options, const Case& c) {
  std::error_code error;  // what is not found here is not found later
  const auto canonical = [&](const auto& path) { return std::filesystem::weakly_canonical(path, error); };
  const std::filesystem::path run = canonical(directory);
  const auto isInside = [&](const std::filesystem::path& file) {
    if (file.empty()) return false;
    const std::filesystem::path folder = canonical(file).parent_path();
    return !error && (folder == run || folder == run / "frames" || folder == run / "probes");
  };
  if (isInside(options.resume))
    throw InputError(fmt::format("--resume {}: lies in the run directory; choose another one with --output",
                                 options.resume.string()));
  for (const Body& body : c.bodies)
    if (isInside(body.shape.file.path))
      throw InputError(fmt::format("body '{}': {} lies in the run directory; choose another one with --output",
                                   body.name, body.shape.file.path));
}

/// Every host has about as many.
std::uint64_t processesOnHost(const Communicator& processes) {
  const std::vector<int> local = processes.all(processes.localRank());
  const std::uint64_t size = local.size(), hosts = std::ranges::count(local, 0);
  return (size + hosts - 1) / hosts;
}

ParticlePart partOf(const Communicator& processes) {
  return {static_cast<std::uint32_t>(processes.rank()), static_cast<std::uint32_t>(processes.size())};
}

/// Each has a part of them.
ParticleNumbers numbersOfAll(const Communicator& processes, const ParticleNumbers& own) {
  std::array numbers{own.fluid, own.wall, own.surfaces};
  processes.sum(std::span<std::uint64_t>(numbers));
  ParticleNumbers all{numbers[0], numbers[1], 0, numbers[2]};
  all.has = own.has;
  return all;
}

/// What MadeParticles notes where one process makes all of them. Collective; errors: those of noteFluidInOutflows.
void noteParticles(const Case& c, const AnyParticles& part, const Communicator& processes,
                   std::vector<std::string>& notes) {
  std::vector<std::uint64_t> held = fluidInOutflows(c, part);
  held.push_back(part.numbers().fluid);
  processes.sum(std::span(held));
  noteFluidInOutflows(c, std::span(held).first(held.size() - 1), held.back(), notes);
  if (!c.isAccurate()) return;
  std::vector<WallSight> sight = part.visit([&]<int D>(const Particles<D>& p) {
    return wallSight<D>(c, p.body.span().subspan(p.wallBegin()), p.wallSurface.span());
  });
  std::vector<std::uint64_t> counts;
  for (const WallSight& s : sight) counts.insert(counts.end(), {s.particles, s.seeing});
  processes.sum(std::span(counts));
  for (std::size_t b = 0; b < sight.size(); ++b) sight[b] = {counts[2 * b], counts[2 * b + 1]};
  noteBlindWalls(c, sight, notes);
}

/// Errors: those of requireMemory, at all processes.
void requireMemoryOfAll(const Case& c, const AnyParticles& part, const DeviceInfo* device,
                        const Communicator& processes) {
  const MemoryCounts all = countsFor(c, part, processes);
  const std::uint64_t onHost = processesOnHost(processes);
  together(processes,
           [&] { requireMemory(c, all, device, static_cast<std::uint64_t>(processes.size()), onHost); });
}

/// Whether every process has a device: all compute on devices, or none.
bool allHaveOne(const Communicator& processes, bool has) {
  const std::vector<std::uint8_t> all = processes.all(std::uint8_t{has});
  return std::ranges::find(all, 0) == all.end();
}

/// A run at a process that is not the first. `particles`: of all.
void follow(const Case& c, StartState start, const ParticleNumbers& particles, BackendKind backend,
            const std::filesystem::path& directory, const Communicator& processes) {
  std::optional<PieceWriter> pieces;
  if (writesPieces(c, particles, static_cast<std::uint64_t>(processes.size())))
    pieces.emplace(c, RunDirectory::joined(directory), processes);
  serveSimulation(c, std::move(start.particles), backend, start.step, start.time, processes,
                  [&](AnySimulation& s, int order, std::int64_t frame) {
                    pieces->answer(s, static_cast<PieceOrder>(order), static_cast<std::size_t>(frame));
                  });
}

}  // namespace

void runCommand(const RunOptions& options, const Communicator& processes) {
  prepareCheckpoints();
  const bool shared = processes.size() > 1;
  std::optional<Patience> patience;
  patience.emplace("preparing the run", options.quiet || processes.rank() > 0);
  std::optional<DeviceInfo> device;
  together(processes, [&] { device = deviceFor(options.backend, processes.localRank()); });
  if (!allHaveOne(processes, device.has_value())) device.reset();
  const BackendKind backend = device ? BackendKind::Cuda : BackendKind::Cpu;
  Case c;
  std::vector<std::string> warnings;
  MadeParticles made;
  together(processes, [&] {
    startThreads(options.threads);
    c = caseOf(options);
    if (c.output.surface && !hasFreeSurface()) throw InputError("output.surface: " + whyNoFreeSurface());
    if (shared) requireShareable(c, backend);
    requireRoomForParticles(c, static_cast<std::uint64_t>(processes.size()));
    made = withPlaces(options.input, [&] { return MadeParticles::of(c, warnings, partOf(processes)); });
    if (options.resume.empty()) made.requireParticles(c);
    for (std::string& warning : caseWarnings(c)) warnings.push_back(std::move(warning));
  });
  if (shared) noteParticles(c, made.particles, processes, warnings);
  ParticleNumbers all = numbersOfAll(processes, made.particles.numbers());
  StartState start{AnyParticles(2)};
  together(processes, [&] {
    start = options.resume.empty() ? StartState{std::move(made.particles)} : resumedState(c, options.resume, made);
    if (!shared) requireMemory(c, start.particles, device ? &*device : nullptr);
    if (!start.notes.empty()) all = start.particles.numbers();
    for (const std::string& note : start.notes) warnings.push_back(note);
  });
  if (shared) requireMemoryOfAll(c, start.particles, device ? &*device : nullptr, processes);
  made = {};
  requireSame(processes, fmt::format("{}\n{} {}", caseText(c), start.step, start.time));
  catchInterrupts();
  std::optional<RunDirectory> files;
  const auto directory = options.directory.empty() ? options.input.file.stem().concat("-run") : options.directory;
  together(processes, [&] {
    if (processes.rank() > 0) return;
    requireElsewhere(directory, options, c);
    files.emplace(RunDirectory::create(directory, options.force));
  });
  patience.reset();
  if (processes.rank() > 0) return follow(c, std::move(start), all, backend, directory, processes);
  const Followers followers(processes);
  if (!device)
    for (std::string& warning : cpuWarnings(c)) warnings.push_back(std::move(warning));
  RunStart from{std::move(start), all, backend, device ? deviceText(*device) : processorName()};
  Run run(c, std::move(from), std::move(*files), options, processes);
  run.execute(warnings);
}

}  // namespace treacle
