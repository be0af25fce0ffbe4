#pragma once

#include "treacle/model/case/case.hpp"
#include "treacle/model/particles/any_particles.hpp"
#include "treacle/model/particles/create.hpp"
#include "treacle/model/particles/particle_part.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace treacle {

/// The particles that a case starts with, or the part of them that one of several processes makes.
struct MadeParticles {
  AnyParticles particles{2};
  std::vector<BodyCount> ofBodies;  // particles of each body, those of other processes as well
  ParticlePart part;

  /// Appends to `notes` as createParticles does. Errors: those of createParticles.
  static MadeParticles of(const Case& c, std::vector<std::string>& notes, ParticlePart part = {});

  /// For a run that begins with them. Errors: InputError where there is no fluid yet, or a
  /// rigid body has none.
  void requireParticles(const Case& c) const;
};

/// What a simulation starts from; of several processes each has a part of them.
struct StartState {
  AnyParticles particles;
  std::int64_t step = 0;             // number of steps done
  double time = 0;                   // [s]
  std::vector<std::string> notes{};  // what is no longer as in the run
};

/// The state in a checkpoint file, for the case; its step counts in time steps of the case, which need
/// not be those of the interrupted run, or where these vary in length it is that of the file. `made`: the
/// particles that the case starts with; the state is a part where they are. Other bodies than those of the run are
/// added or left out (changeBodies). Errors: InputError if the file cannot be used, if it does not fit the case
/// (numbers of particles, materials, bodies, domain, time step).
StartState fittingState(const Case& c, const std::filesystem::path& file, const MadeParticles& made);

/// The same for a run of the case. Errors: InputError also if its time is not before the end.
StartState resumedState(const Case& c, const std::filesystem::path& file, const MadeParticles& made);

}  // namespace treacle
