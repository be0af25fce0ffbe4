#pragma once

#include "treacle/core/cuda.hpp"
#include "treacle/core/device.hpp"
#include "treacle/step/memory_plan.hpp"

#include <cstdint>
#include <string>

namespace treacle {

/// Before the particles of a case are made, which takes memory itself. Errors: RunError where there is not even
/// enough for their places.
void requireRoomForParticles(const Case& c);

/// What a run needs at least, before anything is counted, which takes memory for the cells itself [B].
std::uint64_t leastMemory(const Case& c);

/// What decides on the memory of a run with these particles. `onDevice`: the run computes on a GPU. Errors:
/// RunError where there is less than leastMemory().
MemoryCounts countsFor(const Case& c, const AnyParticles& particles, bool onDevice);

/// Memory of the host that a run of the case will need at its peak [B]: the arrays of the simulation, the copies
/// of its state that are written, and the program.
std::uint64_t estimatedMemory(const Case& c, const MemoryCounts& counts, bool onDevice);

/// The same for the memory of the GPU.
std::uint64_t estimatedDeviceMemory(const Case& c, const MemoryCounts& counts);

/// How many processes share a run, how many of them this host has, and the particles of all of them.
struct Sharing {
  std::uint64_t processes = 1, onHost = 1;
  ParticleNumbers all = {};
};
/// What the host needs at least where they do: each process makes its part of the particles, to which it looks at
/// the places of all; the first one writes checkpoints. `counts`: of one part. What processes hold of others'
/// parts is not counted [B].
std::uint64_t leastSharedMemory(const Case& c, const MemoryCounts& counts, bool onDevice, const Sharing& sharing);

/// `device`: what the run computes on, null for the CPU. Errors: RunError where the case clearly needs more memory
/// than the host, or the device, has free.
void requireMemory(const Case& c, const AnyParticles& particles, const DeviceInfo* device,
                   const Sharing& sharing = {});
/// The same where they are counted.
void requireMemory(const Case& c, const MemoryCounts& counts, const DeviceInfo* device,
                   const Sharing& sharing = {});

/// What to tell where device memory gave out.
std::string exhaustedText(const DeviceMemoryNumbers& numbers);

/// "1.5 GiB", "12 MiB".
std::string bytesText(std::uint64_t bytes);

}  // namespace treacle
