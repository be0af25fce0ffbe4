#pragma once

#include "treacle/model/case.hpp"

#include <cstdint>
#include <string>

namespace treacle {

/// Memory that a run of the case will need at its peak, from the bytes per particle that were measured [B].
std::uint64_t estimatedMemory(const Case& c, std::uint64_t fluidParticles, std::uint64_t wallParticles);

/// Errors: RunError where the case clearly needs more than is available.
void requireMemory(const Case& c, std::uint64_t fluidParticles, std::uint64_t wallParticles);

/// "1.5 GiB", "12 MiB".
std::string bytesText(std::uint64_t bytes);

}  // namespace treacle
