#pragma once

#include "treacle/model/case/case.hpp"
#include "treacle/step/run/step_control.hpp"

#include <cstdint>

namespace treacle {

/// The next step of a case without automatic steps, where `step` of them have led to `time` [s] and the fastest
/// particle goes at `fastest` [m/s]. Errors: RunError where the time no longer advances.
StepControl::Step givenStep(const Case& c, std::int64_t step, double time, double fastest);

}  // namespace treacle
