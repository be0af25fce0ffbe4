// What builds without CUDA know of devices: there is none.
#include "treacle/core/cuda.hpp"
#include "treacle/core/device.hpp"
#include "treacle/core/error.hpp"

namespace treacle {

std::vector<DeviceInfo> cudaDevices() { return {}; }
int useDeviceOf(const Communicator&) { throw InputError("this program was built without CUDA"); }

PinnedMemory::PinnedMemory(void*, std::size_t) {}
PinnedMemory::~PinnedMemory() = default;

}  // namespace treacle
