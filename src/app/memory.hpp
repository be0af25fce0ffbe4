#pragma once

#include "treacle/core/communicator.hpp"
#include "treacle/core/cuda.hpp"
#include "treacle/core/device.hpp"
#include "treacle/step/memory_plan.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace treacle {

/// Before the particles of a case are made, which takes memory itself. Errors: RunError where there is not even
/// enough for their places.
void requireRoomForParticles(const Case& c);

/// What a run needs at least, before anything is counted, which takes memory for the cells itself [B].
std::uint64_t leastMemory(const Case& c);

/// What decides on the memory of a run with these particles. `onDevice`: the run computes on a GPU. Errors:
/// RunError where there is less than leastMemory().
MemoryCounts countsFor(const Case& c, const AnyParticles& particles, bool onDevice);
/// The same for this one of several processes, each of which has a part of the particles. Collective; all throw.
/// Errors: InputError also for more processes than search cells with fluid. A process that has no memory for it
/// ends the job.
MemoryCounts countsFor(const Case& c, const AnyParticles& part, bool onDevice, const Communicator& processes);

/// Memory of the host that a run of the case will need at its peak [B]: the arrays of the simulation, the copies
/// of its state that are written, and the program.
std::uint64_t estimatedMemory(const Case& c, const MemoryCounts& counts, bool onDevice);

/// The same for the memory of the GPU.
std::uint64_t estimatedDeviceMemory(const Case& c, const MemoryCounts& counts);

/// Memory of the host that one of several processes needs at its peak, `counts` being its own, without what the
/// first one needs beside that. `all`: particles of all; each process looks at their places as it makes its part
/// [B].
std::uint64_t processMemory(const Case& c, const MemoryCounts& counts, bool onDevice, const ParticleNumbers& all);

/// What the first of several processes needs beside that, for the copies of the whole state that it writes and its
/// picture [B].
std::uint64_t gatheredMemory(const Case& c, const ParticleNumbers& all);

/// How many processes share a run, the particles of all of them, and what those need that share this host [B].
struct Sharing {
  std::uint64_t processes = 1;
  ParticleNumbers all = {};
  std::uint64_t hostMemory = 0;
};
/// Of the `onHost` processes with the most of `each`, and the first one's `gathered` [B].
std::uint64_t memoryOfHost(std::vector<std::uint64_t> each, std::uint64_t onHost, std::uint64_t gathered);

/// `device`: what the run computes on, null for the CPU. Errors: RunError where the case clearly needs more memory
/// than the host, or the device, has free.
void requireMemory(const Case& c, const AnyParticles& particles, const DeviceInfo* device);
/// The same where they are counted, also for one of several processes.
void requireMemory(const Case& c, const MemoryCounts& counts, const DeviceInfo* device,
                   const Sharing& sharing = {});

/// What to tell where device memory gave out.
std::string exhaustedText(const DeviceMemoryNumbers& numbers);

/// "1.5 GiB", "12 MiB".
std::string bytesText(std::uint64_t bytes);

}  // namespace treacle
