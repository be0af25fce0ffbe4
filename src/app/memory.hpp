#pragma once

#include "treacle/core/cuda.hpp"
#include "treacle/core/device.hpp"
#include "treacle/model/any_particles.hpp"
#include "treacle/model/case.hpp"

#include <cstdint>
#include <string>

namespace treacle {

/// Memory of the host that a run of the case will need at its peak, from the bytes per particle and search
/// cell that were measured [B]. `onDevice`: the run computes on a GPU.
std::uint64_t estimatedMemory(const Case& c, ParticleNumbers particles, bool onDevice);

/// The same for the memory of the GPU.
std::uint64_t estimatedDeviceMemory(const Case& c, ParticleNumbers particles);

/// `device`: what the run computes on, null for the CPU. Errors: RunError where the case clearly needs more memory
/// than the host, or the device, has free.
void requireMemory(const Case& c, ParticleNumbers particles, const DeviceInfo* device);

/// What to tell where device memory gave out.
std::string exhaustedText(const DeviceMemoryNumbers& numbers);

/// "1.5 GiB", "12 MiB".
std::string bytesText(std::uint64_t bytes);

}  // namespace treacle
