#pragma once

#include "treacle/core/backend.hpp"
#include "treacle/model/case/case.hpp"
#include "treacle/model/particles/any_particles.hpp"

namespace treacle {

/// Makes the first steps of a case and prints, as comments of a case file, how long they took and how long all of
/// them will take. Nothing is written. Errors: RunError for a step that fails.
void printEstimate(const Case& c, AnyParticles particles, BackendKind backend);

}  // namespace treacle
