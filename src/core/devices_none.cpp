// What builds without CUDA know of devices: there is none.
#include "treacle/core/cuda.hpp"
#include "treacle/core/device.hpp"

namespace treacle {

std::vector<DeviceInfo> cudaDevices() { return {}; }
void useDevice(std::size_t) {}
void waitForDevice() {}

PinnedMemory::PinnedMemory(void*, std::size_t) {}
PinnedMemory::~PinnedMemory() = default;

}  // namespace treacle
