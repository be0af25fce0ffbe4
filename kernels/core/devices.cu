#include "treacle/core/device.hpp"

#include "core/cuda_check.hpp"
#include "core/launch.hpp"

namespace treacle {
namespace {

/// 0 where the device is reserved for another process, or does not answer: not an error of those who only look.
std::size_t freeMemory(int device) {
  std::size_t free = 0, total = 0;
  if (cudaSetDevice(device) == cudaSuccess && cudaMemGetInfo(&free, &total) == cudaSuccess) return free;
  cudaGetLastError();  // the error must not meet the next call
  return 0;
}

/// Stands for all kernels, which are compiled for the same architectures.
__global__ void anyKernel() {}

/// Of the current device.
bool hasCode() {
  cudaFuncAttributes attributes;
  const cudaError_t status = cudaFuncGetAttributes(&attributes, anyKernel);
  if (status == cudaSuccess) return true;
  cudaGetLastError();
  return status != cudaErrorNoKernelImageForDevice && status != cudaErrorInvalidDeviceFunction &&
         status != cudaErrorUnsupportedPtxVersion;
}

}  // namespace

bool startsKernelsEarly() {
  static const bool yes = [] {
    cudaFuncAttributes attributes;
    TREACLE_CUDA_CHECK(cudaFuncGetAttributes(&attributes, anyKernel));
    return attributes.ptxVersion >= 90;
  }();
  return yes;
}

std::vector<DeviceInfo> cudaDevices() {
  int count = 0, current = 0;
  if (cudaGetDeviceCount(&count) != cudaSuccess || count == 0) return {};  // not an error here
  TREACLE_CUDA_CHECK(cudaGetDevice(&current));
  std::vector<DeviceInfo> devices;
  for (int d = 0; d < count; ++d) {
    cudaDeviceProp p;
    TREACLE_CUDA_CHECK(cudaGetDeviceProperties(&p, d));
    const std::size_t free = freeMemory(d);  // makes the device the current one
    devices.push_back({p.name, p.major, p.minor, p.multiProcessorCount, p.totalGlobalMem, free, hasCode()});
  }
  if (cudaSetDevice(current) != cudaSuccess) cudaGetLastError();  // those who compute will be told
  return devices;
}

void useDevice(std::size_t number) { TREACLE_CUDA_CHECK(cudaSetDevice(static_cast<int>(number))); }
void waitForDevice() { TREACLE_CUDA_CHECK(cudaDeviceSynchronize()); }

}  // namespace treacle
