#pragma once

#include "treacle/core/backend.hpp"
#include "treacle/core/communicator.hpp"
#include "treacle/model/case/case.hpp"
#include "treacle/model/particles/any_particles.hpp"

#include <cstdint>

namespace treacle {

/// The numbers that the memory of a simulation is estimated from.
struct MemoryCounts {
  ParticleNumbers particles;
  std::uint64_t nearWalls = 0;    // that the simulation has; the others are DistantWalls
  std::uint64_t activeWalls = 0;  // of these (CellRanges)
  std::uint64_t cells = 0;        // of the search
  std::uint64_t filledCells = 0;  // of these with fluid
  std::uint64_t nodes = 0;        // of the finest background grid

  /// Those of one `among` several processes, while these are those of all of them. Its own fluid is an equal
  /// share, and its ghosts are as many as a compact share has. It has all near walls.
  MemoryCounts share(const Case& c, std::uint64_t among) const;
};

/// Search cells of the domain, whether or not there are particles in them.
std::uint64_t searchCells(const Case& c);

/// Counts the particles as they are. `processes`: each of them has some of the particles, whichever, and all count
/// together. Takes two bytes for each search cell. Errors: std::bad_alloc.
MemoryCounts countForMemory(const Case& c, const AnyParticles& particles, const Communicator* processes = nullptr);

/// The most that a simulation, or this one of the processes that share it, has on the backend within a step,
/// without fallbacks, whose arrays come on top where a solve fails [B].
std::uint64_t simulationBytes(const Case& c, const MemoryCounts& n, BackendKind backend);

/// What the walls that are not among its particles take of the host's memory; on a CPU simulationBytes has it [B].
std::uint64_t distantWallBytes(const Case& c, const MemoryCounts& n);

/// Of the fields of particles, with room for the modes that the solver may keep [B].
std::uint64_t stateBytes(const Case& c, ParticleNumbers n);

}  // namespace treacle
