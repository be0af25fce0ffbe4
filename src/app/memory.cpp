#include "memory.hpp"

#include "machine.hpp"
#include "treacle/core/error.hpp"

#include <fmt/format.h>

namespace treacle {
namespace {

/// Bytes at the peak of a run, measured on the dam breaks.
struct BytesPerParticle {
  std::uint64_t state;       // fluid and walls: fields, sort, two copies to be written, and a frame
  std::uint64_t matrixFree;  // fluid: neighbour lists, pair coefficients, preconditioner, solver vectors
  std::uint64_t assembled;   // fluid: the matrix in place of the coefficients
};
constexpr BytesPerParticle bytesPerParticle2D{310, 1400, 2100};
constexpr BytesPerParticle bytesPerParticle3D{440, 4200, 14300};
constexpr std::uint64_t programBytes = 26 << 20;  // the program itself, its libraries and a picture

}  // namespace

std::uint64_t estimatedMemory(const Case& c, std::uint64_t fluidParticles, std::uint64_t wallParticles) {
  const BytesPerParticle& bytes = c.dimensions == 2 ? bytesPerParticle2D : bytesPerParticle3D;
  const std::uint64_t solver =
      c.solver.operatorKind == OperatorKind::Assembled ? bytes.assembled : bytes.matrixFree;
  return programBytes + (fluidParticles + wallParticles) * bytes.state + fluidParticles * solver;
}

void requireMemory(const Case& c, std::uint64_t fluidParticles, std::uint64_t wallParticles) {
  const std::uint64_t needed = estimatedMemory(c, fluidParticles, wallParticles), available = availableMemory();
  if (needed > available)
    throw RunError(fmt::format("{} particles need about {} of memory, {} available; take a lower resolution",
                               fluidParticles + wallParticles, bytesText(needed), bytesText(available)));
}

std::string bytesText(std::uint64_t bytes) {
  constexpr double mebibyte = 1 << 20, gibibyte = 1 << 30;
  const double b = static_cast<double>(bytes);
  return b < gibibyte ? fmt::format("{:.3g} MiB", b / mebibyte) : fmt::format("{:.3g} GiB", b / gibibyte);
}

}  // namespace treacle
