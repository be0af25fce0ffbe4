#include "treacle/core/device.hpp"

namespace treacle {

// Builds without CUDA know of no devices; kernels/core/devices.cu takes this file's place in those with it.
std::vector<DeviceInfo> cudaDevices() { return {}; }

}  // namespace treacle
