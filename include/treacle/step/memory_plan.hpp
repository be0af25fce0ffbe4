#pragma once

#include "treacle/core/backend.hpp"
#include "treacle/step/memory_counts.hpp"

#include <cstdint>

namespace treacle {

/// Bytes of the arrays of a simulation.
struct MemoryPlan {
  std::uint64_t held = 0;  // after a step
  std::uint64_t peak = 0;  // within one
};

/// Whether the case's solver has A as a matrix, so that lists hold whole rows of it.
bool storesMatrix(const Case& c, BackendKind backend);

/// What a simulation of the case will have, by the sizes of its arrays for these numbers; without fallbacks, whose
/// arrays come on top where a solve fails.
MemoryPlan planMemory(const Case& c, const MemoryCounts& counts, BackendKind backend);

/// What the walls that are not among its particles take of the host's memory; on a CPU it is part of the plan [B].
std::uint64_t distantWallBytes(const Case& c, const MemoryCounts& counts);

/// Of the fields of particles on the host, with room for the modes that the solver may keep.
std::uint64_t stateBytes(const Case& c, ParticleNumbers n);

}  // namespace treacle
