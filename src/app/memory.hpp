#pragma once

#include "machine.hpp"
#include "treacle/core/communicator.hpp"
#include "treacle/core/cuda.hpp"
#include "treacle/core/device.hpp"
#include "treacle/step/run/memory_plan.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace treacle {

/// Before the particles of a case are made, which takes memory itself. Errors: RunError where there is not even
/// enough for them alone.
/// `processes`: of which each makes its part of them; `available`: of the machine [B].
void requireRoomForParticles(const Case& c, std::uint64_t processes = 1,
                             std::uint64_t available = availableMemory());

/// What a run needs at least, before anything is counted, which takes memory for the cells itself [B].
std::uint64_t leastMemory(const Case& c);

/// What decides on the memory of a run with these particles. Errors: RunError where there is less than
/// leastMemory().
MemoryCounts countsFor(const Case& c, const AnyParticles& particles);
/// The same for several processes, each of which has some of the particles. Collective; all throw. A process that
/// has no memory for it ends the job.
MemoryCounts countsFor(const Case& c, const AnyParticles& some, const Communicator& processes);

/// What one of the processes of a run needs at its peak [B]: its arrays and the program on the host, and its
/// arrays on the device; `first`: what the first one needs beside, for the copies of the whole state that it
/// writes.
struct MemoryEstimate {
  std::uint64_t host = 0, first = 0, device = 0;
};
/// `all`: of the whole case. `onDevice`: the run computes on GPUs.
MemoryEstimate estimatedMemory(const Case& c, const MemoryCounts& all, bool onDevice, std::uint64_t processes = 1);

/// Search cells of an empty domain may take much more than all particles.
void warnLargeDomain(const Case& c, const MemoryCounts& all, std::vector<std::string>& warnings);

/// `device`: what the run computes on, null for the CPU. Errors: RunError where the case clearly needs more memory
/// than the host, or the device, has free: on a device by more than the estimate may be off.
void requireMemory(const Case& c, const AnyParticles& particles, const DeviceInfo* device);
/// The same where they are counted, also for several processes, `onHost` of them on one host with the first one.
void requireMemory(const Case& c, const MemoryCounts& all, const DeviceInfo* device, std::uint64_t processes = 1,
                   std::uint64_t onHost = 1);

/// What to tell where device memory gave out.
std::string exhaustedText(const DeviceMemoryNumbers& numbers);

/// "1.5 GiB", "12 MiB".
std::string bytesText(std::uint64_t bytes);

}  // namespace treacle
