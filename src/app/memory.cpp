#include "memory.hpp"

#include "machine.hpp"
#include "piece_writer.hpp"
#include "together.hpp"
#include "treacle/core/backend.hpp"
#include "treacle/core/error.hpp"
#include "treacle/model/particles/create.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <new>

namespace treacle {
namespace {

constexpr std::uint64_t copiesToBeWritten = 3;    // two snapshots, and the file of a checkpoint
constexpr std::uint64_t driverBytes = 300 << 20;  // what CUDA takes of the host
constexpr std::uint64_t pictureBytes = 11 << 20;  // of the program's: what draws one
constexpr std::uint64_t messageBytes = 9 << 20;   // MPI: its library and what it has for messages
constexpr std::uint64_t cellBytes = 26;           // at least, of a search cell: ranges, marks, a grid's point

/// An estimate may be so much too large. A device on which memory gives out keeps its state, so what may fit is
/// tried there.
constexpr double mostOfDevice = 1.15;

/// What is to be stored, for messages.
std::string contentText(const ParticleNumbers& particles, std::uint64_t cells) {
  const std::uint64_t all = particles.fluid + particles.wall;
  const std::string text = fmt::format("{} particles", all);
  return cells > all ? fmt::format("{} and {} search cells of the domain", text, cells) : text;
}

/// The program itself, its libraries and a picture; with CUDA also its tables of device code. OpenVDB is large.
std::uint64_t programBytes(const Case& c) {
  return std::uint64_t{(cudaCompiled ? 38u : 29u) + (c.output.surface ? 28u : 0u)} << 20;
}

/// What is to be written: copies of the state, and what a surface is made of.
std::uint64_t outputBytes(const Case& c, const ParticleNumbers& particles) {
  constexpr std::uint64_t ofSurface = 80;  // per particle
  return copiesToBeWritten * stateBytes(c, particles) + (c.output.surface ? ofSurface * particles.fluid : 0);
}

/// The memory of the places of particles.
std::uint64_t placeBytes(const Case& c, const ParticleNumbers& n) {
  return (n.fluid + n.wall) * static_cast<std::uint64_t>(c.dimensions) * sizeof(double);
}

void require(const std::string& content, std::uint64_t needed, std::uint64_t available = availableMemory()) {
  if (needed > available)
    throw RunError(
        fmt::format("{} need about {} of memory, {} available; take a lower resolution or a smaller domain",
                    content, bytesText(needed), bytesText(available)));
}

}  // namespace

/// There are all of their places and a part of their fields at once.
void requireRoomForParticles(const Case& c, std::uint64_t processes, std::uint64_t available) {
  const double points = leastPoints(c);
  if (points > static_cast<double>(maxParticles)) return;  // createParticles says so
  const auto count = static_cast<std::uint64_t>(points);
  const ParticleNumbers particles{.wall = count};  // which have fewer fields
  require(fmt::format("{} particles", count), placeBytes(c, particles) + stateBytes(c, particles) / processes,
          available);
}

std::uint64_t leastMemory(const Case& c) { return programBytes(c) + cellBytes * searchCells(c); }

MemoryCounts countsFor(const Case& c, const AnyParticles& particles) {
  require(contentText(particles.numbers(), searchCells(c)), leastMemory(c));
  return countForMemory(c, particles);
}

MemoryCounts countsFor(const Case& c, const AnyParticles& some, const Communicator& processes) {
  together(processes, [&] { require(contentText(some.numbers(), searchCells(c)), leastMemory(c)); });
  try {
    return countForMemory(c, some, &processes);
  } catch (const std::bad_alloc&) {  // the others wait for it
    processes.abort("memory exhausted", static_cast<int>(ExitCode::RunFailed));
  }
}

/// A process that begins has the places of all, then its part twice while that is given out, which a GPU takes it
/// from.
MemoryEstimate estimatedMemory(const Case& c, const MemoryCounts& all, bool onDevice, std::uint64_t processes) {
  const MemoryCounts n = all.share(c, processes);
  const std::uint64_t state = stateBytes(c, n.particles), places = placeBytes(c, all.particles),
                      driver = onDevice ? driverBytes : 0,
                      simulation = simulationBytes(c, n, onDevice ? BackendKind::Cuda : BackendKind::Cpu),
                      steps = onDevice ? distantWallBytes(c, n) : simulation;
  MemoryEstimate estimate{programBytes(c) + driver + steps, outputBytes(c, all.particles),
                          onDevice ? simulation : 0};
  if (processes == 1) return estimate;
  estimate.host += messageBytes - pictureBytes +
                   std::max(steps, std::max(places + state, 2 * state + cellBytes * n.cells)) - steps;
  if (writesPieces(c, all.particles, processes)) estimate.host += 2 * state;
  estimate.first += pictureBytes;
  return estimate;
}

void warnLargeDomain(const Case& c, const MemoryCounts& all, std::vector<std::string>& warnings) {
  constexpr std::uint64_t large = std::uint64_t{1} << 30, share = 10;
  const std::uint64_t cells = cellBytes * all.cells, rest = estimatedMemory(c, all, false).host - cells;
  if (cells <= large || cells <= share * rest) return;
  warnings.push_back(fmt::format(
      "the domain takes {} for its {} search cells, and the {} particles take {}; a smaller domain would do",
      bytesText(cells), all.cells, all.particles.fluid + all.particles.wall, bytesText(rest)));
}

void requireMemory(const Case& c, const AnyParticles& particles, const DeviceInfo* device) {
  requireMemory(c, countsFor(c, particles), device);
}

void requireMemory(const Case& c, const MemoryCounts& all, const DeviceInfo* device, std::uint64_t processes,
                   std::uint64_t onHost) {
  const std::string content = contentText(all.particles, all.cells) +
                              (processes > 1 ? fmt::format(", shared by {} processes,", processes) : "");
  const MemoryEstimate needed = estimatedMemory(c, all, device != nullptr, processes);
  require(content, onHost * needed.host + needed.first);
  if (!device) return;
  if (device->freeMemory == 0)
    throw RunError(fmt::format(
        "{} gives no device memory: other programs have taken all of it, or have it to themselves "
        "(nvidia-smi shows them); wait for them, choose another device by CUDA_VISIBLE_DEVICES, or take "
        "--backend cpu",
        device->name));
  if (static_cast<double>(needed.device) > mostOfDevice * static_cast<double>(device->freeMemory))
    throw RunError(
        fmt::format("{} need about {} of device memory, {} available on {}; take a lower resolution, a smaller "
                    "domain or --backend cpu",
                    content, bytesText(needed.device), bytesText(device->freeMemory), device->name));
}

std::string exhaustedText(const DeviceMemoryNumbers& n) {
  return fmt::format(
      "device memory exhausted: {}{} of {} free{}; take a lower resolution or a smaller domain, or end what else "
      "uses the device (nvidia-smi shows it)",
      n.wanted > 0 ? bytesText(n.wanted) + " more needed, " : "", bytesText(n.free), bytesText(n.total),
      n.peak > 0 ? ", the run itself had up to " + bytesText(n.peak) : "");
}

std::string bytesText(std::uint64_t bytes) {
  constexpr double mebibyte = 1 << 20, gibibyte = 1 << 30;
  const double b = static_cast<double>(bytes);
  return b < gibibyte ? fmt::format("{:.3g} MiB", b / mebibyte) : fmt::format("{:.3g} GiB", b / gibibyte);
}

}  // namespace treacle
