#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace treacle {

struct DeviceInfo {
  std::string name;
  int computeMajor = 0, computeMinor = 0;  // compute capability
  int multiprocessors = 0;
  std::size_t memory = 0;      // [B]
  std::size_t freeMemory = 0;  // [B]; 0 where the device cannot be used
  bool hasCode = true;         // whether this program has kernels for its compute capability
};

/// The CUDA devices of this machine; empty in builds without CUDA and where there is no driver or no device.
std::vector<DeviceInfo> cudaDevices();

/// Makes one of them the current one of this thread: that of contexts made from now on. Errors: DeviceFailure.
void useDevice(std::size_t number);

/// Returns when the current device has done all that this process has asked of it, whoever in it did. Errors:
/// DeviceFailure.
void waitForDevice();

}  // namespace treacle
