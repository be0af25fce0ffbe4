#include "treacle/core/device.hpp"

#include "core/cuda_check.hpp"

namespace treacle {

std::vector<DeviceInfo> cudaDevices() {
  int count = 0;
  if (cudaGetDeviceCount(&count) != cudaSuccess) return {};  // no driver or no device: not an error here
  std::vector<DeviceInfo> devices;
  for (int d = 0; d < count; ++d) {
    cudaDeviceProp p;
    TREACLE_CUDA_CHECK(cudaGetDeviceProperties(&p, d));
    devices.push_back({p.name, p.major, p.minor, p.multiProcessorCount, p.totalGlobalMem});
  }
  return devices;
}

}  // namespace treacle
