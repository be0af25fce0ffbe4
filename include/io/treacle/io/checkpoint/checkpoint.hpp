#pragma once

#include "treacle/model/case/case.hpp"
#include "treacle/model/particles/particle_part.hpp"
#include "treacle/model/particles/particles.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace treacle {

/// What the numbers of materials and bodies in a state stand for.
struct StateNames {
  std::vector<std::string> materials, bodies, states;

  static StateNames of(const Case& c);
};

/// The complete state of a simulation after a step: continued from here, it gives the same bits as without the
/// interruption.
template <int D>
struct Checkpoint {
  Particles<D> particles;  // in the order they had, which decides the rounding of later steps
  std::int64_t step = 0;   // number of steps done
  double time = 0;         // [s]
  MethodKind method = {};  // that it was computed by
  StateNames names;        // empty: not known
  std::uint32_t fluidOfAll = 0, wallsOfAll = 0;  // in the file, of which `particles` may have a part
  std::uint32_t firstWall = 0;                   // id of the first wall particle in the file
};

/// Starts HDF5, which ends the program if memory gives out meanwhile: a run does so before it has any to lose.
/// Errors: RunError.
void prepareCheckpoints();

/// Writes an HDF5 file under a temporary name, then renames it: an older checkpoint stays until the new one is
/// complete. Takes as much memory as the particles meanwhile. Errors: RunError with path and reason, also for
/// values that no simulation has, as readCheckpoint would refuse.
template <int D>
void writeCheckpoint(const std::filesystem::path& path, const Particles<D>& particles, std::int64_t step,
                     double time, MethodKind method, const StateNames& names = {});

/// Reads a file of writeCheckpoint. Errors: InputError with path and reason for a file that is missing, foreign,
/// truncated, damaged, or of another format or dimension, or whose values are none of a simulation: not finite, or
/// with ids that are not those of the particles. `part`: of the fluid in the order of the file, of the walls by
/// their ids; of values only its own are looked at.
template <int D>
Checkpoint<D> readCheckpoint(const std::filesystem::path& path, ParticlePart part = {});

extern template void writeCheckpoint<2>(const std::filesystem::path&, const Particles<2>&, std::int64_t, double,
                                        MethodKind, const StateNames&);
extern template void writeCheckpoint<3>(const std::filesystem::path&, const Particles<3>&, std::int64_t, double,
                                        MethodKind, const StateNames&);
extern template Checkpoint<2> readCheckpoint<2>(const std::filesystem::path&, ParticlePart);
extern template Checkpoint<3> readCheckpoint<3>(const std::filesystem::path&, ParticlePart);

}  // namespace treacle
