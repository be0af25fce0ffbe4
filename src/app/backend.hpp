#pragma once

#include "commands.hpp"
#include "treacle/core/backend.hpp"
#include "treacle/core/device.hpp"

#include <optional>
#include <string>
#include <vector>

namespace treacle {

/// The device that a run computes on, which becomes the current one: the first one that CUDA names, or, of several
/// processes on a host, the one that has this process's number among them; empty: the CPU. Where there are too
/// few, processes share devices if CUDA is asked for, and have none if not. Errors: InputError where CUDA is asked
/// for and the build or the machine does not have it, or not for this device; where it is not asked for, the last
/// is a warning on stderr.
std::optional<DeviceInfo> deviceFor(BackendChoice choice, int localRank = 0);

/// "NVIDIA H200 (sm_90)"
std::string deviceText(const DeviceInfo& device);

/// Settings of the case that the CPU has no use for.
std::vector<std::string> cpuWarnings(const Case& c);

}  // namespace treacle
