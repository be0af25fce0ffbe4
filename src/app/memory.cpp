#include "memory.hpp"

#include "machine.hpp"
#include "treacle/core/error.hpp"

#include <fmt/format.h>

namespace treacle {
namespace {

/// Bytes per particle at the peak of a step.
struct BytesPerParticle {
  std::uint64_t matrixFree;      // state, neighbour lists, solver vectors; fluid and walls
  std::uint64_t assembledExtra;  // the matrix; fluid only: neighbours times (block + column index)
};
constexpr BytesPerParticle bytesPerParticle2D{700, 38 * (32 + 4)};
constexpr BytesPerParticle bytesPerParticle3D{1200, 180 * (72 + 4)};
constexpr std::uint64_t programBytes = 16 << 20;  // the program itself, its libraries and a picture

}  // namespace

std::uint64_t estimatedMemory(const Case& c, std::uint64_t fluidParticles, std::uint64_t wallParticles) {
  const BytesPerParticle& bytes = c.dimensions == 2 ? bytesPerParticle2D : bytesPerParticle3D;
  const std::uint64_t matrix = c.solver.operatorKind == OperatorKind::Assembled ? bytes.assembledExtra : 0;
  return programBytes + (fluidParticles + wallParticles) * bytes.matrixFree + fluidParticles * matrix;
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
