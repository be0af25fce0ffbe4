#pragma once

#include "treacle/model/any_particles.hpp"
#include "treacle/model/case.hpp"

#include <cstdint>
#include <filesystem>

namespace treacle {

/// What a simulation starts from.
struct StartState {
  AnyParticles particles;
  std::int64_t step = 0;  // number of steps done
  double time = 0;        // [s]
};

/// The state in a checkpoint file, for the case; its step counts in time steps of the case, which need
/// not be those of the interrupted run, or where these vary in length it is that of the file. `made`: the
/// particles that the case starts with. Errors: InputError if the file cannot be used, if it does not fit the case
/// (numbers of particles, materials, bodies, domain, time step).
StartState fittingState(const Case& c, const std::filesystem::path& file, const AnyParticles& made);

/// The same for a run of the case. Errors: InputError also if its time is not before the end.
StartState resumedState(const Case& c, const std::filesystem::path& file, const AnyParticles& made);

}  // namespace treacle
