#pragma once

#include "treacle/core/communicator.hpp"
#include "treacle/model/any_particles.hpp"
#include "treacle/model/case.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace treacle {

/// The numbers that the arrays of a simulation have their sizes from, as they are for given particles. Where
/// processes share it they are those of one process: `particles` are its own fluid, its ghosts, the walls that all
/// hold and the distant ones of its part; lists, rows and active walls those that it has.
struct MemoryCounts {
  /// Lists of clusters of the fluid, of active walls, or of these for the balance; segments as in ListSegment.
  struct Lists {
    std::uint64_t clusters = 0;
    std::array<std::uint64_t, 4> entries{};
  };
  /// A level of background grids: nodes, points of its lattice, and entries of a matrix on it.
  struct Grid {
    std::uint64_t nodes = 0, points = 0, entries = 0;
    bool divided = false;  // between processes: then `nodes` are own ones and `ghosts`
    std::uint64_t ghosts = 0;
  };
  /// Of several processes; all is zero where a simulation is alone.
  struct Sharing {
    std::uint64_t processes = 0;
    std::uint64_t ghostWalls = 0;                  // among the active ones
    std::uint64_t sentFluid = 0, sentWalls = 0;    // own particles, once for each process that has them as ghosts
    std::uint64_t buckets = 0, bucketEntries = 0;  // of the part of A^0 that is this process's
  };

  ParticleNumbers particles;
  std::uint64_t nearWalls = 0;  // that a simulation starts with; the others are DistantWalls
  std::uint64_t active = 0;     // fluid and walls next to it
  std::uint64_t cells = 0;      // of the search
  bool wallsMove = false;
  Sharing sharing;

  // MPH-I.
  Lists fluidLists, wallLists, wallForceLists;
  std::uint64_t nearEntries = 0;       // each particle's own neighbours within h_p, in slices
  std::uint64_t stagedEntries = 0;     // of these what single-precision products with B have
  std::uint64_t gradientEntries = 0;   // of C
  std::uint64_t rowEntries = 0;        // blocks of A, where lists have whole rows of it
  std::vector<Grid> pressureGrids;     // finest first
  std::vector<std::uint64_t> buckets;  // per level
  std::uint64_t bucketEntries = 0;     // blocks of A^0
  // ISPH.
  std::uint64_t fluidOfFluid = 0, wallsOfFluid = 0, fluidOfWalls = 0;  // entries of rows

  std::vector<Grid> fluidGrids;  // of velocities, and of ISPH's pressures; finest first

  bool isShared() const { return sharing.processes > 1; }
  /// With ghosts.
  std::uint64_t heldFluid() const { return particles.fluid + particles.ghosts; }
  std::uint64_t activeWalls() const { return active - heldFluid(); }
};

/// Search cells of the domain, whether or not there are particles in them.
std::uint64_t searchCells(const Case& c);

/// Counts what the first step of the case will have. Neighbours are counted around a few thousand of the
/// particles, spread evenly, or around all where there are no more. `wholeRows`: lists of fluid reach as far as A
/// couples. Takes memory for a copy of the particles that the step will have and for their sort, and for the
/// search cells some 30 bytes each. Errors: std::bad_alloc.
MemoryCounts countForMemory(const Case& c, const AnyParticles& particles, bool wholeRows);

/// The same for this one of several processes, each of which has a part of the particles, whichever: the cells are
/// given out and the particles change hands as in the first sort of a simulation. Collective. Errors: those of
/// Decomposition::sort.
MemoryCounts countForMemory(const Case& c, const AnyParticles& part, bool wholeRows,
                            const Communicator& processes);

/// What those of several processes will have that hold the most particles, `most` of them or all, the fullest
/// first; here one process has all `particles`. Errors: InputError if there are more processes than cells with
/// fluid.
std::vector<MemoryCounts> countForProcesses(const Case& c, const AnyParticles& particles, bool wholeRows,
                                            int processes, std::size_t most = 8);

}  // namespace treacle
