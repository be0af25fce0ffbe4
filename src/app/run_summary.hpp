#pragma once

#include "treacle/io/tables/summary.hpp"
#include "treacle/model/case/case.hpp"
#include "treacle/model/particles/particles.hpp"

#include <string>

namespace treacle {

/// What is known of a run before its first step. `device`: its name for the user.
RunSummary startOfSummary(const Case& c, bool onDevice, const std::string& device,
                          const ParticleNumbers& particles);

}  // namespace treacle
