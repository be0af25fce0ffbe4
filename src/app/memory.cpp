#include "memory.hpp"

#include "machine.hpp"
#include "treacle/core/error.hpp"
#include "treacle/linear/deflation_scalars.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace treacle {
namespace {

/// What of a solve decides on its memory.
enum class Storage { MatrixFree, Ranges, Assembled, Spgemm };

/// Bytes of the host at the peak of a run, measured on the dam breaks.
struct HostBytes {
  std::uint64_t snapshots;   // fluid and walls: two copies to be written, and a frame
  std::uint64_t state;       // fluid and walls: fields and sort
  std::uint64_t matrixFree;  // fluid: neighbour lists, pair coefficients, preconditioner, solver vectors
  std::uint64_t assembled;   // fluid: the matrix in place of the coefficients
  std::uint64_t projected;   // fluid: what projected-multigrid takes more than the others
  std::uint64_t beside;      // fluid: the coefficients that it needs beside an assembled matrix
  std::uint64_t memory;      // fluid: acceleration and jerk, in the state and in each copy of it
  std::uint64_t accurate;    // fluid: what the accurate scheme takes more, most of it for its near neighbours
};
constexpr HostBytes hostBytes2D{210, 100, 1400, 2100, 740, 780, 32, 500};
constexpr HostBytes hostBytes3D{300, 140, 4200, 14300, 2830, 2750, 48, 2180};
constexpr std::uint64_t copiesToBeWritten = 3;    // two snapshots, and the file of a checkpoint
constexpr std::uint64_t programBytes = 26 << 20;  // the program itself, its libraries and a picture
constexpr std::uint64_t driverBytes = 300 << 20;  // what CUDA takes of the host

/// Bytes of the device at the peak of a run, measured on the dam breaks and on blocks without walls.
struct DeviceBytes {
  std::uint64_t fixed;  // the dense tail of the V-cycle, most of the time
  std::uint64_t wall;
  std::uint64_t matrixFree, ranges, assembled, spgemm;  // per fluid particle
  std::uint64_t projected;                              // likewise: what projected-multigrid takes more
  std::uint64_t accurate;                               // likewise: what the accurate scheme does
};
constexpr DeviceBytes deviceBytes2D{5'000'000, 119, 692, 592, 2072, 10762, 210, 10};
constexpr DeviceBytes deviceBytes3D{12'000'000, 190, 1178, 948, 14068, 97548, 780, 290};

/// The same of ISPH with hat-multigrid in mixed precision, measured on its dam breaks.
struct IsphBytes {
  std::uint64_t solver;              // host, fluid: rows, matrix, preconditioner, vectors
  std::uint64_t fixed, wall, fluid;  // device
};
constexpr IsphBytes isphBytes2D{650, 5'000'000, 119, 770};
constexpr IsphBytes isphBytes3D{700, 14'000'000, 202, 1200};

const IsphBytes& isphBytes(const Case& c) { return c.dimensions == 2 ? isphBytes2D : isphBytes3D; }

/// What modes take of one fluid particle. In two dimensions a solver takes some before long; in three it seldom
/// finds any worth taking, and where there is no memory for them it does without.
struct ModeBytes {
  std::uint64_t kept = 0;  // in the state and in each copy of it
  std::uint64_t used = 0;  // in a solve, recorded vectors or A W; and for the sort
};

ModeBytes modeBytes(const Case& c) {
  if (c.dimensions == 3 || c.method.kind != MethodKind::MphI || !c.solver.deflates()) return {};
  const std::uint64_t modes = static_cast<std::uint64_t>(c.solver.deflation), components = 2;
  constexpr std::uint64_t recorded = DeflationScalars::maxBasis * sizeof(float);
  const std::uint64_t kept = components * modes * sizeof(float);
  return {kept, components * std::max(recorded, modes * sizeof(double)) + kept};
}

/// What the balance of a step takes where it is made, with walls that are wet all over; the dam breaks, whose
/// walls are thick, take 21 and 31 per wall particle.
std::uint64_t balanceBytes(const Case& c, ParticleNumbers n) {
  if (!c.output.balance) return 0;
  constexpr std::uint64_t fluid = 8, wall2D = 80, wall3D = 200;
  return n.fluid * fluid + n.wall * (c.dimensions == 2 ? wall2D : wall3D);
}

/// Search cells of the domain, whether or not there are particles in them.
std::uint64_t cellCount(const Case& c) {
  double cells = 1;
  for (int k = 0; k < c.dimensions; ++k)
    cells *= std::max(1.0, std::floor((c.domain.max[k] - c.domain.min[k]) / c.searchEdge()));
  return static_cast<std::uint64_t>(cells);
}

/// Ranges of fluid and walls and marks, and what the multigrids on hat functions know of each cell; the same on
/// host and device.
std::uint64_t cellBytes(const Case& c) {
  constexpr std::uint64_t search = 18, hats = 9;
  const PreconditionerKind kind = c.solver.preconditioner;
  const bool withHats = kind == PreconditionerKind::ProjectedMultigrid || kind == PreconditionerKind::HatMultigrid;
  return cellCount(c) * (search + (withHats ? hats : 0));
}

/// What is to be stored, for messages.
std::string contentText(const Case& c, ParticleNumbers n) {
  const std::string particles = fmt::format("{} particles", n.fluid + n.wall);
  const std::uint64_t cells = cellCount(c);
  return cells > n.fluid + n.wall ? fmt::format("{} and {} search cells of the domain", particles, cells)
                                  : particles;
}

/// `onDevice`: ranges and products of sparse matrices exist on devices only.
Storage storageOf(const SolverSettings& solver, bool onDevice) {
  const bool multigrid = solver.preconditioner == PreconditionerKind::BucketMultigrid;
  if (onDevice && multigrid && solver.multigrid.coarseOperators == CoarseKind::Spgemm) return Storage::Spgemm;
  if (solver.operatorKind == OperatorKind::Assembled ||
      (multigrid && solver.multigrid.particleDiagonal == SmootherDiagonal::ExtendedJacobi))
    return Storage::Assembled;
  return onDevice && solver.neighbours == NeighbourKind::Ranges ? Storage::Ranges : Storage::MatrixFree;
}

/// Of an assembled A: how much longer its rows are than with the radii of the published scheme. They reach farther
/// out of the fluid at its surface as well, hence the factor.
double rowGrowth(const Case& c) {
  const double reach = std::max(c.method.viscosityRadius, 2 * c.method.pressureRadius), published = 3.5;
  return std::max(1.0, 0.9 * std::pow(reach / published, c.dimensions));
}
std::uint64_t grown(std::uint64_t rows, const Case& c) {
  return static_cast<std::uint64_t>(static_cast<double>(rows) * rowGrowth(c));
}

std::uint64_t perFluidParticle(const Case& c, const DeviceBytes& bytes, Storage storage) {
  switch (storage) {
    case Storage::MatrixFree:
      return bytes.matrixFree;
    case Storage::Ranges:
      return bytes.ranges;
    case Storage::Assembled:
      return grown(bytes.assembled, c);
    case Storage::Spgemm:
      break;
  }
  return bytes.spgemm;
}

}  // namespace

std::uint64_t estimatedMemory(const Case& c, ParticleNumbers n, bool onDevice) {
  const HostBytes& bytes = c.dimensions == 2 ? hostBytes2D : hostBytes3D;
  const std::uint64_t all = n.fluid + n.wall;
  const ModeBytes modes = modeBytes(c);
  const std::uint64_t snapshots =
      all * bytes.snapshots + n.fluid * copiesToBeWritten * (bytes.memory + modes.kept);
  if (onDevice) return programBytes + driverBytes + snapshots;
  const bool assembled = storageOf(c.solver, false) == Storage::Assembled;
  std::uint64_t solver = assembled ? grown(bytes.assembled, c) : bytes.matrixFree;
  if (c.method.kind == MethodKind::Isph)
    solver = isphBytes(c).solver;
  else if (c.solver.preconditioner == PreconditionerKind::ProjectedMultigrid)
    solver += bytes.projected + (assembled ? bytes.beside : 0);
  if (c.method.kind == MethodKind::MphI && c.method.scheme == SchemeKind::Accurate) solver += bytes.accurate;
  return programBytes + snapshots + all * bytes.state +
         n.fluid * (bytes.memory + solver + modes.kept + modes.used) + balanceBytes(c, n) + cellBytes(c);
}

std::uint64_t estimatedDeviceMemory(const Case& c, ParticleNumbers n) {
  if (c.method.kind == MethodKind::Isph) {
    const IsphBytes& isph = isphBytes(c);
    return isph.fixed + n.fluid * isph.fluid + n.wall * isph.wall + cellBytes(c);
  }
  const DeviceBytes& bytes = c.dimensions == 2 ? deviceBytes2D : deviceBytes3D;
  const bool projected = c.solver.preconditioner == PreconditionerKind::ProjectedMultigrid;
  const ModeBytes modes = modeBytes(c);
  const bool accurate = c.method.scheme == SchemeKind::Accurate;
  const std::uint64_t ofFluid = perFluidParticle(c, bytes, storageOf(c.solver, true)) +
                                (projected ? bytes.projected : 0) + (accurate ? bytes.accurate : 0) + modes.kept +
                                modes.used;
  return bytes.fixed + n.fluid * ofFluid + n.wall * bytes.wall + balanceBytes(c, n) + cellBytes(c);
}

void requireMemory(const Case& c, ParticleNumbers n, const DeviceInfo* device) {
  const std::uint64_t needed = estimatedMemory(c, n, device != nullptr), available = availableMemory();
  if (needed > available)
    throw RunError(
        fmt::format("{} need about {} of memory, {} available; take a lower resolution or a smaller domain",
                    contentText(c, n), bytesText(needed), bytesText(available)));
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
                    contentText(c, n), bytesText(onDevice), bytesText(device->freeMemory), device->name));
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
