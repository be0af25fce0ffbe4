#pragma once

#include "treacle/model/case/probe.hpp"
#include "treacle/model/particles/any_particles.hpp"

#include <cstddef>

namespace treacle {

/// What a probe has found in a state.
struct ProbeReading {
  std::size_t index = 0;      // into the probes of the case
  Probe probe{};              // as it stands now
  PartSums sums{};            // of one that is summed
  AnyParticles particles{2};  // of one that is sampled: those within probeReach of its places
};

}  // namespace treacle
