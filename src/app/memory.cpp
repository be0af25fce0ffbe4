#include "memory.hpp"

#include "machine.hpp"
#include "piece_writer.hpp"
#include "together.hpp"
#include "treacle/core/backend.hpp"
#include "treacle/core/error.hpp"
#include "treacle/io/free_surface.hpp"
#include "treacle/model/create.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <new>
#include <numeric>

namespace treacle {
namespace {

constexpr std::uint64_t copiesToBeWritten = 3;    // two snapshots, and the file of a checkpoint
constexpr std::uint64_t driverBytes = 300 << 20;  // what CUDA takes of the host
constexpr std::uint64_t pictureBytes = 11 << 20;  // of the program's: what draws one
constexpr std::uint64_t messageBytes = 9 << 20;   // MPI: its library and what it has for messages
constexpr std::uint64_t cellBytes = 26;           // at least, of a search cell: ranges, marks, a grid's point

/// What is to be stored, for messages.
std::string contentText(const ParticleNumbers& particles, std::uint64_t cells) {
  const std::uint64_t all = particles.fluid + particles.wall;
  const std::string text = fmt::format("{} particles", all);
  return cells > all ? fmt::format("{} and {} search cells of the domain", text, cells) : text;
}

/// The program itself, its libraries and a picture; with CUDA the device code that it carries. OpenVDB is large.
std::uint64_t programBytes() {
  return std::uint64_t{(cudaCompiled ? 61u : 29u) + (hasFreeSurface() ? 28u : 0u)} << 20;
}

/// What is to be written: copies of the state, and what a surface is made of.
std::uint64_t outputBytes(const Case& c, const ParticleNumbers& particles) {
  constexpr std::uint64_t ofSurface = 80;  // per particle
  return copiesToBeWritten * stateBytes(c, particles) + (c.output.surface ? ofSurface * particles.fluid : 0);
}

/// Of a particle's place.
std::uint64_t placeBytes(const Case& c) { return static_cast<std::uint64_t>(c.dimensions) * sizeof(double); }

/// What a sum over processes takes beside the matrix of a grid that stands whole at each of them.
std::uint64_t sumBytes(const Case& c, const MemoryCounts& n) {
  const auto bytes = [](const std::vector<MemoryCounts::Grid>& grids, std::uint64_t numbers) {
    return grids.empty() || grids.front().divided ? 0 : grids.front().entries * numbers * sizeof(double);
  };
  const auto d = static_cast<std::uint64_t>(c.dimensions);
  return std::max(bytes(n.pressureGrids, 1), bytes(n.fluidGrids, c.method.kind == MethodKind::Isph ? 1 : d * d));
}

void require(const std::string& content, std::uint64_t needed) {
  if (const std::uint64_t available = availableMemory(); needed > available)
    throw RunError(
        fmt::format("{} need about {} of memory, {} available; take a lower resolution or a smaller domain",
                    content, bytesText(needed), bytesText(available)));
}

}  // namespace

void requireRoomForParticles(const Case& c) {
  const double points = boxPoints(c);
  if (points > static_cast<double>(maxParticles)) return;  // createParticles says so
  const auto count = static_cast<std::uint64_t>(points);
  require(fmt::format("{} particles", count), count * placeBytes(c));
}

std::uint64_t leastMemory(const Case& c) { return programBytes() + cellBytes * searchCells(c); }

MemoryCounts countsFor(const Case& c, const AnyParticles& particles, bool onDevice) {
  MemoryCounts known;
  known.particles = particles.numbers();
  known.cells = searchCells(c);
  require(contentText(known.particles, known.cells), leastMemory(c));
  return countForMemory(c, particles, storesMatrix(c, onDevice ? BackendKind::Cuda : BackendKind::Cpu));
}

MemoryCounts countsFor(const Case& c, const AnyParticles& part, bool onDevice, const Communicator& processes) {
  together(processes, [&] { require(contentText(part.numbers(), searchCells(c)), leastMemory(c)); });
  try {
    return countForMemory(c, part, storesMatrix(c, onDevice ? BackendKind::Cuda : BackendKind::Cpu), processes);
  } catch (const std::bad_alloc&) {  // the others wait for it
    processes.abort("memory exhausted", static_cast<int>(ExitCode::RunFailed));
  }
}

std::uint64_t estimatedMemory(const Case& c, const MemoryCounts& n, bool onDevice) {
  const std::uint64_t output = outputBytes(c, n.particles);
  if (onDevice) return programBytes() + driverBytes + output + distantWallBytes(c, n);
  return programBytes() + output + planMemory(c, n, BackendKind::Cpu).peak;
}

std::uint64_t estimatedDeviceMemory(const Case& c, const MemoryCounts& n) {
  return planMemory(c, n, BackendKind::Cuda).peak;
}

/// A process that begins has the places of all, then its part twice while that is given out, which a GPU takes it
/// from.
std::uint64_t processMemory(const Case& c, const MemoryCounts& n, bool onDevice, const ParticleNumbers& all) {
  const std::uint64_t state = stateBytes(c, n.particles);
  const std::uint64_t begin =
      std::max((all.fluid + all.wall) * placeBytes(c) + state, 2 * state + cellBytes * n.cells);
  const std::uint64_t steps =
      onDevice ? distantWallBytes(c, n) : planMemory(c, n, BackendKind::Cpu).peak + sumBytes(c, n);
  const bool pieces = writesPieces(c, all, n.sharing.processes);
  return programBytes() - pictureBytes + messageBytes + (onDevice ? driverBytes : 0) + std::max(begin, steps) +
         (pieces ? 2 * state : 0);
}

std::uint64_t gatheredMemory(const Case& c, const ParticleNumbers& all) {
  return pictureBytes + outputBytes(c, all);
}

std::uint64_t memoryOfHost(std::vector<std::uint64_t> each, std::uint64_t onHost, std::uint64_t gathered) {
  std::ranges::sort(each, std::greater{});
  each.resize(std::min<std::size_t>(each.size(), onHost));
  return std::accumulate(each.begin(), each.end(), gathered);
}

void requireMemory(const Case& c, const AnyParticles& particles, const DeviceInfo* device) {
  requireMemory(c, countsFor(c, particles, device != nullptr), device);
}

void requireMemory(const Case& c, const MemoryCounts& n, const DeviceInfo* device, const Sharing& sharing) {
  const bool shared = sharing.processes > 1;
  const std::string content = contentText(shared ? sharing.all : n.particles, n.cells) +
                              (shared ? fmt::format(", shared by {} processes,", sharing.processes) : "");
  require(content, shared ? sharing.hostMemory : estimatedMemory(c, n, device != nullptr));
  if (!device) return;
  if (device->freeMemory == 0)
    throw RunError(fmt::format(
        "{} gives no device memory: other programs have taken all of it, or have it to themselves "
        "(nvidia-smi shows them); wait for them, choose another device by CUDA_VISIBLE_DEVICES, or take "
        "--backend cpu",
        device->name));
  const std::uint64_t onDevice = estimatedDeviceMemory(c, n);
  if (onDevice > device->freeMemory)
    throw RunError(
        fmt::format("{} need about {} of device memory, {} available on {}; take a lower resolution, a smaller "
                    "domain or --backend cpu",
                    content, bytesText(onDevice), bytesText(device->freeMemory), device->name));
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
