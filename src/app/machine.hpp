#pragma once

#include "treacle/core/device.hpp"

#include <cstdint>
#include <string>

namespace treacle {

/// Memory that this process can still get: what the machine has left, within the limits of the process and its
/// control group [B].
std::uint64_t availableMemory();

/// Model name of the processor, "unknown processor" where the system does not tell.
std::string processorName();

/// Why a device cannot run a program that was built for these `architectures`, and what to do.
std::string noCodeText(const DeviceInfo& device, const std::string& architectures);

}  // namespace treacle
