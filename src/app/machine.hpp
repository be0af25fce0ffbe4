#pragma once

#include <cstdint>
#include <string>

namespace treacle {

/// Memory that this process can still get: what the machine has left, within the limits of the process and its
/// control group [B].
std::uint64_t availableMemory();

/// Largest resident size of this process so far [B].
std::uint64_t peakMemory();

/// Model name of the processor, "unknown processor" where the system does not tell.
std::string processorName();

}  // namespace treacle
